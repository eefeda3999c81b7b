#include "session_fixture.h"

namespace arfm_vo {
namespace {

TEST_F(SessionTest, FollowsTheBaseForward) {
  const SessionUpdate first = Step(0);
  ASSERT_TRUE(first.IsTracked()) << first.text;
  EXPECT_LT(first.odom_from_base.translation.norm(), 1e-9);
  ASSERT_TRUE(first.keyframe);
  EXPECT_EQ(first.keyframe->epoch, 1u);
  SessionUpdate pose;
  for (int i = 1; i <= 10; ++i) pose = Step(0.05 * i);
  ASSERT_TRUE(pose.IsTracked()) << pose.text;
  EXPECT_LT((pose.odom_from_base.translation - Eigen::Vector3d(0.5, 0, 0)).norm(), 0.01);
  EXPECT_LT(pose.odom_from_base.Angle(), 0.3 * kDegree);
  EXPECT_NEAR(pose.twist[0], 0.5, 0.1);
  EXPECT_GT(pose.covariance(0, 0), 0);
  EXPECT_LT(pose.covariance(0, 0), 0.01);
}

TEST_F(SessionTest, APanningHeadDoesNotMoveAParkedBase) {
  for (int i = 0; i <= 15; ++i) {
    const SessionUpdate pose = Step(0, 2 * i * kDegree);
    ASSERT_TRUE(pose.IsTracked()) << i << ": " << pose.text;
    EXPECT_LT(pose.odom_from_base.translation.norm(), 0.01) << i;
    EXPECT_LT(pose.odom_from_base.Angle(), 0.3 * kDegree) << i;
  }
}

TEST_F(SessionTest, ASkippedPairHasNoPoseAndCountsNotAsLost) {
  EXPECT_TRUE(Step(0).IsTracked());
  for (int i = 0; i < 10; ++i) {
    stamp_s_ += kInterval_s;
    const SessionUpdate skipped = session_.Skip(stamp_s_, PoseStatus::kNoTransform, "no tf: why");
    EXPECT_FALSE(skipped.IsTracked());
    EXPECT_FALSE(skipped.IsTried());
    EXPECT_EQ(skipped.text, "no tf: why");
    EXPECT_EQ(skipped.covariance(0, 0), kUnknownVariance);
  }
  EXPECT_TRUE(Step(0.1).IsTracked());
  EXPECT_EQ(session_.epoch(), 1u);
}

TEST_F(SessionTest, GoesOnInTheDarkAndFindsItselfInTheSameMap) {
  Step(0);
  double sigma_m = std::sqrt(Step(0.05).covariance(0, 0));
  for (int i = 0; i < 3; ++i) {
    const SessionUpdate dark = Step(0, 0, true);
    EXPECT_EQ(dark.update.pose.status, PoseStatus::kDegraded) << dark.text;
    EXPECT_FALSE(dark.update.pose.IsMeasured());
    EXPECT_FALSE(dark.update.is_keyframe);
    const double error_m = dark.odom_from_base.translation.x() - 0.05 * (i + 2);
    EXPECT_LT(std::abs(error_m), 0.01);  // as fast as before
    EXPECT_NEAR(dark.twist[0], 0.05 / kInterval_s, 0.05);
    EXPECT_GT(std::sqrt(dark.covariance(0, 0)), sigma_m + 0.01);  // and less sure
    sigma_m = std::sqrt(dark.covariance(0, 0));
  }
  const SessionUpdate found = Step(0.2);
  ASSERT_TRUE(found.IsTracked()) << found.text;
  EXPECT_EQ(found.epoch, 1u);
  EXPECT_NEAR(found.odom_from_base.translation.x(), 0.2, 0.01);
  EXPECT_LT(std::sqrt(found.covariance(0, 0)), 0.02);
}

TEST_F(SessionTest, IsLostWhenItHasBeenDarkForTwoSeconds) {
  LocalOdometryOptions options;
  options.restart_after_lost_s = 0;
  session_ = Session(options);
  Step(0);
  Step(0.05);
  for (int i = 1; i <= 20; ++i) EXPECT_TRUE(Step(0, 0, true).HasPose()) << i;
  const SessionUpdate lost = Step(0, 0, true);
  EXPECT_FALSE(lost.HasPose());
  EXPECT_EQ(lost.covariance(3, 3), kUnknownVariance);
}

TEST_F(SessionTest, WhatIsWrongWithThePicturesIsToldAndDoesNotMoveThePose) {
  StereoImages last;
  const std::pair<const char*, std::function<void(StereoImages&)>> rows[] = {
      {"repeats its picture",
       [&](StereoImages& images) {
         images.left = last.left;
         images.right = last.right;
       }},
      {"left and right are swapped",
       [](StereoImages& images) { std::swap(images.left, images.right); }},
      {"right camera sees nothing",
       [](StereoImages& images) { images.right.setTo(std::fmod(10 * images.stamp_s, 8)); }}};
  for (const auto& [text, spoil] : rows) {
    session_ = Session(Options());
    for (int i = 0; i < 3; ++i)
      Step(0.05 * i, 0, false, [&](StereoImages& images) { last = images; });
    for (int i = 3; i < 6; ++i) {
      const SessionUpdate spoilt = Step(0.05 * i, 0, false, spoil);
      EXPECT_EQ(spoilt.update.pose.status, PoseStatus::kDegraded) << text;
      EXPECT_THAT(spoilt.text, testing::HasSubstr(text));
      EXPECT_NEAR(spoilt.odom_from_base.translation.x(), 0.05 * i, 0.02) << text;
      EXPECT_NEAR(spoilt.odom_from_base.translation.y(), 0, 0.02) << text;
    }
    const SessionUpdate good = Step(0.3);
    EXPECT_TRUE(good.IsTracked()) << good.text;
    EXPECT_NEAR(good.odom_from_base.translation.x(), 0.3, 0.01);
  }
}

TEST_F(SessionTest, OneCameraTellsThePoseForAWhile) {
  Step(0);
  for (int i = 1; i <= 3; ++i) Step(0.2 * i);
  StereoImages last;
  Step(0.8, 0, false, [&](StereoImages& images) { last = images; });
  int num_keyframes = 0;
  for (int i = 5; i <= 14; ++i) {
    const SessionUpdate pose =
        Step(0.2 * i, 0, false, [&](StereoImages& images) { images.right = last.right; });
    EXPECT_EQ(pose.update.pose.status, PoseStatus::kDegraded) << pose.text;
    EXPECT_TRUE(pose.update.pose.IsMeasured());
    EXPECT_THAT(pose.text, testing::HasSubstr("right camera repeats"));
    EXPECT_NEAR(pose.odom_from_base.translation.x(), 0.2 * i, 0.03);
    num_keyframes += pose.update.is_keyframe;
  }
  EXPECT_GT(num_keyframes, 1);  // the map goes on, with points by motion
  const SessionUpdate both = Step(3);
  EXPECT_TRUE(both.IsTracked()) << both.text;
  EXPECT_EQ(both.epoch, 1u);
}

TEST_F(SessionTest, SaysThatThePicturesAreNotOfOneMoment) {
  std::optional<cv::Mat> before;
  const auto delay = [&](StereoImages& images) {
    const cv::Mat right = images.right;
    if (before) images.right = *before;
    before = right;
  };
  for (int i = 0; i < 4; ++i) Step(0.02 * i, 0.01 * i * i);
  for (int i = 4; i < 7; ++i) {
    const SessionUpdate pose = Step(0.3 * i, 0, false, delay);  // 0.3 m from pair to pair
    if (i == 4) continue;
    EXPECT_THAT(pose.text, testing::HasSubstr("the left one alone tells"));
    EXPECT_NEAR(pose.odom_from_base.translation.x(), 0.3 * i, 0.05);
  }
}

TEST_F(SessionTest, IsNotMisledByALargeObjectThatMovesWithTheCamera) {
  for (int i = 0; i < 6; ++i) Step(0.1 * i);
  for (int i = 6; i < 25; ++i) {
    const SessionUpdate pose = StepWithObject(0.1 * i);
    const double error_m = std::abs(pose.odom_from_base.translation.x() - 0.1 * i);
    EXPECT_LT(error_m, 0.05) << i << ": " << pose.text;
    if (pose.IsTracked()) {
      EXPECT_LT(error_m, 3 * std::sqrt(pose.covariance(0, 0)) + 0.005) << i;
    }
  }
}

TEST_F(SessionTest, RowsThatTheCalibrationHasElsewhereDoNotTiltThePose) {
  const auto shift_rows = [](StereoImages& images) {
    const cv::Matx23f two_down(1, 0, 0, 0, 1, 2);
    cv::warpAffine(images.right.clone(), images.right, two_down, images.right.size(),
                   cv::INTER_NEAREST, cv::BORDER_REFLECT);
  };
  for (int i = 0; i < 20; ++i) {
    const SessionUpdate pose = Step(0.1 * i, 0, false, shift_rows);
    ASSERT_TRUE(pose.IsTracked()) << i << ": " << pose.text;
    const Eigen::Vector3d error = pose.odom_from_base.translation - Eigen::Vector3d(0.1 * i, 0, 0);
    EXPECT_LT(error.norm(), 0.01) << i;
    EXPECT_LT(pose.odom_from_base.Angle(), 0.001) << i;
  }
}

}  // namespace
}  // namespace arfm_vo
