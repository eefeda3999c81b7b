#include "arfm_vo/odometry/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <utility>

#include "arfm_vo/odometry/stereo_frontend.h"
#include "ros/textured_wall.h"

namespace arfm_vo {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kInterval_s = 0.1;

/// A rover in front of a wall: base x forward, camera 1 m up on a pan axis.
class SessionTest : public testing::Test {
 protected:
  static Rigid3 BaseFromCamera(double pan_rad) {
    const Eigen::Quaterniond forward_from_optical(0.5, -0.5, 0.5, -0.5);
    return Rigid3(ExpSO3({0, 0, pan_rad}), Eigen::Vector3d(0.2, 0, 1)) *
           Rigid3(forward_from_optical, Eigen::Vector3d(0.1, 0.15, 0));
  }

  /// The next pair of a base at `x_m` on its way to the wall; `spoil` changes its pictures.
  SessionUpdate Step(double x_m, double pan_rad = 0, bool is_dark = false,
                     const std::function<void(StereoImages&)>& spoil = {}) {
    stamp_s_ += kInterval_s;
    const Rigid3 start_from_base(Eigen::Quaterniond::Identity(), Eigen::Vector3d(x_m, 0, 0));
    const Rigid3 wall_from_camera =
        BaseFromCamera(0).Inverse() * start_from_base * BaseFromCamera(pan_rad);
    StereoImages images =
        is_dark ? wall_.RenderDark(stamp_s_) : wall_.Render(stamp_s_, wall_from_camera.Inverse());
    if (spoil) spoil(images);
    return session_.Process(frontend_.Process(images), wall_.camera(), images,
                            BaseFromCamera(pan_rad));
  }

  /// Of the first keyframe, which lies a metre further ahead.
  MapUpdate MoveAhead(const SessionUpdate& first, int num_keyframes) const {
    MapUpdate update;
    update.correction = CorrectionBelief::OfCalibration(wall_.camera());
    update.num_keyframes = num_keyframes;
    const Rigid3 moved(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, -1));
    update.keyframes.push_back(
        {first.keyframe->keyframe.id, moved * first.keyframe->keyframe.camera_from_world});
    return update;
  }

  static LocalOdometryOptions Options() {
    LocalOdometryOptions options;
    options.restart_after_lost_s = 0.5;
    return options;
  }

  TexturedWall wall_;
  StereoFrontend frontend_{wall_.camera(), {}};
  Session session_{Options()};
  double stamp_s_ = 100;
};

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

TEST_F(SessionTest, OneEyeTellsThePoseForAWhile) {
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
  const cv::Mat texture = TexturedWall(5).Render(0, Rigid3()).left;
  const auto show_object = [&](StereoImages& images) {
    const cv::Rect place(150, 60, 300, 190);  // 40 % of the picture
    texture(cv::Rect(0, 0, 300, 190)).copyTo(images.left(place));
    texture(cv::Rect(0, 0, 300, 190)).copyTo(images.right(place - cv::Point(40, 0)));
    TexturedWall::AddNoise(stamp_s_, images);
  };
  for (int i = 0; i < 6; ++i) Step(0.1 * i);
  for (int i = 6; i < 25; ++i) {
    const SessionUpdate pose = Step(0.1 * i, 0, false, show_object);
    const double error_m = std::abs(pose.odom_from_base.translation.x() - 0.1 * i);
    EXPECT_LT(error_m, 0.05) << i << ": " << pose.text;
    if (pose.IsTracked()) {
      EXPECT_LT(error_m, 3 * std::sqrt(pose.covariance(0, 0)) + 0.005) << i;
    }
  }
}

TEST_F(SessionTest, StartsANewEpochWhereItMayBeWhenItWasLostTooLong) {
  Step(0);
  Step(0.05);
  const double before = Step(0.1).covariance(0, 0);
  for (int i = 0; i < 7; ++i) Step(0.1, 0, true);  // 0.7 s
  const TexturedWall elsewhere(2);
  const SessionUpdate found = Step(0, 0, false, [&](StereoImages& images) {
    images = elsewhere.Render(images.stamp_s, Rigid3());
  });
  ASSERT_TRUE(found.IsTracked()) << found.text;
  EXPECT_EQ(found.epoch, 2u);
  EXPECT_NEAR(found.odom_from_base.translation.x(), 0.5, 0.03);  // 0.5 m/s for 0.8 s
  EXPECT_GT(found.covariance(0, 0), before + 0.1);
}

