#include <gtest/gtest.h>

#include "arfm_vo/evaluation/trajectory_output.h"

namespace arfm_vo {
namespace {

/// From optical axes (z ahead) to those of the base (x ahead), 1 m above it and 0.5 m before it.
Rigid3 LoggedMount(double pan_rad = 0) {
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return Rigid3(Eigen::Quaterniond(ExpSO3({0, 0, pan_rad})), Eigen::Vector3d(0.5, 0, 1)) *
         Rigid3(Eigen::Quaterniond(axes), Eigen::Vector3d::Zero());
}

/// The camera's trajectory where the base takes these poses.
Trajectory CameraOf(const std::vector<Rigid3>& bases, const std::vector<Rigid3>& mounts) {
  Trajectory trajectory;
  const Rigid3 first = bases[0] * mounts[0];
  for (size_t i = 0; i < bases.size(); ++i)
    trajectory.push_back({static_cast<double>(i), first.Inverse() * bases[i] * mounts[i], true});
  return trajectory;
}

void ExpectNear(const Rigid3& a, const Rigid3& b) {
  EXPECT_LT((a.translation - b.translation).norm(), 1e-12);
  EXPECT_LT((a.Inverse() * b).Angle(), 1e-7);
}

TEST(MountLog, ARoverThatDrivesAheadMovesAlongX) {
  MountLog log;
  Trajectory camera;
  for (int i = 0; i < 3; ++i) {
    log.Add(i, LoggedMount());
    camera.push_back({static_cast<double>(i),
                      Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, 0.1 * i))});
  }
  const Trajectory base = log.OfBase(camera);
  ASSERT_EQ(base.size(), 3u);
  ExpectNear(base[0].world_from_camera, Rigid3());
  ExpectNear(base[2].world_from_camera,
             Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.2, 0, 0)));
}

TEST(MountLog, ATurnInPlaceLeavesTheBaseWhereItIs) {
  const std::vector<Rigid3> bases = {Rigid3(), Rigid3(ExpSO3({0, 0, 0.7}), {0, 0, 0})};
  MountLog log;
  log.Add(0, LoggedMount());
  const Trajectory base = log.OfBase(CameraOf(bases, {LoggedMount(), LoggedMount()}));
  ExpectNear(base[1].world_from_camera, bases[1]);
}

TEST(MountLog, AHeadThatPansDoesNotMoveTheBase) {
  const std::vector<Rigid3> mounts = {LoggedMount(), LoggedMount(0.3), LoggedMount(0.6)};
  MountLog log;
  for (int i = 0; i < 3; ++i) log.Add(i, mounts[i]);
  for (const TrajectoryPose& pose : log.OfBase(CameraOf(std::vector<Rigid3>(3), mounts)))
    ExpectNear(pose.world_from_camera, Rigid3());
}

TEST(MountLog, LostPairsAreInterpolatedAsPosesOfTheBase) {
  const std::vector<Rigid3> bases = {Rigid3(), Rigid3(),
                                     Rigid3(ExpSO3({0, 0, 0.4}), Eigen::Vector3d(0.2, 0, 0))};
  Trajectory camera = CameraOf(bases, std::vector<Rigid3>(3, LoggedMount()));
  camera[1].is_tracked = false;
  MountLog log;
  log.Add(0, LoggedMount());
  const Trajectory base = log.OfBase(camera);
  EXPECT_FALSE(base[1].is_tracked);
  ExpectNear(base[1].world_from_camera, Rigid3(ExpSO3({0, 0, 0.2}), Eigen::Vector3d(0.1, 0, 0)));
}

TEST(MountLog, AHeadThatNeverRestsIsKeptAtFewerTimesInTheEnd) {
  MountLog log;
  const int num_pairs = static_cast<int>(kMaxFramesKept) + 10;
  const auto mount = [](int pair) { return LoggedMount(1e-5 * pair); };
  for (int i = 0; i < num_pairs; ++i) log.Add(i, mount(i));
  const Rigid3 first = mount(0), last = mount(num_pairs - 1);
  const Trajectory camera = {{0, Rigid3(), true},
                             {1001, first.Inverse() * mount(1001), true},
                             {num_pairs - 1., first.Inverse() * last, true}};
  const Trajectory base = log.OfBase(camera);
  ExpectNear(base[0].world_from_camera, Rigid3());
  EXPECT_LT(base[1].world_from_camera.Angle(), 1.5e-5) << "by the pair before it";
  ExpectNear(base[2].world_from_camera, Rigid3());
}

TEST(MountLog, WithoutATrackedPairNothingIsTold) {
  const Trajectory lost = {{1, Rigid3(), false}};
  EXPECT_EQ(MountLog().OfBase(lost).size(), 1u);
  EXPECT_TRUE(MountLog().OfBase({}).empty());
}

}  // namespace
}  // namespace arfm_vo
