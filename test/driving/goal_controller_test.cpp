#include "arfm_vo/driving/goal_controller.h"

#include <gtest/gtest.h>

#include <limits>

#include "arfm_vo/base/random.h"
#include "arfm_vo/driving/speed_limiter.h"

namespace arfm_vo {
namespace {

constexpr double kControlTick_s = 0.02;

/// A base that moves as it is told, times a gain, behind the limiter.
struct IdealDrive {
  RoverPose pose;
  double forward_gain = 1, turn_gain = 1;
  double time_s = 0, rest_s = 0;
  double min_forward_mps = 0, max_forward_mps = 0;
  SpeedLimiter limiter{SpeedLimiterOptions{}, TrackKinematics(TrackKinematicsOptions{})};

  bool DriveTo(GoalController& controller, double limit_s = 1000) {
    for (; time_s < limit_s; time_s += kControlTick_s) {
      const PlanarMotion wanted = controller.Update(pose, rest_s > 0.5);
      if (controller.HasArrived()) return true;
      const PlanarMotion motion = limiter.Limit(wanted, kControlTick_s);
      rest_s = motion.IsZero() ? rest_s + kControlTick_s : 0;
      min_forward_mps = std::min(min_forward_mps, motion.forward_mps);
      max_forward_mps = std::max(max_forward_mps, motion.forward_mps);
      pose = Advance(pose, forward_gain * motion.forward_mps * kControlTick_s,
                     turn_gain * motion.turn_radps * kControlTick_s);
    }
    return false;
  }
};

void ExpectAt(const RoverPose& pose, const Waypoint& goal) {
  EXPECT_LT(std::hypot(pose.x_m - goal.x_m, pose.y_m - goal.y_m), 0.045);
  if (goal.heading_rad) {
    EXPECT_LT(std::abs(WrapAngle(pose.heading_rad - *goal.heading_rad)), 0.045);
  }
}

TEST(GoalController, DrivesStraightToAGoalAhead) {
  GoalController controller({}, {{2, 0, 0.0}});
  IdealDrive drive;
  EXPECT_EQ(controller.Update(drive.pose, false).turn_radps, 0);
  EXPECT_EQ(controller.Phase(), DrivePhase::kDrive);
  EXPECT_TRUE(drive.DriveTo(controller));
  ExpectAt(drive.pose, {2, 0, 0.0});
  EXPECT_NEAR(drive.pose.y_m, 0, 1e-9);
  EXPECT_LT(drive.time_s, 2 / 0.1 + 10);
}

TEST(GoalController, TurnsForwardWhereThatIsTheSmallerTurn) {
  // Forward 70 degrees and back again, backward 110.
  GoalController controller({}, {{0.171, 0.47, 0.0}});
  EXPECT_GT(controller.Update({}, false).turn_radps, 0);
  // From 2 rad to 1 rad.
  GoalController turned({}, {{0.27, 0.42, {}}});
  EXPECT_LT(turned.Update({0, 0, 2}, false).turn_radps, 0);
}

TEST(GoalController, AWaypointIsPassedWithinItsTolerance) {
  GoalControllerOptions options;
  GoalController controller(options, {{1.5 * options.waypoint_tolerance_m, 0, {}}, {5, 0, {}}});
  controller.Update({}, false);
  EXPECT_EQ(controller.NextWaypoint(), 0u);
}

TEST(GoalController, ATurnTowardsTheWaypointIsProgress) {
  GoalController controller({}, {{5, 0, {}}});
  controller.Update({0, 0, 1}, false);
  EXPECT_LT(controller.Cost({0, 0, 0.5}), controller.Cost({0, 0, 1}));
}

TEST(GoalController, IsNeverSlowerThanItsLeastSpeed) {
  GoalControllerOptions options;
  options.position_tolerance_m = 0.005;
  GoalController controller(options, {{1, 0, {}}});
  EXPECT_NEAR(controller.Update({0.99, 0, 0}, false).forward_mps, 0.015, 1e-9);
}

TEST(GoalController, SlowsDownBeforeTheLastWaypointOnly) {
  GoalControllerOptions options;
  options.waypoint_tolerance_m = 0.05;
  GoalController last(options, {{1, 0, {}}}), passing(options, {{1, 0, {}}, {3, 0, {}}});
  EXPECT_NEAR(last.Update({0.9, 0, 0}, false).forward_mps, 0.5 * 0.1, 1e-9);
  EXPECT_NEAR(passing.Update({0.9, 0, 0}, false).forward_mps, 0.1, 1e-9);
}

TEST(GoalController, BacksWhereThatSavesTheTurnToTheGoalsHeading) {
  GoalController controller({}, {{0, 0.5, -M_PI / 2}});
  EXPECT_LT(controller.Update({}, false).turn_radps, 0) << "away from the goal, to back to it";
}

TEST(GoalController, TurnsInPlaceFirstWhereTheGoalLiesBeside) {
  GoalController controller({}, {{0, 3, std::nullopt}});
  const PlanarMotion motion = controller.Update({}, false);
  EXPECT_EQ(motion.forward_mps, 0);
  EXPECT_DOUBLE_EQ(motion.turn_radps, 0.15);
  GoalController to_the_right({}, {{0, -3, std::nullopt}});
  EXPECT_DOUBLE_EQ(to_the_right.Update({}, false).turn_radps, -0.15);
}

TEST(GoalController, BacksToANearGoalOnlyWhereItMay) {
  const struct {
    Waypoint goal;
    bool may_back, backs, drives_ahead;
  } rows[] = {{{-0.5, 0, 0.0}, true, true, false},   // behind
              {{-3, 0, M_PI}, true, false, true},    // far behind: turns round
              {{-0.5, 0, 0.0}, false, false, true},  // backing is forbidden
              {{0, 0, -2.0}, true, false, false}};   // under the rover: turns only
  for (const auto& [goal, may_back, backs, drives_ahead] : rows) {
    GoalControllerOptions options;
    if (!may_back) options.max_backward_m = 0;
    GoalController controller(options, {goal});
    IdealDrive drive;
    EXPECT_TRUE(drive.DriveTo(controller));
    ExpectAt(drive.pose, goal);
    EXPECT_EQ(drive.min_forward_mps < (backs ? -0.05 : 0), backs);
    EXPECT_EQ(drive.max_forward_mps > 0, drives_ahead);
  }
}

TEST(GoalController, ReachesAnyGoalInSpiteOfSlip) {
  RandomEngine engine(3);
  for (int i = 0; i < 200; ++i) {
    IdealDrive drive;
    drive.pose.heading_rad = WrapAngle(7 * RandomUnit(engine));
    drive.forward_gain = 0.8 + 0.3 * RandomUnit(engine);
    drive.turn_gain = 0.5 + 0.7 * RandomUnit(engine);
    const Waypoint goal{8 * RandomUnit(engine) - 4, 8 * RandomUnit(engine) - 4,
                        6 * RandomUnit(engine) - 3};
    GoalController controller({}, {goal});
    EXPECT_TRUE(drive.DriveTo(controller)) << i;
    ExpectAt(drive.pose, goal);
  }
}

TEST(GoalController, PassesTheWaypointsOfARouteInOrder) {
  const Route route{{1, 0, {}}, {1, 1, {}}, {0, 1, M_PI}};
  GoalController controller({}, route);
  EXPECT_NEAR(controller.RemainingDistance({}), 3, 1e-12);
  IdealDrive drive;
  EXPECT_TRUE(drive.DriveTo(controller));
  EXPECT_EQ(controller.NextWaypoint(), 2u);
  ExpectAt(drive.pose, route.back());
}

TEST(GoalController, WaypointsAlreadyPassedAreSkippedAtOnce) {
  GoalController controller({}, {{0, 0, {}}, {0.05, 0, {}}, {2, 0, {}}});
  controller.Update({}, false);
  EXPECT_EQ(controller.NextWaypoint(), 2u);
}

TEST(GoalController, IsNotArrivedBeforeAPoseAtRestConfirmsIt) {
  GoalController controller({}, {{0, 0, 0.0}});
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(controller.Update({}, false).IsZero());
  EXPECT_EQ(controller.Phase(), DrivePhase::kSettle);
  controller.Update({}, true);
  EXPECT_TRUE(controller.HasArrived());
}

TEST(GoalController, GoesBackToTheGoalWhereRestShowsItMissed) {
  GoalController controller({}, {{1, 0, 0.0}});
  controller.Update({1, 0, 0}, false);
  EXPECT_EQ(controller.Phase(), DrivePhase::kSettle);
  const PlanarMotion motion = controller.Update({0.8, 0, 0}, true);
  EXPECT_GT(motion.forward_mps, 0);
  EXPECT_EQ(controller.Phase(), DrivePhase::kDrive);
  controller.Update({1, 0, 0}, false);
  EXPECT_NE(controller.Update({1, 0, 0.1}, true).turn_radps, 0);
  EXPECT_EQ(controller.Phase(), DrivePhase::kTurnToHeading);
}

TEST(GoalController, StopsToTurnWhereItIsPushedAside) {
  GoalController controller({}, {{5, 0, {}}});
  controller.Update({0, 0, 0}, false);
  const PlanarMotion motion = controller.Update({0, 0, 1.0}, false);
  EXPECT_EQ(motion.forward_mps, 0);
  EXPECT_LT(motion.turn_radps, 0);
}

TEST(GoalController, ARouteNeedsAWaypoint) {
  EXPECT_THROW(GoalController({}, {}), std::invalid_argument);
}

TEST(Route, GoalsWithFlawsAreToldWhy) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
  const auto flaw = [](const Eigen::Quaterniond& rotation, double x) {
    Rigid3 goal;
    goal.rotation = rotation;
    goal.translation.x() = x;
    return FindGoalFlaw(goal);
  };
  EXPECT_EQ(flaw(level, 3), "");
  EXPECT_EQ(flaw(level, nan), "its position is not finite");
  EXPECT_EQ(flaw(level, infinity), "its position is not finite");
  EXPECT_EQ(flaw(level, 1e6), "it is more than 100 km away");
  EXPECT_EQ(flaw(Eigen::Quaterniond(nan, 0, 0, 1), 0), "its orientation is not finite");
  EXPECT_EQ(flaw(Eigen::Quaterniond(0, 0, 0, 0), 0), "its quaternion is not of unit length");
  EXPECT_EQ(flaw(Eigen::Quaterniond(0.5, 0, 0, 0), 0), "its quaternion is not of unit length");
  EXPECT_EQ(flaw(Eigen::Quaterniond(std::sqrt(0.5), 0, std::sqrt(0.5), 0), 0),
            "its x axis stands on end");
}

}  // namespace
}  // namespace arfm_vo
