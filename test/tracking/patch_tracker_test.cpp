#include "arfm_vo/tracking/patch_tracker.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tracking/tracked_wall.h"

namespace arfm_vo {
namespace {

Expectation ExpectedWithin(const Rigid3& predicted, double sigma_turn_rad) {
  PredictedPose pose(predicted);
  pose.sigma_turn_rad = sigma_turn_rad;
  pose.sigma_shift_m = 0.001;
  const GroundPrior prior{0.98, 0.01};
  return {pose, prior, prior};
}

class PatchTrackerTest : public FrameTrackerTest {
 protected:
  std::optional<int> LevelWithin(double sigma_px, const FrameTracker& tracker) const {
    return tracker.LevelOfPatches(map_, ExpectedWithin(truth_, sigma_px / camera_.fx));
  }
  /// Lays the left 6/10 of `cover` over both images.
  static void CoverMost(const StereoImages& cover, StereoImages& images) {
    const cv::Rect most(0, 0, images.left.cols * 6 / 10, images.left.rows);
    cover.left(most).copyTo(images.left(most));
    cover.right(most).copyTo(images.right(most));
  }
};

/// As if poses before had agreed with all landmarks.
void CountAllSeen(LocalMap& map) {
  LandmarkObservations seen;
  std::vector<LandmarkId> expected;
  for (const auto& [id, landmark] : map.landmarks()) {
    LandmarkObservation observation{};
    observation.landmark = id;
    observation.pixels.setZero();
    seen.push_back(observation);
    expected.push_back(id);
  }
  for (int i = 0; i < 3; ++i) map.CountSightings(expected, seen);
}

TEST_F(PatchTrackerTest, PatchesReachAsFarAsThePredictionMayErr) {
  const FrameTracker tracker(camera_, {});
  int before = -1;
  for (const double sigma_px : {1., 2., 5., 10.}) {
    const auto level = LevelWithin(sigma_px, tracker);
    ASSERT_TRUE(level) << sigma_px;
    EXPECT_EQ(*level, ++before) << sigma_px;
  }
  EXPECT_FALSE(LevelWithin(20, tracker));
  EXPECT_FALSE(tracker.LevelOfPatches(map_, {PredictedPose(truth_)})) << "as if sigma were known";
  EXPECT_FALSE(tracker.LevelOfPatches(map_, {std::nullopt}));
  Expectation wary = ExpectedWithin(truth_, 1 / camera_.fx);
  wary.is_wary = true;
  EXPECT_FALSE(tracker.LevelOfPatches(map_, wary));
  FrameTrackerOptions keypoints_alone;
  keypoints_alone.align_patches = false;
  EXPECT_FALSE(LevelWithin(1, FrameTracker(camera_, keypoints_alone)));
}

TEST_F(PatchTrackerTest, PatchesTellThePoseAsKeypointsAndPatchesDo) {
  CountAllSeen(map_);
  const FrameTracker tracker(camera_, {});
  const StereoImages images = wall_.Render(1, truth_);
  const TrackedFrame whole = Track(truth_, truth_);
  for (const auto& [off_px, level] : {std::pair(0.5, 0), {2., 0}, {5., 1}, {7., 2}}) {
    const Rigid3 predicted = Rigid3(ExpSO3({0, off_px / camera_.fx, 0}), {0, 0, 0}) * truth_;
    const auto tracked =
        tracker.TrackByPatches(images, map_, ExpectedWithin(predicted, off_px / camera_.fx), level);
    ASSERT_TRUE(tracked) << off_px;
    EXPECT_TRUE(tracked->pose.IsTracked());
    ExpectNear(tracked->pose.camera_from_world, whole.pose.camera_from_world, 0.001);
    EXPECT_GT(tracked->pose.num_inliers, 0.9 * whole.pose.num_inliers) << off_px;
    EXPECT_EQ(tracked->observations.size(), static_cast<size_t>(tracked->pose.num_inliers));
    EXPECT_NEAR(tracked->expected.size(), whole.expected.size(), 10);
  }
}

TEST_F(PatchTrackerTest, PatchesDoNotDecideOutOfReachNorWhereMostIsHidden) {
  CountAllSeen(map_);
  const FrameTracker tracker(camera_, {});
  StereoImages images = wall_.Render(1, truth_);
  const Rigid3 off(ExpSO3({0, 18 / camera_.fx, 0}), {0, 0, 0});
  EXPECT_FALSE(tracker.TrackByPatches(images, map_, ExpectedWithin(off * truth_, 0.01), 0));
  const Expectation expected = ExpectedWithin(truth_, 0.001);
  EXPECT_TRUE(tracker.TrackByPatches(images, map_, expected, 0));
  CoverMost(wall_.RenderDark(1), images);
  EXPECT_FALSE(tracker.TrackByPatches(images, map_, expected, 0));
}

/// Swapped images: the left one alone agrees with a pose at the right camera.
TEST_F(PatchTrackerTest, PatchesDoNotDecideWhereTheRightImageShowsElse) {
  CountAllSeen(map_);
  const FrameTracker tracker(camera_, {});
  StereoImages images = wall_.Render(1, truth_);
  images.right = images.left;
  Expectation expected = ExpectedWithin(truth_, 0.001);
  EXPECT_FALSE(tracker.TrackByPatches(images, map_, expected, 0));
  expected.use_right = false;
  EXPECT_TRUE(tracker.TrackByPatches(images, map_, expected, 0)) << "known, and taken into account";
}

/// The camera seems to rest by what covers most of the picture, the rest has moved out of reach.
TEST_F(PatchTrackerTest, PatchesDoNotTakeWhatIsFixedBeforeTheCameraForRest) {
  CountAllSeen(map_);
  const FrameTracker tracker(camera_, {});
  const StereoImages rest = wall_.Render(1, Rigid3());
  const Expectation expected = ExpectedWithin(Rigid3(), 0.001);
  EXPECT_TRUE(tracker.TrackByPatches(rest, map_, expected, 0));
  StereoImages images = wall_.Render(1, Rigid3(ExpSO3({0, 0.03, 0}), {0, 0, 0}));
  CoverMost(rest, images);
  EXPECT_FALSE(tracker.TrackByPatches(images, map_, expected, 0));
}

/// A keyframe's features are matched too; what patches have measured is not measured again.
TEST_F(PatchTrackerTest, KeypointsTakeOverWhatPatchesHaveMeasured) {
  CountAllSeen(map_);
  const FrameTracker tracker(camera_, {});
  const StereoImages images = wall_.Render(1, truth_);
  const Expectation expected = ExpectedWithin(truth_, 0.001);
  const auto by_patches = tracker.TrackByPatches(images, map_, expected, 0);
  ASSERT_TRUE(by_patches);
  const StereoFrame frame = frontend_.Process(images);
  // (Patches that were measured in the dark would not be there.)
  const TrackedFrame tracked =
      tracker.Track(frame, wall_.RenderDark(1), map_, expected, by_patches);
  ExpectNear(tracked.pose.camera_from_world, by_patches->pose.camera_from_world, 1e-6);
  EXPECT_EQ(tracked.observations.size(), by_patches->observations.size());
  EXPECT_GT(tracked.matches.landmarks.size(), 50u) << "of keypoints";
  // Where keypoints tell of another pose, that is measured anew.
  const StereoImages elsewhere = wall_.Render(2, truth_.Inverse());
  const TrackedFrame corrected = tracker.Track(frontend_.Process(elsewhere), elsewhere, map_,
                                               {PredictedPose(truth_)}, by_patches);
  ExpectNear(corrected.pose.camera_from_world, truth_.Inverse(), 0.01);
}

/// The ground repeats itself, and the search in small images has slipped by a period.
TEST_F(PatchTrackerTest, OfPosesThatThePatchesFitTheOneAsPredictedIsLikelierAndTheOtherItsRival) {
  constexpr double kPeriod_m = 0.8;
  const TexturedWall wall(1, kPeriod_m);
  LocalMap map(camera_, LocalMapOptions());
  const StereoImages first = wall.Render(0, Rigid3());
  map.AddKeyframe(frontend_.Process(first), first.left, Rigid3(), {});
  CountAllSeen(map);
  const FrameTracker tracker(camera_, {});
  const Rigid3 slipped =
      truth_ * Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, kPeriod_m, 0));
  const StereoImages images = wall.Render(1, truth_);
  const StereoFrame frame = frontend_.Process(images);
  const auto by_patches = tracker.TrackByPatches(images, map, ExpectedWithin(slipped, 0.001), 0);
  ASSERT_TRUE(by_patches);
  ExpectNear(by_patches->pose.camera_from_world, slipped, 0.01);
  const TrackedFrame tracked =
      tracker.Track(frame, images, map, ExpectedWithin(truth_, 0.001), by_patches);
  ExpectNear(tracked.pose.camera_from_world, truth_, 0.01);
  ASSERT_TRUE(tracked.pose.rival);
  ExpectNear(*tracked.pose.rival, slipped, 0.01);
  EXPECT_GT(tracked.log_odds, tracked.log_odds_of_rival + 2);
}

/// What patches do not find where it is predicted is no rival.
TEST_F(PatchTrackerTest, AJumpHasNoRivalWherePatchesDoNotFitThePrediction) {
  CountAllSeen(map_);
  const FrameTracker tracker(camera_, {});
  const StereoImages elsewhere = wall_.Render(2, truth_.Inverse());
  const TrackedFrame jumped =
      tracker.Track(frontend_.Process(elsewhere), elsewhere, map_, ExpectedWithin(truth_, 0.001));
  ExpectNear(jumped.pose.camera_from_world, truth_.Inverse(), 0.01);
  EXPECT_FALSE(jumped.pose.rival);
}

}  // namespace
}  // namespace arfm_vo
