#include "arfm_vo/ros/input/pair_numbers.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

TEST(PairNumbers, WhoComesLateMissesNothing) {
  PairNumbers numbers;
  for (uint32_t number = 17; number < 30; ++number) EXPECT_EQ(numbers.CountMissing(number), 0u);
}

TEST(PairNumbers, GapsAddUp) {
  PairNumbers numbers;
  EXPECT_EQ(numbers.CountMissing(5), 0u);
  EXPECT_EQ(numbers.CountMissing(8), 2u);
  EXPECT_EQ(numbers.CountMissing(9), 2u);
  EXPECT_EQ(numbers.CountMissing(11), 3u);
}

TEST(PairNumbers, AnotherSenderBeginsAnew) {
  PairNumbers numbers;
  numbers.CountMissing(5);
  numbers.CountMissing(9);
  EXPECT_EQ(numbers.CountMissing(1), 0u);
  EXPECT_EQ(numbers.CountMissing(3), 1u);
}

}  // namespace
}  // namespace arfm_vo
