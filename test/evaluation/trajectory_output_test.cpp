#include "arfm_vo/evaluation/trajectory_output.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/odometry/trajectory_files.h"
#include "base/folder_test.h"
#include "base/refusal.h"

namespace arfm_vo {
namespace {

namespace fs = std::filesystem;

using TrajectoryOutputTest = FolderTest;

TEST_F(TrajectoryOutputTest, WritesBothFormatsIntoAFolderThatItMakes) {
  const TrajectoryOutput output({folder_ / "run" / "one", false}, "base_link");
  const Trajectory trajectory{{1.5, Rigid3(), true}, {2.5, Rigid3(), true}};
  const std::string said = output.Save(trajectory);
  EXPECT_NE(said.find("2 poses"), std::string::npos);
  EXPECT_EQ(ReadTumTrajectory(folder_ / "run" / "one" / "trajectory.tum").size(), 2u);
  std::ifstream kitti(folder_ / "run" / "one" / "poses.txt");
  std::string line;
  std::getline(kitti, line);
  EXPECT_EQ(line.substr(0, 1), "1");
}

TEST_F(TrajectoryOutputTest, SaysWhosePosesTheyAre) {
  TrajectoryOutput({folder_, false}, "base_link").Save({{1.5, Rigid3(), true}});
  EXPECT_EQ(ReadWholeFile(folder_ / "frame.txt"),
            "base_link (x ahead, y left, z up, m) in that of the first tracked pair\n");
  EXPECT_EQ(ReadWholeFile(folder_ / "trajectory.tum").rfind("# base_link (x ahead", 0), 0u);
}

TEST_F(TrajectoryOutputTest, InterpolatedPosesAreMarked) {
  const Trajectory trajectory{{1.5, Rigid3(), true}, {2.5, Rigid3(), false}, {3.5, Rigid3(), true}};
  EXPECT_NE(
      TrajectoryOutput({folder_, false}, "base_link").Save(trajectory).find("(1 interpolated)"),
      std::string::npos);
  EXPECT_EQ(ReadWholeFile(folder_ / "tracked.txt"), "1\n0\n1\n");
  EXPECT_EQ(ReadTumTrajectory(folder_ / "trajectory.tum").size(), 2u);
}

TEST_F(TrajectoryOutputTest, AFurtherRunDoesNotOverwriteTheFirst) {
  TrajectoryOutput output({folder_, false}, "base_link");
  output.Save({{1.5, Rigid3(), true}});
  output.StartRun();
  output.Save({{2.5, Rigid3(), true}, {3.5, Rigid3(), true}});
  EXPECT_EQ(ReadTumTrajectory(folder_ / "trajectory.tum").size(), 1u);
  EXPECT_EQ(ReadTumTrajectory(folder_ / "trajectory_2.tum").size(), 2u);
}

TEST_F(TrajectoryOutputTest, TheTrajectoryOfAnEarlierDriveStays) {
  TrajectoryOutput({folder_, false}, "base_link").Save({{1.5, Rigid3(), true}});
  TrajectoryOutput output({folder_, false}, "base_link");
  for (int i = 0; i < 2; ++i) output.Save({{2.5, Rigid3(), true}, {3.5, Rigid3(), true}});
  EXPECT_EQ(ReadTumTrajectory(folder_ / "trajectory.tum").size(), 1u);
  EXPECT_EQ(ReadTumTrajectory(folder_ / "trajectory_2.tum").size(), 2u);
  EXPECT_FALSE(fs::exists(folder_ / "poses_3.txt")) << "saved twice in one run";
}

TEST_F(TrajectoryOutputTest, WithoutADirectoryItSaysSo) {
  EXPECT_FALSE(TrajectoryOutput({"", false}, "base_link").is_enabled());
  EXPECT_INVALID(TrajectoryOutput({"", false}, "base_link").Save({}), "trajectory_dir is not set");
}

}  // namespace
}  // namespace arfm_vo
