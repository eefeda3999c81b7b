#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <string>

namespace arfm_vo {

/// A test with an empty folder of its own, gone with it.
class FolderTest : public testing::Test {
 protected:
  ~FolderTest() override { std::filesystem::remove_all(folder_); }

  const std::filesystem::path folder_ = [] {
    std::string pattern = std::filesystem::temp_directory_path() / "arfm_vo_XXXXXX";
    return std::string(::mkdtemp(pattern.data()));
  }();
};

}  // namespace arfm_vo
