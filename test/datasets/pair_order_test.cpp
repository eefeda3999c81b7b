#include "arfm_vo/datasets/pair_order.h"

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

TEST(StampOrder, LaterPairsAreTaken) {
  StampOrder<double> order;
  EXPECT_EQ(order.Judge(5), StampVerdict::kNext);
  EXPECT_EQ(order.Judge(5.1), StampVerdict::kNext);
}

TEST(StampOrder, APairThatComesAgainIsPassedOver) {
  StampOrder<double> order;
  order.Judge(5);
  EXPECT_EQ(order.Judge(5), StampVerdict::kStray);
  EXPECT_EQ(order.Judge(5.1), StampVerdict::kNext);
}

TEST(StampOrder, OldPairsAmongNewOnesArePassedOverHoweverOftenTheyCome) {
  StampOrder<double> order;
  order.Judge(5);
  for (int i = 1; i < 5; ++i) {
    EXPECT_EQ(order.Judge(4 + 0.1 * i), StampVerdict::kStray);
    EXPECT_EQ(order.Judge(5 + i), StampVerdict::kNext);
  }
}

TEST(StampOrder, TheSameOldPairTwiceIsNoJump) {
  StampOrder<double> order;
  order.Judge(5);
  EXPECT_EQ(order.Judge(4), StampVerdict::kStray);
  EXPECT_EQ(order.Judge(4), StampVerdict::kStray);
  EXPECT_EQ(order.Judge(3), StampVerdict::kStray) << "time runs forward";
  EXPECT_EQ(order.Judge(5.1), StampVerdict::kNext);
}

TEST(StampOrder, TwoInARowThatAreEarlierAreAJumpOfTime) {
  StampOrder<double> order;
  order.Judge(100);
  EXPECT_EQ(order.Judge(5), StampVerdict::kStray);
  EXPECT_EQ(order.Judge(5.1), StampVerdict::kJumpBack);
  EXPECT_EQ(order.Judge(5.2), StampVerdict::kNext);
}

}  // namespace
}  // namespace arfm_vo
