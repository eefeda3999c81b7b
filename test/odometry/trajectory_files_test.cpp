#include "arfm_vo/odometry/trajectory_files.h"

#include <gtest/gtest.h>

#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/geometry/kitti_poses.h"
#include "base/folder_test.h"
#include "base/refusal.h"

namespace arfm_vo {
namespace {

class TrajectoryFilesTest : public FolderTest {
 protected:
  std::string TumErrorOf(const std::string& text) {
    WriteWholeFile(path_, text);
    return RefusalBehind(path_, [&] { ReadTumTrajectory(path_); });
  }
  const std::string path_ = folder_ / "test.txt";
  const Trajectory trajectory_ = {
      {1317384506.4, Rigid3()},
      {1317384506.5, Rigid3(), false},
      {1317384507.25, Rigid3(ExpSO3({0.1, -2.5, 1. / 3}), Eigen::Vector3d(1. / 3, -1e-9, 5e3))}};
};

TEST_F(TrajectoryFilesTest, KittiHoldsEveryFrameWithAllDigits) {
  const std::string text = FormatKitti(trajectory_);
  EXPECT_EQ(text.substr(0, 24), "1 0 0 0 0 1 0 0 0 0 1 0\n");
  WriteWholeFile(path_, text);
  const auto poses = ReadKittiPoses(path_);
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_EQ(poses[2].translation, trajectory_[2].world_from_camera.translation);
  EXPECT_LT((poses[2].Matrix() - trajectory_[2].world_from_camera.Matrix()).norm(), 1e-12);
}

TEST_F(TrajectoryFilesTest, TumLeavesLostFramesOutAndKeepsStamps) {
  const std::string text = FormatTum(trajectory_);
  EXPECT_EQ(text[0], '#');
  const size_t first = text.find('\n') + 1;
  EXPECT_EQ(text.substr(first, text.find('\n', first) - first), "1317384506.4 0 0 0 0 0 0 1");
  WriteWholeFile(path_, text);
  const Trajectory read = ReadTumTrajectory(path_);
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[1].stamp_s, 1317384507.25);
  EXPECT_EQ(read[1].world_from_camera.translation, trajectory_[2].world_from_camera.translation);
  EXPECT_LT(
      read[1].world_from_camera.rotation.angularDistance(trajectory_[2].world_from_camera.rotation),
      1e-12);
  EXPECT_EQ(FormatTum(read), text);
}

TEST_F(TrajectoryFilesTest, TumErrorsNameTheLine) {
  EXPECT_EQ(TumErrorOf("0 0 0 0 0 0 0 1\n0 0 0 0 0 0 0 1\n"),
            ":2: the stamp is not later than the one before");
  EXPECT_EQ(TumErrorOf("0 0 0 0 0 0 0 0.9\n"), ":1: the quaternion is not of unit length");
  EXPECT_EQ(TumErrorOf("0 0 0 0 0 0 1\n"), ":1: holds 7 numbers instead of 8");
  EXPECT_EQ(TumErrorOf("0 0 nan 0 0 0 0 1\n"), ":1: 'nan' is not finite");
}

}  // namespace
}  // namespace arfm_vo
