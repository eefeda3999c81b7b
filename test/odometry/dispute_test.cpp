#include "arfm_vo/odometry/dispute.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

PoseEstimate Pose(double contest, bool is_plausible = true) {
  PoseEstimate pose;
  pose.status = PoseStatus::kTracked;
  pose.contest = contest;
  pose.is_plausible = is_plausible;
  return pose;
}

TEST(Dispute, BelievesWhatNobodyContests) {
  Dispute dispute;
  EXPECT_TRUE(dispute.Judge(Pose(0), 0));  // of a new map: nothing is proven yet
  EXPECT_TRUE(dispute.Judge(Pose(0.4), 0));
  EXPECT_FALSE(dispute.IsWary());
}

TEST(Dispute, BelievesAContestedPoseWhosePointsAgreedBefore) {
  Dispute dispute;
  EXPECT_TRUE(dispute.Judge(Pose(0.8), 40));
  EXPECT_TRUE(dispute.IsWary());
}

TEST(Dispute, DoesNotBelieveAContestedPoseOfNewPointsUntilOneIsProven) {
  Dispute dispute;
  EXPECT_FALSE(dispute.Judge(Pose(0.8), 3));
  EXPECT_FALSE(dispute.Judge(Pose(0), 3));  // those who contradicted may only be hidden
  EXPECT_TRUE(dispute.Judge(Pose(0), 40));
  EXPECT_TRUE(dispute.Judge(Pose(0), 3));
}

TEST(Dispute, BelievesALeapThatKnownPointsTellAndNobodyContests) {
  Dispute dispute;
  EXPECT_TRUE(dispute.Judge(Pose(0, false), 40));
  EXPECT_FALSE(dispute.IsWary());
}

TEST(Dispute, DoesNotBelieveALeapOfNewPoints) {
  Dispute dispute;
  EXPECT_FALSE(dispute.Judge(Pose(0, false), 3));
}

TEST(Dispute, DoesNotBelieveALeapAfterAContestHoweverManyPointsSaySo) {
  Dispute dispute;
  EXPECT_TRUE(dispute.Judge(Pose(0.8), 300));
  EXPECT_FALSE(dispute.Judge(Pose(0, false), 300));
  EXPECT_FALSE(dispute.Judge(Pose(0, false), 300));
}

TEST(Dispute, IsWaryForAWhile) {
  Dispute dispute;
  dispute.Judge(Pose(0.8), 40);
  EXPECT_FALSE(dispute.Judge(Pose(0.3), 3)) << "half as much contest counts while wary";
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(dispute.Judge(Pose(0), 40));
  EXPECT_FALSE(dispute.IsWary());
  EXPECT_TRUE(dispute.Judge(Pose(0.3), 3));
}

/// This share of the known points agrees, and all new ones.
AgreeingShares Known(double share) { return {share, 1}; }

/// One that has followed the way for a while.
Dispute OnTheWay() {
  Dispute dispute;
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(dispute.Judge(Pose(0), 59, Known(0.8)));
  return dispute;
}

TEST(Dispute, DoesNotBelieveAPoseThatKnownPointsContradictAndNewOnesDoNot) {
  Dispute dispute = OnTheWay();
  EXPECT_TRUE(dispute.Judge(Pose(0), 59, Known(0.7)));
  EXPECT_FALSE(dispute.Judge(Pose(0), 59, Known(0.3))) << "though some known ones are far away";
  EXPECT_FALSE(dispute.Judge(Pose(0), 59, Known(0.7))) << "no better, by and large";
  EXPECT_TRUE(dispute.Judge(Pose(0), 59, Known(0.9)));
}

TEST(Dispute, BelievesWhereKnownPointsWereAlwaysHardToFind) {
  Dispute dispute = OnTheWay();
  EXPECT_TRUE(dispute.Judge(Pose(0), 59, Known(0.45)));
  EXPECT_TRUE(dispute.Judge(Pose(0), 59, Known(0.3)));
  EXPECT_TRUE(dispute.Judge(Pose(0), 59, AgreeingShares{0.1, 0.2})) << "new ones are no easier";
}

TEST(Dispute, KnownPointsMayLookOtherwiseAfterAGap) {
  Dispute dispute = OnTheWay();
  dispute.Interrupt();
  for (const double share : {0.9, 0.3, 0.3, 0.3, 0.9}) {
    EXPECT_TRUE(dispute.Judge(Pose(0), 59, Known(share)));
  }
  EXPECT_FALSE(dispute.Judge(Pose(0), 59, Known(0.3)));
}

TEST(Dispute, PointsThatBeganAmongWhatMovedTellNoPoseOnTheirOwn) {
  AgreeingShares shares;
  shares.suspect = 0.9;
  EXPECT_FALSE(Dispute().Judge(Pose(0), 3, shares));
  EXPECT_TRUE(Dispute().Judge(Pose(0), 59, shares)) << "the ground is among them";
  shares.suspect = 0.1;
  EXPECT_TRUE(Dispute().Judge(Pose(0), 3, shares));
}

TEST(Dispute, PairsThatAreMissingAreAGap) {
  Dispute dispute = OnTheWay();
  for (const double stamp_s : {7.0, 7.1, 7.2}) dispute.Advance(stamp_s);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(dispute.Judge(Pose(0), 59, Known(0.9)));
  dispute.Advance(7.4);
  Dispute after_gap = dispute;
  after_gap.Advance(8.9);
  EXPECT_FALSE(dispute.Judge(Pose(0), 59, Known(0.3)));
  EXPECT_TRUE(after_gap.Judge(Pose(0), 59, Known(0.3)));
}

TEST(Dispute, LeavesDoubtForAWhile) {
  Dispute dispute = OnTheWay();
  dispute.Judge(Pose(0.8), 3);
  EXPECT_FALSE(dispute.IsDoubtful()) << "contested, but by known points";
  dispute.Judge(Pose(0), 59, Known(0.3));
  for (int i = 0; i < 9; ++i) {
    EXPECT_TRUE(dispute.Judge(Pose(0), 40));
    EXPECT_TRUE(dispute.IsDoubtful());
  }
  dispute.Judge(Pose(0), 40);
  EXPECT_FALSE(dispute.IsDoubtful());
}

TEST(Dispute, IsGivenUpInTheEnd) {
  Dispute dispute = OnTheWay();
  for (int i = 0; i < 29; ++i) {
    EXPECT_FALSE(dispute.Judge(Pose(0), 59, Known(0.3)));
    EXPECT_TRUE(dispute.MayEnd());
  }
  EXPECT_FALSE(dispute.Judge(Pose(0), 59, Known(0.3)));
  EXPECT_FALSE(dispute.MayEnd()) << "a new map is better than none";
}

TEST(Dispute, ResetForgets) {
  Dispute dispute;
  dispute.Judge(Pose(0.8), 3);
  dispute.Reset();
  EXPECT_FALSE(dispute.IsWary());
  EXPECT_TRUE(dispute.Judge(Pose(0), 3));
}

}  // namespace
}  // namespace arfm_vo
