#include "arfm_vo/tracking/frame_tracker.h"

#include <gtest/gtest.h>

#include "tracking/tracked_wall.h"

namespace arfm_vo {
namespace {

TEST_F(FrameTrackerTest, FindsThePoseWithAGoodPrediction) {
  const TrackedFrame tracked = Track(truth_, truth_);
  ASSERT_TRUE(tracked.pose.IsTracked());
  ExpectNear(tracked.pose.camera_from_world, truth_, 0.01);
  EXPECT_GT(tracked.pose.num_inliers, 50);
  EXPECT_EQ(static_cast<int>(tracked.observations.size()), tracked.pose.num_inliers);
}

TEST_F(FrameTrackerTest, NeedsNoPrediction) {
  const TrackedFrame tracked = Track(truth_, std::nullopt);
  ASSERT_TRUE(tracked.pose.IsTracked());
  ExpectNear(tracked.pose.camera_from_world, truth_, 0.01);
}

TEST_F(FrameTrackerTest, IsNotMisledByAWrongPrediction) {
  const Rigid3 wrong(ExpSO3({0, 0.8, 0}), Eigen::Vector3d(3, 0, 2));
  const TrackedFrame tracked = Track(truth_, wrong);
  ASSERT_TRUE(tracked.pose.IsTracked());
  ExpectNear(tracked.pose.camera_from_world, truth_, 0.01);
}

TEST_F(FrameTrackerTest, AJerkTellsThatTheGroundIsHiddenOnlyWhereItMayHaveBeenHiddenJustNow) {
  const StereoImages images = wall_.Render(1, truth_);
  const StereoFrame frame = frontend_.Process(images);
  PredictedPose smooth(truth_), jerk(Rigid3(truth_.rotation, Eigen::Vector3d(0, 0, 0.5)));
  for (PredictedPose* one : {&smooth, &jerk}) one->sigma_shift_m = one->sigma_turn_rad = 0.05;
  const auto log_odds = [&](const PredictedPose& predicted, double just_hidden) {
    const GroundPrior prior{0.5, 0.5 * just_hidden};
    const Expectation expected{predicted, prior, prior};
    return FrameTracker(camera_, {}).Track(frame, images, map_, expected).log_odds;
  };
  EXPECT_LT(log_odds(jerk, 1), log_odds(smooth, 1) - 3);
  EXPECT_NEAR(log_odds(jerk, 0), log_odds(smooth, 0), 0.1);
  EXPECT_NEAR(log_odds(jerk, 0.01), log_odds(smooth, 0.01), 0.8);
}

/// On the left of the picture points have agreed with poses before; the rest is new and moves.
TEST_F(FrameTrackerTest, KnownPointsTellThePoseAndFewThatContradictItAreTold) {
  for (const int known_px : {70, 250}) {
    LandmarkObservations seen;
    std::vector<LandmarkId> expected;
    for (const auto& [id, landmark] : map_.landmarks()) {
      if (landmark.keypoint.x >= known_px) continue;
      LandmarkObservation observation{};
      observation.landmark = id;
      observation.pixels.setZero();
      seen.push_back(observation);
      expected.push_back(id);
    }
    LocalMap map = map_;
    map.CountSightings(expected, seen);
    const Rigid3 by_known = truth_.Inverse();
    const StereoImages moved = wall_.Render(1, truth_);
    StereoImages images = wall_.Render(1, by_known);
    const cv::Rect rest(known_px, 0, camera_.width - known_px, camera_.height);
    moved.left(rest).copyTo(images.left(rest));
    moved.right(rest).copyTo(images.right(rest));
    const auto track = [&](const StereoImages& images) {
      return FrameTracker(camera_, {})
          .Track(frontend_.Process(images), images, map, {PredictedPose(truth_)});
    };
    const double undisturbed = track(moved).log_odds;
    const TrackedFrame tracked = track(images);
    ASSERT_TRUE(tracked.pose.HasPose());
    const bool is_few = known_px == 70;
    ExpectNear(tracked.pose.camera_from_world, is_few ? truth_ : by_known, 0.01);
    EXPECT_LT(tracked.log_odds, undisturbed - 1);
  }
}

/// New points among what moved on its own are taken to, as well: here those in the left half.
TEST_F(FrameTrackerTest, NewPointsAmongWhatMovedTellLessOfTheGround) {
  LandmarkObservations moved;
  for (int y = 0; y < camera_.height; y += 10) {
    for (int x = 0; x < camera_.width / 2; x += 10) {
      LandmarkObservation observation{};
      observation.pixels << x, y, x, y;
      moved.push_back(observation);
    }
  }
  const double undisturbed = Track(Rigid3(), Rigid3()).log_odds;
  const StereoImages images = wall_.Render(0, Rigid3());
  map_.Clear();
  map_.AddKeyframe(frontend_.Process(images), images.left, Rigid3(), {}, moved);
  const TrackedFrame tracked = Track(Rigid3(), Rigid3());
  EXPECT_LT(tracked.log_odds, undisturbed - 2);
}

TEST_F(FrameTrackerTest, KeypointsAloneDoToo) {
  FrameTrackerOptions options;
  options.align_patches = false;
  const TrackedFrame tracked = Track(truth_, truth_, options);
  ASSERT_TRUE(tracked.pose.IsTracked());
  ExpectNear(tracked.pose.camera_from_world, truth_, 0.05);
}

TEST_F(FrameTrackerTest, AFewPatchesAreNoBetterThanTheKeypointsThatAgreed) {
  const StereoImages images = wall_.Render(1, truth_);
  const StereoFrame frame = frontend_.Process(images);
  const cv::Rect corner(200, 200, 60, 40);
  StereoImages mostly_dark = wall_.RenderDark(1);
  images.left(corner).copyTo(mostly_dark.left(corner));
  images.right(corner).copyTo(mostly_dark.right(corner));
  const TrackedFrame tracked =
      FrameTracker(camera_, {}).Track(frame, mostly_dark, map_, {PredictedPose(truth_)});
  ASSERT_TRUE(tracked.pose.IsTracked());
  ExpectNear(tracked.pose.camera_from_world, truth_, 0.05);
  EXPECT_GT(tracked.pose.num_inliers, 50) << "those of the keypoints";
}

TEST_F(FrameTrackerTest, SaysThatItIsLostInTheDarkAndElsewhere) {
  const StereoImages dark = wall_.RenderDark(1);
  const FrameTracker tracker(camera_, {});
  EXPECT_FALSE(tracker.Track(frontend_.Process(dark), dark, map_, {PredictedPose(Rigid3())})
                   .pose.IsTracked());
  const StereoImages elsewhere = TexturedWall(2).Render(1, truth_.Inverse());
  EXPECT_FALSE(
      tracker.Track(frontend_.Process(elsewhere), elsewhere, map_, {PredictedPose(Rigid3())})
          .pose.IsTracked());
}

TEST_F(FrameTrackerTest, ObservationsAreSortedAndOfKnownLandmarks) {
  const TrackedFrame tracked = Track(truth_, truth_);
  LandmarkId last = -1;
  for (const LandmarkObservation& observation : tracked.observations) {
    EXPECT_GT(observation.landmark, last);
    EXPECT_EQ(map_.landmarks().count(observation.landmark), 1u);
    last = observation.landmark;
  }
}

}  // namespace
}  // namespace arfm_vo
