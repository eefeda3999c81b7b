#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "arfm_vo/base/whole_file.h"
#include "fuzz/fuzz_targets.h"

// What scripts/fuzz.sh has found, and inputs that reach far into the readers: each must be taken or
// refused as documented. Under the sanitizers (scripts/test_sanitized.sh) it says the most.

namespace arfm_vo {
namespace {

namespace fs = std::filesystem;

const fs::path kCorpus = fs::path(ARFM_VO_SOURCE_DIR) / "test/fuzz/corpus";

std::vector<fs::path> ListFiles(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

class FuzzCorpus : public ::testing::TestWithParam<FuzzTarget> {};

TEST_P(FuzzCorpus, IsTakenOrRefused) {
  const std::vector<fs::path> files = ListFiles(kCorpus / GetParam().name);
  EXPECT_FALSE(files.empty());
  for (const fs::path& file : files)
    EXPECT_NO_THROW(GetParam().run(ReadWholeFile(file))) << file.filename();
}

TEST_P(FuzzCorpus, IsTakenOrRefusedWhenCutOff) {
  EXPECT_NO_THROW(GetParam().run("")) << "empty";
  for (const fs::path& file : ListFiles(kCorpus / GetParam().name)) {
    const std::string bytes = ReadWholeFile(file);
    for (const size_t part : {1, 2, 3})
      EXPECT_NO_THROW(GetParam().run(bytes.substr(0, bytes.size() * part / 4)))
          << part << " / 4 of " << file.filename();
  }
}

INSTANTIATE_TEST_SUITE_P(Target, FuzzCorpus, ::testing::ValuesIn(AllFuzzTargets()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace arfm_vo
