#include <gtest/gtest.h>
#include <tf2/buffer_core.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "arfm_vo/odometry/stereo_frontend.h"
#include "arfm_vo/ros/messages/transforms.h"
#include "arfm_vo/ros/odometry/camera_mount.h"
#include "arfm_vo/simulation/scene.h"

namespace arfm_vo {
namespace {

constexpr double kSweepDegree = M_PI / 180;

/// The largest faults of the base's pose over a drive.
struct Drift {
  double position_m = 0, turn_deg = 0, way_m = 0;
  int num_tracked = 0, num_slewing = 0;
};

/// Renders a drive and runs the odometry on it with the head's tf as from a unit on a slow line
/// (8 readings a second are assumed), at times of its own, interpolated to the images' stamps.
Drift Drive(const SceneOptions& options, double max_slew_dps = 0) {
  constexpr int kStride = 2;  // 5 pairs a second
  constexpr double kReading_s = 0.125, kStart_s = 100;
  const Scene scene(options);
  tf2::BufferCore buffer{ros::Duration(600)};
  for (double t = -1; t < scene.Stamp(scene.num_pairs()) + 1; t += kReading_s) {
    buffer.setTransform(MakeTransform(ros::Time(kStart_s + t), "base_link", "left_camera_optical",
                                      scene.BaseFromLeft(t)),
                        "test");
  }
  CameraMountOptions mount_options;
  mount_options.max_slew_dps = max_slew_dps;
  const CameraMount mount(buffer, mount_options);
  StereoFrontend frontend(scene.camera(), {});
  Session session({});
  MountLog log;
  Drift drift;
  std::optional<Rigid3> first_from_odom;
  for (int i = 0; i < scene.num_pairs(); i += kStride) {
    StereoImages images = scene.RenderPair(i);
    images.stamp_s += kStart_s;
    std_msgs::Header header;
    header.stamp.fromSec(images.stamp_s);
    header.frame_id = "left_camera_optical";
    const SessionUpdate pose =
        mount.Process(frontend.Process(images), scene.camera(), images, header, session, log);
    drift.num_slewing += !pose.IsTried();
    if (!pose.IsTracked()) continue;
    ++drift.num_tracked;
    const Rigid3 truth = scene.FirstFromBase(i);
    if (!first_from_odom) first_from_odom = truth * pose.odom_from_base.Inverse();
    const Rigid3 fault = truth.Inverse() * *first_from_odom * pose.odom_from_base;
    drift.position_m = std::max(drift.position_m, fault.translation.norm());
    drift.turn_deg = std::max(drift.turn_deg, fault.Angle() / kSweepDegree);
    drift.way_m = truth.translation.norm();
  }
  std::printf(
      "  %d pairs, %d tracked, %d slewing, way %.2f m: base off by at most %.4f m, %.3f deg\n",
      (scene.num_pairs() + 1) / kStride, drift.num_tracked, drift.num_slewing, drift.way_m,
      drift.position_m, drift.turn_deg);
  return drift;
}

/// The head passes its middle at 33 deg/s and turns at 17 deg/s halfway to its ends: a gate of
/// 24 deg/s leaves out some pairs.
TEST(HeadSweep, TheBaseIsWhereItIsHoweverTheHeadTurns) {
  const struct {
    const char* path;
    double step_m, max_slew_dps, way_m;
  } rows[] = {{"rest", 0.1, 0, 0}, {"straight", 0.02, 0, 1.6}, {"rest", 0.1, 24, 0}};
  for (const auto& [path, step_m, max_slew_dps, way_m] : rows) {
    SceneOptions options;
    options.path = path;
    options.step_m = step_m;
    options.num_pairs = 81;
    options.sweep_pan_deg = 60;
    options.sweep_tilt_deg = 30;
    options.width = 320;
    options.height = 240;
    options.margin_m = 10;
    options.num_threads = 2;
    const Drift drift = Drive(options, max_slew_dps);
    EXPECT_EQ(drift.num_tracked + drift.num_slewing, 41);
    EXPECT_GT(drift.num_tracked, max_slew_dps > 0 ? 5 : 40);
    EXPECT_EQ(drift.num_slewing > 10, max_slew_dps > 0);
    EXPECT_NEAR(drift.way_m, way_m, 0.05);
    EXPECT_LT(drift.position_m, 0.01);
    EXPECT_LT(drift.turn_deg, 0.3);
  }
}

}  // namespace
}  // namespace arfm_vo
