#include "arfm_vo/bundle_adjustment/pose_graph.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace arfm_vo {
namespace {

PoseConstraint Constrain(int first, int second, const Rigid3& second_from_first) {
  return {first, second, second_from_first, Eigen::Matrix<double, 6, 6>::Identity()};
}

/// The step of a camera that goes `metres` ahead.
Rigid3 Ahead(double metres) {
  return {Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, -metres)};
}

TEST(PoseGraph, SharesALoopOutEvenly) {
  const std::vector<Rigid3> poses{Ahead(0), Ahead(1), Ahead(2)};
  std::vector<PoseConstraint> loops{Constrain(0, 2, Ahead(2.3))};
  const auto solved =
      SolvePoseGraph(poses, {Constrain(0, 1, Ahead(1)), Constrain(1, 2, Ahead(1))}, loops);
  EXPECT_NEAR(solved[0].translation.z(), 0, 1e-12);
  EXPECT_NEAR(solved[1].translation.z(), -1.1, 1e-9);  // each of the three gives 0.1
  EXPECT_NEAR(solved[2].translation.z(), -2.2, 1e-9);
}

TEST(PoseGraph, BringsARoundDriveBackToItsStart) {
  constexpr int kPoses = 40;
  const Rigid3 true_step(ExpSO3({0, -2 * M_PI / kPoses, 0}), Eigen::Vector3d(0, 0, -1));
  const Rigid3 biased_step(ExpSO3({0, -2 * M_PI / kPoses + 0.01, 0}), Eigen::Vector3d(0, 0, -1.02));
  std::vector<Rigid3> truth(1), drifted(1);
  std::vector<PoseConstraint> constraints;
  for (int i = 0; i < kPoses; ++i) {
    truth.push_back(true_step * truth.back());
    drifted.push_back(biased_step * drifted.back());
    constraints.push_back(Constrain(i, i + 1, biased_step));
  }
  PoseConstraint loop = Constrain(0, kPoses, Rigid3());
  loop.information *= 1e6;
  std::vector<PoseConstraint> loops{loop};
  const auto solved = SolvePoseGraph(drifted, constraints, loops);
  EXPECT_GT((drifted.back().translation - truth.back().translation).norm(), 1);
  EXPECT_LT((solved.back().translation - truth.back().translation).norm(), 1e-3);
  const auto error = [&](const std::vector<Rigid3>& poses) {
    double sum = 0;
    for (int i = 0; i <= kPoses; ++i)
      sum += (poses[i].Inverse().translation - truth[i].Inverse().translation).norm();
    return sum;
  };
  EXPECT_LT(error(solved), 0.3 * error(drifted));
}

TEST(PoseGraph, LeavesPosesThatNothingTies) {
  const std::vector<Rigid3> poses{Ahead(0), Ahead(1), Ahead(2)};
  std::vector<PoseConstraint> loops;
  const auto solved = SolvePoseGraph(poses, {Constrain(0, 1, Ahead(3))}, loops);
  EXPECT_NEAR(solved[1].translation.z(), -1, 1e-12);
  EXPECT_NEAR(solved[2].translation.z(), -2, 1e-12);
}

TEST(PoseGraph, RefusesAConstraintOfAPoseThatIsNotThere) {
  std::vector<PoseConstraint> loops{Constrain(0, 2, Ahead(1))};
  const std::vector<Rigid3> poses{Ahead(0), Ahead(1)};
  EXPECT_THROW(SolvePoseGraph(poses, {}, loops), std::invalid_argument);
  EXPECT_THROW(FindErrorCovariance(poses, {}, {}, loops[0]), std::invalid_argument);
}

/// Ten metres of steps of 1 cm; ten loops tell the length to 1 mm, one is off by 20 cm.
TEST(PoseGraph, ALoopThatContradictsTheOthersHardlyCounts) {
  std::vector<Rigid3> poses;
  std::vector<PoseConstraint> steps, loops;
  for (int i = 0; i <= 10; ++i) poses.push_back(Ahead(i));
  for (int i = 0; i < 10; ++i) steps.push_back(Constrain(i, i + 1, Ahead(1)));
  for (PoseConstraint& step : steps) step.information *= 1e4;
  for (int i = 0; i < 11; ++i) loops.push_back(Constrain(0, 10, Ahead(i < 10 ? 10.05 : 10.25)));
  for (PoseConstraint& loop : loops) loop.information *= 1e6;
  const auto solved = SolvePoseGraph(poses, steps, loops);
  EXPECT_NEAR(solved[10].translation.z(), -10.05, 1e-3);
  EXPECT_GT(loops[0].information(5, 5), 0.9e6);
  EXPECT_LT(loops[10].information(5, 5), 1e2);
}

TEST(PoseGraph, StatesTheErrorThatALoopWouldHave) {
  std::vector<PoseConstraint> steps{Constrain(0, 1, Ahead(1)), Constrain(1, 2, Ahead(1))};
  for (PoseConstraint& step : steps) step.information *= 100;
  const std::vector<Rigid3> poses{Ahead(0), Ahead(1), Ahead(2)};
  const PoseConstraint next = Constrain(0, 2, Ahead(2));
  const auto open = FindErrorCovariance(poses, steps, {}, next);
  EXPECT_NEAR(open(5, 5), 2 * 0.01, 1e-9);        // along the way
  EXPECT_NEAR(open(0, 0), 2 * 0.01, 1e-9);        // rotation
  EXPECT_NEAR(open(3, 3), (2 + 1) * 0.01, 1e-9);  // beside it: the first step's turn 1 m before
  PoseConstraint loop = next;
  loop.information *= 1e8;
  EXPECT_LT(FindErrorCovariance(poses, steps, {loop}, next)(3, 3), 1e-7);
  EXPECT_TRUE(FindErrorCovariance(poses, {steps[0]}, {}, next).hasNaN());
}

}  // namespace
}  // namespace arfm_vo
