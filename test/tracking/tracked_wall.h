#pragma once

#include <gtest/gtest.h>

#include <optional>

#include "arfm_vo/odometry/stereo_frontend.h"
#include "arfm_vo/tracking/frame_tracker.h"
#include "ros/textured_wall.h"

namespace arfm_vo {

/// A wall in the map, and a camera that has moved.
class FrameTrackerTest : public ::testing::Test {
 protected:
  FrameTrackerTest()
      : camera_(wall_.camera()), frontend_(camera_, {}), map_(camera_, LocalMapOptions()) {
    const StereoImages images = wall_.Render(0, Rigid3());
    map_.AddKeyframe(frontend_.Process(images), images.left, Rigid3(), {});
  }

  TrackedFrame Track(const Rigid3& truth, const std::optional<Rigid3>& predicted,
                     const FrameTrackerOptions& options = {}) {
    const StereoImages images = wall_.Render(1, truth);
    return FrameTracker(camera_, options)
        .Track(frontend_.Process(images), images, map_,
               {predicted ? std::optional<PredictedPose>(*predicted) : std::nullopt});
  }

  static void ExpectNear(const Rigid3& pose, const Rigid3& truth, double metres) {
    const Rigid3 error = pose * truth.Inverse();
    EXPECT_LT(error.translation.norm(), metres);
    EXPECT_LT(error.Angle(), 0.2 * metres);
  }

  TexturedWall wall_;
  StereoCamera camera_;
  StereoFrontend frontend_;
  LocalMap map_;
  const Rigid3 truth_{ExpSO3({0.01, 0.04, -0.02}), Eigen::Vector3d(-0.2, 0.05, -0.3)};
};

}  // namespace arfm_vo
