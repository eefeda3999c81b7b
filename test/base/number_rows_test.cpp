#include "arfm_vo/base/number_rows.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "arfm_vo/base/whole_file.h"

namespace arfm_vo {
namespace {

class NumberRowsTest : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  std::string ErrorOf(const std::string& text) {
    WriteWholeFile(path_, text);
    try {
      ReadNumberRows(path_, 2);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what()).substr(path_.size());
    }
    return "no error";
  }
  const std::string path_ =
      (std::filesystem::temp_directory_path() / "arfm_vo_number_rows_test.txt").string();
};

TEST_F(NumberRowsTest, ReadsRowsAndKeepsTheirLineNumbers) {
  WriteWholeFile(path_, "# a comment\n1 2\n\n  -3e2\t+.5\r\n");
  const auto rows = ReadNumberRows(path_, 2);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].values, (std::vector<double>{1, 2}));
  EXPECT_EQ(rows[1].values, (std::vector<double>{-300, 0.5}));
  EXPECT_EQ(rows[1].line, 4);
}

TEST_F(NumberRowsTest, NamesFileLineAndWord) {
  EXPECT_EQ(ErrorOf("1 2\n3 4x\n"), ":2: '4x' is not a number");
  EXPECT_EQ(ErrorOf("1 nan\n"), ":1: 'nan' is not finite");
  EXPECT_EQ(ErrorOf("inf 1\n"), ":1: 'inf' is not finite");
  EXPECT_EQ(ErrorOf("1 1e999\n"), ":1: '1e999' is not a number");
  EXPECT_EQ(ErrorOf("1\n"), ":1: holds 1 numbers instead of 2");
  EXPECT_EQ(ErrorOf(""), "no error");
}

TEST_F(NumberRowsTest, MissingFileIsAnError) {
  EXPECT_THROW(ReadNumberRows(path_, 2), std::invalid_argument);
}

TEST(FormatNumber, IsShortestAndExact) {
  EXPECT_EQ(FormatNumber(0.1), "0.1");
  EXPECT_EQ(FormatNumber(1e-20), "1e-20");
  EXPECT_EQ(FormatNumber(1317384506.4, true), "1317384506.4");
  EXPECT_EQ(FormatNumber(1e10, true), "10000000000");
}

TEST(WholeFile, LeavesNothingWhereItCannotWrite) {
  EXPECT_THROW(WriteWholeFile("/proc/no_such_folder/file", "x"), std::system_error);
  EXPECT_THROW(ReadWholeFile("/proc/no_such_folder/file"), std::invalid_argument);
}

TEST(WholeFile, RefusesAFolder) {
  EXPECT_THROW(ReadWholeFile(std::filesystem::temp_directory_path()), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
