#include "arfm_vo/ros/input/stamp_order.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

StampVerdict Judge(StampOrder& order, double stamp_s) { return order.Judge(ros::Time(stamp_s)); }

TEST(StampOrder, LaterPairsAreTaken) {
  StampOrder order;
  EXPECT_EQ(Judge(order, 5), StampVerdict::kNext);
  EXPECT_EQ(Judge(order, 5.1), StampVerdict::kNext);
}

TEST(StampOrder, APairThatComesAgainIsPassedOver) {
  StampOrder order;
  Judge(order, 5);
  EXPECT_EQ(Judge(order, 5), StampVerdict::kStray);
  EXPECT_EQ(Judge(order, 5.1), StampVerdict::kNext);
}

TEST(StampOrder, OldPairsAmongNewOnesArePassedOverHoweverOftenTheyCome) {
  StampOrder order;
  Judge(order, 5);
  for (int i = 1; i < 5; ++i) {
    EXPECT_EQ(Judge(order, 4 + 0.1 * i), StampVerdict::kStray);
    EXPECT_EQ(Judge(order, 5 + i), StampVerdict::kNext);
  }
}

TEST(StampOrder, TheSameOldPairTwiceIsNoJump) {
  StampOrder order;
  Judge(order, 5);
  EXPECT_EQ(Judge(order, 4), StampVerdict::kStray);
  EXPECT_EQ(Judge(order, 4), StampVerdict::kStray);
  EXPECT_EQ(Judge(order, 3), StampVerdict::kStray) << "time runs forward";
  EXPECT_EQ(Judge(order, 5.1), StampVerdict::kNext);
}

TEST(StampOrder, TwoInARowThatAreEarlierAreAJumpOfTime) {
  StampOrder order;
  Judge(order, 100);
  EXPECT_EQ(Judge(order, 5), StampVerdict::kStray);
  EXPECT_EQ(Judge(order, 5.1), StampVerdict::kJumpBack);
  EXPECT_EQ(Judge(order, 5.2), StampVerdict::kNext);
}

}  // namespace
}  // namespace arfm_vo
