#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace arfm_vo {

/// The path of a real file or folder for tests, below $ARFM_VO_SHARED or else ../shared beside the
/// package; empty where it is not there (GTEST_SKIP then).
inline std::string FindShared(const std::string& name) {
  const char* chosen = std::getenv("ARFM_VO_SHARED");
  const std::filesystem::path shared =
      chosen ? chosen : std::filesystem::path(ARFM_VO_SOURCE_DIR) / ".." / "shared";
  const std::filesystem::path path = shared / name;
  return std::filesystem::exists(path) ? path.string() : "";
}

}  // namespace arfm_vo