TEST_F(SessionTest, BeginsAnewOnGroundThatTheMapDoesNotKnow) {
  const TexturedWall elsewhere(2);
  for (const int num_known : {4, 1}) {
    session_ = Session(Options());
    for (int i = 0; i < num_known; ++i) Step(0.3 * i);
    int num_unknown = 0;
    SessionUpdate pose;
    for (int i = 0; i < 5; ++i) {
      pose = Step(0, 0, false, [&](StereoImages& images) {
        const Rigid3 camera_from_wall(Eigen::Quaterniond::Identity(), {0, 0, -0.3 * i});
        images = elsewhere.Render(images.stamp_s, camera_from_wall);
      });
      num_unknown += !pose.IsTracked();
    }
    EXPECT_EQ(num_unknown, 2);
    EXPECT_EQ(pose.epoch, 2u);
    const double error_m = pose.odom_from_base.translation.x() - 0.3 * (num_known + 4);
    EXPECT_LT(std::abs(error_m), 3 * std::sqrt(pose.covariance(0, 0))) << "its speed unknown at 1";
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

TEST_F(SessionTest, DoubtsANewMapThatMovesOtherwiseThanTheOneBefore) {
  LocalOdometryOptions options;
  options.restart_after_lost_s = 0;
  session_ = Session(options);
  for (int i = 0; i < 4; ++i) Step(0.3 * i);
  const TexturedWall object(2);  // hides the wall from now on and goes with the camera
  int num_doubted = 0, num_named = 0;
  for (int i = 4; i < 34; ++i) {
    const SessionUpdate pose = Step(0, 0, false, [&](StereoImages& images) {
      images = object.Render(images.stamp_s, Rigid3());
    });
    const bool is_doubted = pose.epoch == 2 && !pose.IsTracked();
    num_doubted += is_doubted;
    num_named += pose.update.reason == Reason::kNewMap;
    if (!pose.IsTracked()) continue;
    const double error_m = std::abs(pose.odom_from_base.translation.x() - 0.3 * i);
    EXPECT_LT(error_m, 3 * std::sqrt(pose.covariance(0, 0))) << i;
  }
  EXPECT_NEAR(num_doubted * kInterval_s, 2, 0.15);
  EXPECT_EQ(num_named, num_doubted);
}

TEST_F(SessionTest, BeginsNoEpochWithPairsWhosePicturesDoNotAgree) {
  for (int i = 0; i < 4; ++i) Step(0.3 * i);
  const TexturedWall elsewhere(2);
  for (int i = 0; i < 10; ++i) {
    stamp_s_ += kInterval_s;
    const StereoImages images = elsewhere.Render(stamp_s_, Rigid3());
    StereoFrame frame = frontend_.Process(images);
    ASSERT_GT(frame.points.size(), 100u);
    frame.row_agreement = 0.2;
    const SessionUpdate pose = session_.Process(frame, wall_.camera(), images, BaseFromCamera(0));
    EXPECT_FALSE(pose.IsTracked());
    EXPECT_EQ(pose.epoch, 1u) << i;
  }
}

TEST_F(SessionTest, AMapUpdateMovesTheTrajectoryAndNotThePose) {
  const SessionUpdate first = Step(0);
  Step(0.1);
  const MapUpdate update = MoveAhead(first, 1);
  session_.Offer(update, 7);  // of an epoch that is not
  EXPECT_NEAR(Step(0.2).odom_from_base.translation.x(), 0.2, 0.01);
  EXPECT_NEAR(session_.MakeTrajectory()[1].world_from_camera.translation.z(), 0.1, 0.01);
  session_.Offer(update, 1);
  EXPECT_NEAR(Step(0.3).odom_from_base.translation.x(), 0.3, 0.01);
  EXPECT_NEAR(session_.MakeTrajectory()[1].world_from_camera.translation.z(), 1.1, 0.01);
}

TEST_F(SessionTest, AnUpdateComesIntoForceAtItsFrameHoweverEarlyItIsOffered) {
  const SessionUpdate first = Step(0);
  const MapUpdate update = MoveAhead(first, 20);
  ASSERT_EQ(session_.TakeoverFrame(update), 3u);  // of frame 0, 1 + 20 / 10 later
  session_.Offer(update, 1);
  const auto adjusted_z = [&] {
    return session_.MakeTrajectory()[0].world_from_camera.translation.z() -
           session_.MakeTrajectory()[1].world_from_camera.translation.z();
  };
  Step(0);
  Step(0);
  EXPECT_NEAR(adjusted_z(), 0, 0.01);
  const Trajectory before = session_.MakeTrajectory();
  Step(0);
  EXPECT_EQ(session_.num_frames(), 4u);
  session_.Offer(update, 1);
  session_.TakeOffer();
  EXPECT_EQ(session_.MakeTrajectory().size(), 4u);
}

TEST_F(SessionTest, TheTrajectoryGoesOnThroughEpochsAndLostPairs) {
  Step(0, 0, true);
  for (int i = 0; i < 4; ++i) Step(0.05 * i);
  Step(0.2, 0, true);
  session_.StartEpoch();
  for (int i = 3; i < 6; ++i) Step(0.05 * i);
  const Trajectory trajectory = session_.MakeTrajectory();
  ASSERT_EQ(trajectory.size(), 9u);
  EXPECT_FALSE(trajectory[0].is_tracked);
  EXPECT_LT(trajectory[1].world_from_camera.translation.norm(), 1e-9);
  EXPECT_NEAR(trajectory[4].world_from_camera.translation.z(), 0.15, 0.01);
  EXPECT_FALSE(trajectory[5].is_tracked);
  EXPECT_NEAR(trajectory[6].world_from_camera.translation.z(), 0.2, 0.01);  // gone on in the dark
  EXPECT_NEAR(trajectory[8].world_from_camera.translation.z(), 0.3, 0.01);
  for (size_t i = 1; i < trajectory.size(); ++i)
    EXPECT_GT(trajectory[i].stamp_s, trajectory[i - 1].stamp_s);
}

}  // namespace
}  // namespace arfm_vo
