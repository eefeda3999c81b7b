#include "arfm_vo/ros/odometry/camera_mount.h"

#include <gmock/gmock.h>

#include "arfm_vo/odometry/base_motion.h"
#include "arfm_vo/ros/messages/transforms.h"
#include "base/refusal.h"

namespace arfm_vo {
namespace {

/// Optical axes (x right, y down, z forward) seen from the base's (x forward, y left, z up).
const Eigen::Quaterniond kForwardFromOptical(0.5, -0.5, 0.5, -0.5);
constexpr double kDegree = M_PI / 180;

/// A camera 1.2 m up on a mast, 0.1 m in front of the pan axis, turned by pan and tilt.
Rigid3 BaseFromCamera(double pan_rad, double tilt_rad) {
  const Rigid3 base_from_pan(ExpSO3({0, 0, pan_rad}), Eigen::Vector3d(0.3, 0, 1.2));
  const Rigid3 pan_from_tilt(ExpSO3({0, tilt_rad, 0}), Eigen::Vector3d(0, 0, 0.1));
  const Rigid3 tilt_from_camera(kForwardFromOptical, Eigen::Vector3d(0.1, 0.12, 0));
  return base_from_pan * pan_from_tilt * tilt_from_camera;
}

geometry_msgs::TransformStamped Transform(const std::string& parent, const std::string& child,
                                          double stamp_s, const Rigid3& parent_from_child) {
  return MakeTransform(ros::Time(stamp_s), parent, child, parent_from_child);
}

void SetCamera(tf2::BufferCore& buffer, double stamp_s, const Rigid3& base_from_camera) {
  buffer.setTransform(Transform("base_link", "camera", stamp_s, base_from_camera), "test");
}

CameraMountOptions WithoutWaiting() {
  CameraMountOptions options;
  options.tf_timeout_s = 0;
  return options;
}

TEST(CameraMount, TakesTheTransformAtTheStampNotTheNewest) {
  tf2::BufferCore buffer;
  SetCamera(buffer, 1, BaseFromCamera(0, 0));
  SetCamera(buffer, 2, BaseFromCamera(40 * kDegree, 0));
  const CameraMount mount(buffer, WithoutWaiting());
  const Rigid3 half_way = mount.BaseFromCamera("camera", ros::Time(1.5));
  EXPECT_LT((half_way.Inverse() * BaseFromCamera(20 * kDegree, 0)).Angle(), 1e-9);
}

TEST(CameraMount, GivesNothingWhereTfDoesNotReach) {
  tf2::BufferCore buffer;
  const CameraMount mount(buffer, WithoutWaiting());
  EXPECT_INVALID(mount.BaseFromCamera("camera", ros::Time(1)), "tf base_link <- camera: ");
  SetCamera(buffer, 1, BaseFromCamera(0, 0));
  SetCamera(buffer, 2, BaseFromCamera(0, 0));
  EXPECT_INVALID(mount.BaseFromCamera("camera", ros::Time(2.5)), "tf base_link <- camera: ");
  EXPECT_INVALID(mount.BaseFromCamera("other", ros::Time(1.5)), "tf base_link <- other: ");
  EXPECT_NO_THROW(mount.BaseFromCamera("camera", ros::Time(1.5)));
}

TEST(CameraMount, TheOptionNamesTheCameraFrame) {
  tf2::BufferCore buffer;
  SetCamera(buffer, 1, BaseFromCamera(0, 0));
  CameraMountOptions options = WithoutWaiting();
  options.camera_frame = "camera";
  EXPECT_NO_THROW(CameraMount(buffer, options).BaseFromCamera("wrong_in_the_bag", ros::Time(1)));
}

TEST(CameraMount, SaysThatTheHeadSlews) {
  tf2::BufferCore buffer;
  for (int i = 0; i <= 10; ++i)  // 10 deg/s
    SetCamera(buffer, 1 + 0.1 * i, BaseFromCamera(i * kDegree, 0));
  CameraMountOptions options = WithoutWaiting();
  const auto is_slewing = [&](double limit_dps, double stamp_s) {
    options.max_slew_dps = limit_dps;
    const CameraMount mount(buffer, options);
    const ros::Time stamp(stamp_s);
    return mount.IsSlewing("camera", stamp, mount.BaseFromCamera("camera", stamp));
  };
  EXPECT_TRUE(is_slewing(9, 1.5));
  EXPECT_FALSE(is_slewing(11, 1.5));
  EXPECT_FALSE(is_slewing(0, 1.5));   // no gate
  EXPECT_FALSE(is_slewing(9, 1.02));  // tf does not reach back
}

TEST(CameraMount, OptionsAreChecked) {
  tf2::BufferCore buffer;
  CameraMountOptions options;
  options.max_slew_dps = -1;
  EXPECT_INVALID(CameraMount(buffer, options), "max_slew_dps");
}

TEST(BaseMotion, StartsAtTheOriginAndDrivesForwardAlongX) {
  BaseMotion motion;
  const Rigid3 mount = BaseFromCamera(0, 0);
  EXPECT_LT(motion.Move(Rigid3(), mount).translation.norm(), 1e-12);
  // The camera goes 2 m along its z: what it saw comes 2 m nearer.
  const Rigid3 camera_from_world(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, -2));
  const Rigid3& odom_from_base = motion.Move(camera_from_world, mount);
  EXPECT_LT((odom_from_base.translation - Eigen::Vector3d(2, 0, 0)).norm(), 1e-12);
  EXPECT_LT(odom_from_base.Angle(), 1e-12);
}

TEST(BaseMotion, LevelTurnsOdomAboutTheBaseByABoundedAngle) {
  BaseMotion motion;
  motion.StandBy(Eigen::Vector3d(0.6, 0, 0.8));
  const Rigid3 start = motion.Move({}, {});
  EXPECT_TRUE(start.translation.isZero(1e-12));
  EXPECT_TRUE((start.rotation * Eigen::Vector3d(0.6, 0, 0.8)).isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE((start.rotation * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(0.8, 0, 0.6)));
  const Rigid3 camera_from_world(Eigen::Quaterniond::Identity(), Eigen::Vector3d(-5, 0, 0));
  const Rigid3 before = motion.Move(camera_from_world, {});
  motion.Level(Eigen::Vector3d(Eigen::Vector3d::UnitZ()), 0.1);
  const Rigid3 turned = motion.Move(camera_from_world, {});
  EXPECT_TRUE(turned.translation.isApprox(before.translation));
  EXPECT_NEAR((before.Inverse() * turned).Angle(), 0.1, 1e-9);
  motion.Level(Eigen::Vector3d(Eigen::Vector3d::UnitZ()), 10);
  EXPECT_TRUE((motion.Move(camera_from_world, {}).rotation * Eigen::Vector3d::UnitZ())
                  .isApprox(Eigen::Vector3d::UnitZ()));
}

TEST(BaseMotion, AParkedRoverThatPansItsHeadDoesNotMove) {
  BaseMotion motion;
  const Rigid3 camera_from_base0 = BaseFromCamera(5 * kDegree, 10 * kDegree).Inverse();
  const Rigid3 world_from_base = camera_from_base0;  // the world is the first camera
  for (int i = 0; i <= 60; ++i) {
    const Rigid3 mount = BaseFromCamera((5 + i) * kDegree, (10 - 0.5 * i) * kDegree);
    const Rigid3 camera_from_world = (world_from_base * mount).Inverse();
    const Rigid3& odom_from_base = motion.Move(camera_from_world, mount);
    EXPECT_LT(odom_from_base.translation.norm(), 1e-12) << i;
    EXPECT_LT(odom_from_base.Angle(), 1e-12) << i;
  }
}

TEST(BaseMotion, ANewWorldContinuesWhereTheBaseStands) {
  BaseMotion motion;
  const Rigid3 mount = BaseFromCamera(0, 0);
  motion.Move(Rigid3(), mount);
  motion.Move(Rigid3(ExpSO3({0, 0.3, 0}), Eigen::Vector3d(0.5, 0, -2)), mount);
  const Rigid3 before = motion.odom_from_base();
  motion.StartEpoch();
  const Rigid3 turned = BaseFromCamera(30 * kDegree, 0);
  const Rigid3 after = motion.Move(Rigid3(), turned);
  EXPECT_LT((before.Inverse() * after).translation.norm(), 1e-12);
  EXPECT_LT((before.Inverse() * after).Angle(), 1e-12);
  EXPECT_LT((motion.odom_from_world().translation - (before * turned).translation).norm(), 1e-12);
}

TEST(AddTransform, TakesWhatIsNotFromTheFutureAndSaysSo) {
  tf2::BufferCore buffer;
  geometry_msgs::TransformStamped transform = Transform("base_link", "camera", 101.5, Rigid3());
  const ros::Time now(100);
  EXPECT_FALSE(AddTransform(transform, false, now, "test", buffer));
  EXPECT_FALSE(buffer.canTransform("base_link", "camera", ros::Time(0)));
  EXPECT_TRUE(AddTransform(transform, true, now, "test", buffer)) << "a fixed one has no time";
  transform.child_frame_id = "wheel";
  transform.header.stamp = ros::Time(100.9);
  EXPECT_TRUE(AddTransform(transform, false, now, "test", buffer));
  EXPECT_TRUE(buffer.canTransform("base_link", "wheel", transform.header.stamp));
}

TEST(TruthAlignment, IsThatOfTheFirstPoseWhateverTheOdometryDoesThen) {
  tf2::BufferCore buffer;
  SetCamera(buffer, 1, BaseFromCamera(0, 0));
  SetCamera(buffer, 2, BaseFromCamera(0, 0));
  const auto set_odom = [&](double stamp_s, double x_m) {
    const Rigid3 odom_from_base(Eigen::Quaterniond::Identity(), Eigen::Vector3d(x_m, 0, 0));
    buffer.setTransform(Transform("odom", "base_link", stamp_s, odom_from_base), "test");
  };
  set_odom(1, 5);
  set_odom(2, 99);  // wrong
  TruthAlignment alignment{buffer, "odom", "base_link", "camera"};
  const auto first = alignment.Align(ros::Time(1), Rigid3());
  ASSERT_TRUE(first);
  EXPECT_NEAR((first->translation - Eigen::Vector3d(5, 0, 0)).norm(), 0, 1e-9);
  const Rigid3 two_ahead(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, 2));
  const auto second = alignment.Align(ros::Time(2), two_ahead);
  ASSERT_TRUE(second);
  EXPECT_NEAR((second->translation - Eigen::Vector3d(7, 0, 0)).norm(), 0, 1e-9);
}

// tf2 takes each of the two; their product is not finite.
TEST(TruthAlignment, ATransformThatIsNotOneGivesNoPlace) {
  tf2::BufferCore buffer;
  const Rigid3 far(Eigen::Quaterniond::Identity(), Eigen::Vector3d(1e308, 0, 0));
  buffer.setTransform(Transform("base_link", "mast", 0, far), "test", true);
  buffer.setTransform(Transform("mast", "camera", 0, far), "test", true);
  TruthAlignment alignment{buffer, "base_link", "base_link", "camera"};
  EXPECT_FALSE(alignment.Align(ros::Time(1), Rigid3()));
}

}  // namespace
}  // namespace arfm_vo
