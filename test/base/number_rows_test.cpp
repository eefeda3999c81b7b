#include "arfm_vo/base/number_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <random>

#include "arfm_vo/base/whole_file.h"

namespace arfm_vo {
namespace {

TEST(ParseNumber, ReadsDecimalNumbersOnly) {
  double number = 7;
  for (const char* text :
       {"",     "+",  "-",   ".",     "+-5", "++5", "- 5", " 5",    "5 ",     "\t5",
        "0x10", "1e", "1e+", "1.2.3", "1,5", "1_0", "1d5", "1e999", "-1e999", "1e-999"}) {
    EXPECT_FALSE(ParseNumber(text, number)) << text;
  }
  EXPECT_FALSE(ParseNumber(std::string("1\0", 2), number));
  EXPECT_EQ(number, 7);
  const std::pair<const char*, double> numbers[] = {
      {"5.", 5},     {"-.5", -0.5},           {"+1e+2", 100},     {"1E-2", 0.01},
      {"0e-999", 0}, {"1e-310", 1e-310},      {"5e-324", 5e-324}, {"inf", HUGE_VAL},
      {"0.1", 0.1},  {"-infinity", -HUGE_VAL}};
  for (const auto& [text, expected] : numbers) {
    EXPECT_TRUE(ParseNumber(text, number)) << text;
    EXPECT_EQ(number, expected) << text;
  }
  EXPECT_TRUE(ParseNumber("nan", number));
  EXPECT_TRUE(std::isnan(number));
}

TEST(FormatNumber, IsShortestAndExact) {
  const std::pair<double, const char*> texts[] = {
      {0.1, "0.1"},
      {1e-20, "1e-20"},
      {1e5, "1e+05"},
      {-123456, "-123456"},
      {1e-4, "1e-04"},
      {0.00012, "0.00012"},
      {0, "0"},
      {-0.0, "-0"},
      {5e-324, "5e-324"},
      {1.0 / 3, "0.3333333333333333"},
      {HUGE_VAL, "inf"},
      {-HUGE_VAL, "-inf"},
      {0.1 + 0.2, "0.30000000000000004"},
      {std::numeric_limits<double>::max(), "1.7976931348623157e+308"}};
  for (const auto& [value, text] : texts) EXPECT_EQ(FormatNumber(value), text);
  EXPECT_EQ(FormatNumber(1317384506.4, true), "1317384506.4");
  EXPECT_EQ(FormatNumber(1e10, true), "10000000000");
  EXPECT_EQ(FormatNumber(1e23, true), "99999999999999991611392");
  EXPECT_EQ(FormatNumber(-1.5e-7, true), "-0.00000015");
}

TEST(FormatNumber, ReadsBackAsTheSameDouble) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> mantissa(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    const double value = std::ldexp(mantissa(random), i % 2098 - 1050);
    double read = 0;
    ASSERT_TRUE(ParseNumber(FormatNumber(value), read)) << FormatNumber(value);
    ASSERT_EQ(read, value);
    ASSERT_TRUE(ParseNumber(FormatNumber(value, true), read)) << FormatNumber(value, true);
    ASSERT_EQ(read, value);
  }
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
