#include "arfm_vo/odometry/verdict.h"

#include <gtest/gtest.h>

#include "mapping/stereo_frames.h"

namespace arfm_vo {
namespace {

class VerdictTest : public ::testing::Test {
 protected:
  VerdictTest() {
    frame_.features.keypoints.resize(300);
    frame_.num_right_keypoints = 300;
    tracked_.pose.status = PoseStatus::kTracked;
    tracked_.pose.num_inliers = 100;
    for (int i = 0; i < 100; ++i) {
      LandmarkObservation observation{};
      observation.landmark = i;
      observation.has_right = true;
      tracked_.observations.push_back(observation);
    }
  }
  void Look(double row_agreement = 0.9) {
    frame_.stamp_s += 0.1;
    frame_.row_agreement = row_agreement;
    verdict_.Advance(frame_.stamp_s);
    verdict_.Look(frame_);
  }
  OdometryUpdate Weigh() {
    OdometryUpdate update;
    update.pose = tracked_.pose;
    has_pose_ = verdict_.Weigh(tracked_, std::nullopt, update);
    return update;
  }

  void LookAndWeigh(int num_pairs) {
    for (int i = 0; i < num_pairs; ++i) {
      Look();
      Weigh();
    }
  }

  StereoFrame frame_;
  TrackedFrame tracked_;
  static constexpr double kBaseline_m = 0.1;
  Verdict verdict_{kBaseline_m};
  bool has_pose_ = false;
};

TEST_F(VerdictTest, WhereNothingContradictsThePoseIsTracked) {
  Look();
  const OdometryUpdate update = Weigh();
  EXPECT_TRUE(has_pose_);
  EXPECT_EQ(update.pose.status, PoseStatus::kTracked);
  EXPECT_EQ(update.reason, Reason::kNone);
  EXPECT_FALSE(verdict_.IsUnsure());
}

TEST_F(VerdictTest, ARivalThatIsAsLikelyWidensTheCovarianceToIt) {
  Look();
  tracked_.pose.rival = Rigid3(Eigen::Quaterniond::Identity(), {1, 0, 0});
  const OdometryUpdate update = Weigh();
  ASSERT_TRUE(has_pose_);
  EXPECT_EQ(update.pose.status, PoseStatus::kTracked);
  EXPECT_EQ(update.reason, Reason::kGroupsDiffer);
  EXPECT_NEAR(update.pose.covariance(3, 3), 0.5, 0.1);
  EXPECT_EQ(update.doubt, update.pose.covariance);
  EXPECT_TRUE(verdict_.IsUnsure());
}

TEST_F(VerdictTest, ARivalThatIsFixedBeforeTheCameraIsNothingThatMoves) {
  tracked_.pose.rival = Rigid3(Eigen::Quaterniond::Identity(), {1, 0, 0});
  tracked_.fixed_log_odds = 10;
  LookAndWeigh(1);
  EXPECT_FALSE(verdict_.IsUnsure());
}

TEST_F(VerdictTest, WhatIsStillCountsAsFixedTheLessTheLikelierAnotherMoves) {
  const auto count = [&](bool has_rival) {
    if (has_rival) tracked_.pose.rival = Rigid3(Eigen::Quaterniond::Identity(), {1, 0, 0});
    LookAndWeigh(1);
    const double before = verdict_.Expect(std::nullopt).fixed_log_odds;
    verdict_.CountFixed(0.6);
    return verdict_.Expect(std::nullopt).fixed_log_odds - before;
  };
  const double where_none_moves = count(false);
  EXPECT_GT(where_none_moves, 4);
  EXPECT_LT(count(true), where_none_moves / 2);
}

TEST_F(VerdictTest, AnUnlikelyRivalHardlyMatters) {
  Look();
  tracked_.pose.rival = Rigid3(Eigen::Quaterniond::Identity(), {1, 0, 0});
  tracked_.log_odds_of_rival = -12;
  const OdometryUpdate update = Weigh();
  EXPECT_EQ(update.pose.status, PoseStatus::kTracked);
  EXPECT_LT(update.pose.covariance(3, 3), 1e-3);
}

TEST_F(VerdictTest, APoseIsTakenAwayOnlyWhereAnotherAnswerIsLikelier) {
  for (const double log_odds : {-1., -12.}) {
    verdict_.Reset(false);
    Look();
    tracked_.log_odds = log_odds;
    const OdometryUpdate update = Weigh();
    EXPECT_EQ(has_pose_, log_odds > -5);
    EXPECT_EQ(update.reason == Reason::kGroundHidden, !has_pose_);
  }
}

/// Then it is right, or hardly wrong, whatever is followed.
TEST_F(VerdictTest, APoseToWhichTheMotionBeforeLeadsIsKeptHoweverUnlikely) {
  PredictedPose predicted{Rigid3()};
  predicted.sigma_shift_m = 0.1;
  predicted.sigma_turn_rad = 0.1;
  struct Case {
    double off_m;
    bool follows, is_kept;
  };
  for (const Case& one : {Case{0.05, true, true}, {0.05, false, false}, {0.5, true, false}}) {
    verdict_.Reset(false);
    Look();
    tracked_.log_odds = 0;
    tracked_.pose.camera_from_world = Rigid3();
    Weigh();
    if (!one.follows) Look();  // a pair without a pose
    Look();
    tracked_.log_odds = -12;
    tracked_.pose.camera_from_world.translation.x() = one.off_m;
    OdometryUpdate update;
    update.pose = tracked_.pose;
    EXPECT_EQ(verdict_.Weigh(tracked_, predicted, update), one.is_kept) << one.off_m;
    EXPECT_EQ(update.reason, one.is_kept ? Reason::kGroupsDiffer : Reason::kGroundHidden);
    if (one.is_kept) EXPECT_NEAR(update.pose.covariance(3, 3), 0.05 * 0.05, 1e-4);
  }
}

TEST_F(VerdictTest, WhatWasFollowedInDoubtStaysInDoubtForAWhile) {
  Look();
  tracked_.log_odds = -5;
  Weigh();
  tracked_.log_odds = 0;
  int num_pairs = 0;
  do Look(), ++num_pairs;
  while (Weigh().reason != Reason::kNone && num_pairs < 1000);
  EXPECT_GT(num_pairs, 5);
  EXPECT_LT(num_pairs, 100);
}

/// Something large comes rarely. Where it has come, the ground may be hidden at any moment.
TEST_F(VerdictTest, WhereSomethingHasComeTheGroundIsLikelierToBeHiddenJustNow) {
  LookAndWeigh(10);
  const Expectation expected = verdict_.Expect(std::nullopt);
  EXPECT_GT(expected.if_none.ground, expected.if_come.ground);
  EXPECT_GT(expected.if_come.just_hidden, 100 * expected.if_none.just_hidden);
  EXPECT_NEAR(expected.if_come.just_hidden, expected.if_none.ground * 0.1 / 2, 0.01);
}

TEST_F(VerdictTest, RowsThatDoNotAgreeTakeTheRightPictureAway) {
  LookAndWeigh(10);
  Look(0.2);
  Look(0.2);
  EXPECT_EQ(verdict_.right_fault(), Reason::kRightOff);
  EXPECT_EQ(verdict_.left_fault(), Reason::kNone);
  const OdometryUpdate update = Weigh();
  EXPECT_EQ(update.reason, Reason::kRightOff);
  EXPECT_EQ(update.pose.status, PoseStatus::kDegraded) << "the left image alone tells";
  for (int i = 0; i < 3; ++i) Look();
  EXPECT_EQ(verdict_.right_fault(), Reason::kNone);
}

TEST_F(VerdictTest, RowsOfWhichHalfAgreeDoNot) {  // few corners and blur make matches wrong
  for (int i = 0; i < 200; ++i) {
    Look(0.52);
    EXPECT_EQ(verdict_.right_fault(), Reason::kNone) << i;
    Weigh();
  }
}

TEST_F(VerdictTest, PicturesThatAreNotToBeUsedAreNamed) {
  frame_.right_is_repeated = true;
  Look();
  EXPECT_EQ(verdict_.right_fault(), Reason::kRightRepeated);
  frame_.right_is_repeated = false;
  frame_.num_right_keypoints = 10;
  Look();
  EXPECT_EQ(verdict_.right_fault(), Reason::kRightBlind);
  frame_.num_right_keypoints = 300;
  frame_.images_are_swapped = true;
  Look(0.1);
  EXPECT_EQ(verdict_.right_fault(), Reason::kSwapped);
  frame_.left_is_repeated = true;
  Look();
  EXPECT_EQ(verdict_.left_fault(), Reason::kLeftRepeated);
}

/// In a turn two pictures of different moments look as if left and right were exchanged.
TEST_F(VerdictTest, SwappedIsTheLeftImageThatIsSeenFromTheRightCamera) {
  PredictedPose predicted{Rigid3()};
  predicted.sigma_shift_m = 0.01;
  predicted.sigma_turn_rad = 0.01;
  frame_.images_are_swapped = true;
  for (const bool is_swapped : {false, true}) {
    Look();
    tracked_.pose.camera_from_world.translation.x() = is_swapped ? -kBaseline_m : 0;
    OdometryUpdate update;
    update.pose = tracked_.pose;
    EXPECT_EQ(verdict_.Weigh(tracked_, predicted, update), !is_swapped);
    EXPECT_EQ(update.reason, is_swapped ? Reason::kSwapped : Reason::kRightOff);
    EXPECT_EQ(update.pose.status, is_swapped ? PoseStatus::kNoConsensus : PoseStatus::kDegraded);
  }
  tracked_.pose.camera_from_world = Rigid3();
  Weigh();
  EXPECT_FALSE(has_pose_) << "without a prediction it may as well be";
}

TEST_F(VerdictTest, TheLeftImageAloneDegrades) {
  frame_.right_is_repeated = true;
  Look();
  const OdometryUpdate update = Weigh();
  EXPECT_TRUE(has_pose_);
  EXPECT_EQ(update.pose.status, PoseStatus::kDegraded);
  EXPECT_EQ(update.Describe(),
            "degraded: the right camera repeats its picture, the left one alone tells");
}

/// Whether the depths of 40 points are known, of which so many have the disparity `near_px` and the
/// rest one of 0.4 px.
bool AreKnownAt(double near_px, int num_near) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 40; ++i) {
    points.emplace_back(60 + 70 * (i % 8), 60 + 80 * (i / 8), i < num_near ? near_px : 0.4);
  }
  LocalMap map(kCamera, LocalMapOptions());
  const Keyframe& keyframe =
      map.AddKeyframe(MakeFrame(points), cv::Mat(480, 640, CV_8UC1, cv::Scalar(0)), Rigid3(), {});
  return AreDepthsKnown(kCamera, map, keyframe.observations, Rigid3());
}

TEST(AreDepthsKnown, PointsTooFarTellNoLengthOfThePath) {
  EXPECT_TRUE(AreKnownAt(35, 40));
  EXPECT_TRUE(AreKnownAt(35, 4)) << "the near ones tell it";
  EXPECT_FALSE(AreKnownAt(1.5, 2));
  EXPECT_FALSE(AreKnownAt(35, 0));
}

}  // namespace
}  // namespace arfm_vo
