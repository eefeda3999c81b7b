#include "arfm_vo/odometry/trajectory_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "arfm_vo/geometry/kitti_poses.h"
#include "arfm_vo/odometry/absolute_trajectory_error.h"
#include "base/shared_data.h"

namespace arfm_vo {
namespace {

/// A straight drive of `num_poses` poses, `step_m` apart, that turns by `yaw_rad` a frame.
std::vector<Rigid3> DriveStraight(int num_poses, double step_m, double yaw_rad = 0) {
  std::vector<Rigid3> path;
  for (int i = 0; i < num_poses; ++i)
    path.emplace_back(ExpSO3({0, yaw_rad * i, 0}), Eigen::Vector3d(0, 0, step_m * i));
  return path;
}

TEST(SegmentError, ScaleErrorOfOnePercentByHand) {
  const auto truth = DriveStraight(301, 1), estimate = DriveStraight(301, 1.01);
  // The first frame more than 100 m on is the 101st: 101 frames of 0.01 m over 100 m.
  EXPECT_NEAR(ComputeSegmentError(truth, estimate, {{100}, 10}).translation_percent, 1.01, 1e-9);
  EXPECT_NEAR(ComputeSegmentError(truth, estimate, {{200}, 10}).translation_percent, 1.005, 1e-9);
  EXPECT_NEAR(ComputeSegmentError(truth, estimate, {{100}, 10}).rotation_deg_per_m, 0, 1e-9);
  EXPECT_EQ(ComputeSegmentError(truth, estimate, {{100}, 10}).num_segments, 20);
  EXPECT_EQ(ComputeSegmentError(truth, estimate, {{100}, 1}).num_segments, 200);
  EXPECT_EQ(ComputeSegmentError(truth, estimate, KittiSegments()).num_segments, 20 + 10);
}

TEST(SegmentError, YawErrorByHand) {
  const double yaw = 0.01 * M_PI / 180;
  const auto error =
      ComputeSegmentError(DriveStraight(301, 1), DriveStraight(301, 1, yaw), {{100}, 10});
  EXPECT_NEAR(error.rotation_deg_per_m, 0.01 * 101 / 100, 1e-9);
}

TEST(SegmentError, IsNanWhereThePathIsTooShort) {
  const auto path = DriveStraight(101, 1);  // exactly 100 m: no frame is further on
  const auto error = ComputeSegmentError(path, path, KittiSegments());
  EXPECT_TRUE(std::isnan(error.translation_percent));
  EXPECT_TRUE(std::isnan(error.rotation_deg_per_m));
  EXPECT_EQ(error.num_segments, 0);
}

TEST(SegmentError, RefusesDifferentNumbersOfPoses) {
  EXPECT_THROW(ComputeSegmentError(DriveStraight(3, 1), DriveStraight(4, 1), ShortSegments()),
               std::invalid_argument);
}

TEST(AbsoluteTrajectoryError, IgnoresTheChoiceOfWorld) {
  std::vector<Rigid3> truth = DriveStraight(50, 1);
  for (int i = 0; i < 50; ++i) truth[i].translation.x() = std::sin(0.1 * i);
  std::vector<Rigid3> moved;
  const Rigid3 other(ExpSO3({0.3, 2, -1}), Eigen::Vector3d(4, 5, 6));
  for (const Rigid3& pose : truth) moved.push_back(other * pose);
  EXPECT_LT(ComputeAbsoluteTrajectoryError(truth, moved), 1e-9);
}

TEST(AbsoluteTrajectoryError, DoesNotScaleByHand) {
  // Positions -1, 0, 1 m against -2, 0, 2 m: errors 1, 0, 1 m.
  EXPECT_NEAR(ComputeAbsoluteTrajectoryError(DriveStraight(3, 1), DriveStraight(3, 2)),
              std::sqrt(2. / 3), 1e-9);
}

TEST(AbsoluteTrajectoryError, StandingStillIsNoError) {
  EXPECT_LT(ComputeAbsoluteTrajectoryError(DriveStraight(5, 0), DriveStraight(5, 0)), 1e-12);
}

TEST(TrajectoryError, EndErrorAndLengthByHand) {
  const auto error = ComputeTrajectoryError(DriveStraight(301, 1), DriveStraight(301, 1.01));
  EXPECT_NEAR(error.end_error_percent, 1, 1e-9);
  EXPECT_NEAR(error.length_ratio, 1.01, 1e-9);
}

TEST(TrajectoryError, ComparesTheCommonFrames) {
  const auto error = ComputeTrajectoryError(DriveStraight(301, 1), DriveStraight(60, 1.01));
  EXPECT_NEAR(error.end_error_percent, 1, 1e-9);
  EXPECT_THROW(ComputeTrajectoryError(DriveStraight(301, 1), DriveStraight(1, 1)),
               std::invalid_argument);
}

TEST(TrajectoryError, StandingStillHasNoRelativeErrors) {
  const auto error = ComputeTrajectoryError(DriveStraight(5, 0), DriveStraight(5, 0.1));
  EXPECT_TRUE(std::isnan(error.end_error_percent));
  EXPECT_TRUE(std::isnan(error.length_ratio));
  EXPECT_EQ(FormatTrajectoryError(error).substr(0, 12), "ate_rmse_m: ");
}

TrajectoryError CompareFiles(const std::string& truth, const std::string& estimate) {
  return ComputeTrajectoryError(ReadKittiPoses(truth), ReadKittiPoses(estimate));
}

TEST(TrajectoryError, GivesThePublishedFiguresOfOrbSlam2AndSptam) {
  const std::string truth = FindShared("data/kitti/ground_truth_poses/00.txt");
  if (truth.empty()) GTEST_SKIP() << "no shared/data beside the package";
  const auto orb = CompareFiles(truth, FindShared("data/trajectories/evo_KITTI_00_ORB.txt"));
  EXPECT_NEAR(orb.kitti.translation_percent, 0.70, 0.005);
  EXPECT_NEAR(100 * orb.kitti.rotation_deg_per_m, 0.25, 0.005);
  const auto sptam = CompareFiles(truth, FindShared("data/trajectories/evo_KITTI_00_SPTAM.txt"));
  EXPECT_NEAR(sptam.kitti.translation_percent, 1.49, 0.005);
}

/// What a command prints.
std::string ReadOutputOf(const std::string& command) {
  FILE* pipe = popen(command.c_str(), "r");
  std::string text;
  for (char buffer[4096]; std::fgets(buffer, sizeof(buffer), pipe);) text += buffer;
  pclose(pipe);
  return text;
}

TEST(TrajectoryError, AgreesWithTheIndependentEvaluator) {
  const std::string evaluator = FindShared("tools/kitti_eval.py");
  if (evaluator.empty()) GTEST_SKIP() << "no shared/tools beside the package";
  const std::string truth = FindShared("data/kitti/ground_truth_poses/09.txt");
  const std::string estimate = FindShared("data/trajectories/kitti-odom-eval_example_1_09.txt");
  const auto error = CompareFiles(truth, estimate);
  const std::string json =
      ReadOutputOf("/usr/bin/python3 " + evaluator + " --json " + truth + " " + estimate);
  const auto expected = [&](const std::string& key) {
    const size_t at = json.find("\"" + key + "\": ");
    return at == std::string::npos ? NAN : std::stod(json.substr(at + key.size() + 4));
  };
  // The evaluator takes angles from the cosine of matrices with 7 digits, we from quaternions.
  EXPECT_NEAR(error.kitti.translation_percent / expected("t_rel_pct"), 1, 1e-4);
  EXPECT_NEAR(error.kitti.rotation_deg_per_m / expected("r_rel_deg_per_m"), 1, 1e-3);
  EXPECT_NEAR(error.brief.translation_percent / expected("short_t_pct"), 1, 1e-4);
  EXPECT_NEAR(error.brief.rotation_deg_per_m / expected("short_r_deg_per_m"), 1, 1e-3);
  EXPECT_NEAR(error.ate_rmse_m / expected("ate_rmse_m"), 1, 1e-4);
  EXPECT_NEAR(error.end_error_percent / expected("end_err_pct"), 1, 1e-4);
  EXPECT_NEAR(error.length_ratio / expected("length_ratio"), 1, 1e-5);
}

}  // namespace
}  // namespace arfm_vo
