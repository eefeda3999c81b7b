#include "arfm_vo/odometry/placed_map.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace arfm_vo {
namespace {

const StereoCamera kCamera{400, 400, 320, 240, 0.3, 640, 480};
/// Optical axes seen from the base's, 1 m up.
const Rigid3 kBaseFromCamera(Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), Eigen::Vector3d(0, 0, 1));

Landmark LandmarkAt(int id, const Eigen::Vector3d& x_in_world) {
  Landmark landmark;
  landmark.id = id;
  landmark.x_in_world = x_in_world;
  return landmark;
}

/// Keyframes of a camera that goes forward `step_m` a keyframe, and says that it went `scale` times
/// as far; all see the same exact points.
PlacedKeyframe MakeKeyframe(int id, double stamp_s, uint32_t epoch, double z, double said_z) {
  PlacedKeyframe keyframe;
  keyframe.epoch = epoch;
  keyframe.camera = kCamera;
  keyframe.odom_from_world = kBaseFromCamera;
  keyframe.base_from_camera = kBaseFromCamera;
  keyframe.keyframe.id = id;
  keyframe.keyframe.stamp_s = stamp_s;
  keyframe.keyframe.camera_from_world.translation = Eigen::Vector3d(0, 0, -said_z);
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector3d x((i % 10) - 4.5, (i / 10) - 2.5, 10 + (i % 7));
    const Eigen::Vector3f seen = kCamera.ProjectStereo(x - Eigen::Vector3d(0, 0, z)).cast<float>();
    keyframe.keyframe.observations.push_back(
        {{{seen.x(), seen.y(), seen.z(), seen.y()}, true, 1}, i});
    if (id == 0) keyframe.landmarks.push_back(LandmarkAt(i, x));
  }
  return keyframe;
}

void AddEpoch(PlacedMap& map, uint32_t epoch, double start_s, double step_m, double said_step_m) {
  for (int i = 0; i < 4; ++i)
    EXPECT_TRUE(map.Add(MakeKeyframe(i, start_s + i, epoch, step_m * i, said_step_m * i)));
}

TEST(PlacedMap, AdjustsThePathAndMovesOdomInTheMap) {
  PlacedMap map{GlobalMapOptions()};
  AddEpoch(map, 1, 0, 0.5, 0.55);
  EXPECT_NEAR(map.BasePoses().back().map_from_base.translation.x(), 1.65, 1e-9);
  EXPECT_TRUE(map.Landmarks().empty());
  const auto update = map.Adjust({});
  ASSERT_TRUE(update);
  EXPECT_EQ(update->keyframes.size(), 4u);
  const std::vector<MapPose> poses = map.BasePoses();
  ASSERT_EQ(poses.size(), 4u);
  EXPECT_NEAR(poses.back().map_from_base.translation.x(), 1.5, 1e-3);
  EXPECT_NEAR(poses.back().map_from_base.translation.z(), 0, 1e-3);
  // odom said 1.65, the map says 1.5: odom's origin lies 0.15 behind the map's.
  EXPECT_NEAR(map.map_from_odom().translation.x(), -0.15, 1e-3);
  EXPECT_NEAR(map.MakeTrajectory().back().world_from_camera.translation.z(), 1.5, 1e-3);
}

TEST(PlacedMap, ShowsLandmarksInTheMapWithTheDepthOfTheFirstSight) {
  PlacedMap map{GlobalMapOptions()};
  AddEpoch(map, 1, 0, 0.5, 0.5);
  map.Adjust({});
  const std::vector<LandmarkPoint> points = map.Landmarks();
  ASSERT_EQ(points.size(), 60u);
  EXPECT_NEAR(points[0].x_in_map.x(), 10, 1e-2);       // ahead
  EXPECT_NEAR(points[0].x_in_map.y(), 4.5, 1e-2);      // to the left
  EXPECT_NEAR(points[0].x_in_map.z(), 1 + 2.5, 1e-2);  // up
  EXPECT_NEAR(points[0].depth_m, 10, 1e-3);
}

/// As MakeKeyframe, but each keyframe sees points of its own and those of the one before.
PlacedKeyframe MakeStep(int id) {
  PlacedKeyframe keyframe = MakeKeyframe(id, id, 1, 0.5 * id, 0.5 * id);
  keyframe.keyframe.observations.clear();
  keyframe.landmarks.clear();
  for (int i = 60 * std::max(0, id - 1); i < 60 * (id + 1); ++i) {
    const Eigen::Vector3d x((i % 10) - 4.5, (i % 60 / 10) - 2.5, 10 + (i % 7) + 0.5 * (i / 60));
    const Eigen::Vector3f seen =
        kCamera.ProjectStereo(x - Eigen::Vector3d(0, 0, 0.5 * id)).cast<float>();
    keyframe.keyframe.observations.push_back(
        {{{seen.x(), seen.y(), seen.z(), seen.y()}, true, 1}, i});
    if (i >= 60 * id) keyframe.landmarks.push_back(LandmarkAt(i, x));
  }
  return keyframe;
}

TEST(PlacedMap, ShowsALongDriveWithABoundedNumberOfLandmarks) {
  GlobalMapOptions options;
  options.max_keyframes = 8;
  options.learn_correction = false;
  PlacedMap map{options};
  constexpr int kLong = 400;  // 24,000 landmarks
  size_t most = 0;
  for (int id = 0; id < kLong; ++id) {
    ASSERT_TRUE(map.Add(MakeStep(id)));
    if (id % 4 != 3) continue;
    ASSERT_TRUE(map.Adjust({}));
    most = std::max(most, map.Landmarks().size());
    EXPECT_LE(map.num_landmarks(), 600);
  }
  EXPECT_GT(most, 19000u);
  EXPECT_LT(most, 21500u);
  const std::vector<MapPose> poses = map.BasePoses();
  ASSERT_EQ(poses.size(), static_cast<size_t>(kLong));
  for (int id = 0; id < kLong; id += 100)
    EXPECT_NEAR(poses[id].map_from_base.translation.x(), 0.5 * id, 1e-3);
  const std::vector<LandmarkPoint> points = map.Landmarks();
  EXPECT_LT(points.front().x_in_map.x(), 30);  // from the start on, thinned
}

TEST(PlacedMap, ANewEpochContinuesFromWhereOdomLiesInTheMap) {
  PlacedMap map{GlobalMapOptions()};
  AddEpoch(map, 1, 0, 0.5, 0.55);
  map.Adjust({});
  PlacedKeyframe next = MakeKeyframe(0, 10, 2, 0, 0);
  next.odom_from_world.translation.x() += 1.65;  // the base stands where it stood
  EXPECT_TRUE(map.Add(next));
  EXPECT_EQ(map.epoch(), 2u);
  EXPECT_EQ(map.num_keyframes(), 1);
  ASSERT_EQ(map.BasePoses().size(), 5u);
  EXPECT_NEAR(map.BasePoses().back().map_from_base.translation.x(), 1.5, 1e-3);
  EXPECT_NEAR(map.map_from_odom().translation.x(), -0.15, 1e-3);
  EXPECT_EQ(map.Landmarks().size(), 60u);  // of the world before
}

TEST(PlacedMap, ARestartedOdometryIsAMapOfItsOwn) {
  for (const auto& [id, stamp_s, world] : {std::tuple(0, 20., 2u), {0, 1., 9u}, {0, 20., 1u}}) {
    PlacedMap map{GlobalMapOptions()};
    AddEpoch(map, 2, 10, 0.5, 0.55);
    map.Adjust({});
    EXPECT_FALSE(map.Add(MakeKeyframe(id, stamp_s, world, 0, 0)));
    EXPECT_EQ(map.BasePoses().size(), 1u);
    EXPECT_TRUE(map.Landmarks().empty());
    EXPECT_LT(map.map_from_odom().translation.norm(), 1e-12);
  }
}

TEST(PlacedMap, ARestartedOdometryKeepsWhatIsKnownOfTheCamera) {
  PlacedMap map{GlobalMapOptions()};
  CorrectionBelief learnt = CorrectionBelief::Isotropic(0.05);
  learnt.mean.coefficients_px[0] = 0.4;
  map.SetCorrection(kCamera, learnt);
  AddEpoch(map, 2, 10, 0.5, 0.5);
  EXPECT_FALSE(map.Add(MakeKeyframe(0, 1, 1, 0, 0)));
  ASSERT_TRUE(map.correction());
  EXPECT_EQ(map.correction()->mean.coefficients_px, learnt.mean.coefficients_px);
  EXPECT_EQ(map.correction()->covariance, learnt.covariance);
}

TEST(PlacedMap, WithoutLearningTheCalibrationIsTakenAsExact) {
  GlobalMapOptions options;
  options.learn_correction = false;
  PlacedMap map(options);
  AddEpoch(map, 1, 0, 0.5, 0.5);
  ASSERT_TRUE(map.correction());
  EXPECT_TRUE(map.correction()->mean.IsZero());
  EXPECT_LT(map.correction()->MaxColumnSigma(kCamera), 0.01);
}

TEST(PlacedMap, CanBeCancelled) {
  PlacedMap map{GlobalMapOptions()};
  EXPECT_FALSE(map.Adjust({}));
  AddEpoch(map, 1, 0, 0.5, 0.55);
  int calls = 0;
  map.Adjust([&](const BundleProgress&) { return ++calls < 1; });
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace arfm_vo
