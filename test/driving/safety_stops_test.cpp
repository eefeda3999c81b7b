// Each way of leaving the drive that the other tests of the pilot do not take: what is said, that
// the goal is dropped and that nothing moves until a person starts the rover again.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "arfm_vo/driving/goal_controller.h"
#include "arfm_vo/driving/pilot.h"
#include "arfm_vo/driving/route.h"
#include "driving/attend.h"

namespace arfm_vo {
namespace {

constexpr double kTick_s = 0.02, kStandingTrack_s = 3600;

Rigid3 At(double x_m, double y_m = 0) {
  return {Eigen::Quaterniond::Identity(), Eigen::Vector3d(x_m, y_m, 0)};
}

/// A rover that moves as it is commanded, within a fence, and sees its pose at 50 Hz.
class SafetyStopTest : public ::testing::Test {
 protected:
  static PilotOptions Options() {
    PilotOptions options;
    options.goal_limits.fence_m = {-5, -2, 6, -2, 6, 2, -5, 2};
    options.motion.jam_s = kStandingTrack_s;
    return options;
  }

  DriveCommand Tick() {
    now_s_ += kTick_s;
    pilot_.chassis_watch().ObserveBus(true);
    Attend(pilot_.operator_watch(), now_s_);
    pilot_.chassis_watch().ObserveFeedback(now_s_, FeedbackKind::kMotion);
    pilot_.chassis_watch().Observe(now_s_, chassis_);
    const int way_mm = static_cast<int>(std::lround(1000 * tracks_m_));
    pilot_.ObserveTracks(now_s_, way_mm, way_mm);
    pilot_.ObserveEpoch(epoch_, now_s_);
    pilot_.ObservePose(now_s_, {now_s_, At(tracks_m_ + ahead_m_, aside_m_), map_from_odom_});
    pilot_.ObserveUncertainty(now_s_, {now_s_, 0.01, 0.01});
    const DriveCommand command = pilot_.Tick(now_s_);
    tracks_m_ += command.chassis_motion.forward_mps * kTick_s;
    return command;
  }
  DriveCommand Run(double duration_s) {
    DriveCommand command;
    for (const double end_s = now_s_ + duration_s; now_s_ < end_s;) command = Tick();
    return command;
  }
  void StartDriving() {
    Run(0.2);
    chassis_.authority = ChassisAuthority::kUs;
    ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
    ASSERT_TRUE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
    ASSERT_GT(Run(3).chassis_motion.forward_mps, 0.09);
  }
  /// It stands within a second, says why and what became of the goal, and goes on by nothing but a
  /// start.
  void ExpectBlockedBy(StopReason reason, GoalOutcome outcome) {
    const DriveCommand command = Run(1);
    EXPECT_TRUE(command.chassis_motion.IsZero());
    const PilotStatus status = pilot_.Status();
    EXPECT_EQ(status.state, DriveState::kBlocked);
    EXPECT_EQ(status.reason, reason) << ToString(status.reason);
    const auto results = pilot_.TakeResults();
    ASSERT_FALSE(results.empty());
    EXPECT_EQ(results.back().outcome, outcome) << ToString(results.back().outcome);
    EXPECT_FALSE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
    EXPECT_TRUE(Run(5).chassis_motion.IsZero());
  }

  Pilot pilot_{Options()};
  ChassisStatus chassis_;
  Rigid3 map_from_odom_;
  uint32_t epoch_ = 1;
  double now_s_ = 100, tracks_m_ = 0, ahead_m_ = 0, aside_m_ = 0;
};

TEST_F(SafetyStopTest, NothingStopsARoverThatMovesAsItsTracks) {
  StartDriving();
  EXPECT_GT(Run(5).chassis_motion.forward_mps, 0.09);
  EXPECT_EQ(pilot_.Status().state, DriveState::kDriving);
}

TEST_F(SafetyStopTest, AMapThatJumpsUnderTheRoverBlocks) {
  StartDriving();
  map_from_odom_ = At(0, 0.3);
  ExpectBlockedBy(StopReason::kMapStep, GoalOutcome::kBlocked);
}

TEST_F(SafetyStopTest, AMapThatMovesLittleDoesNot) {
  StartDriving();
  map_from_odom_ = At(0, 0.2);
  EXPECT_GT(Run(1).chassis_motion.forward_mps, 0.09);
}

TEST_F(SafetyStopTest, APoseThatJumpsBlocks) {
  StartDriving();
  ahead_m_ = 0.5;
  ExpectBlockedBy(StopReason::kPoseContradiction, GoalOutcome::kCancelled);
}

TEST_F(SafetyStopTest, ARoverThatSlidesAsideSlowlyBlocks) {
  StartDriving();
  // 2 mm a pose, too little to be a jump; 0.3 m in the 3 s that are compared.
  while (pilot_.Status().state == DriveState::kDriving && aside_m_ < 1) {
    aside_m_ += 0.002;
    Tick();
  }
  EXPECT_LT(aside_m_, 0.4);
  ExpectBlockedBy(StopReason::kSliding, GoalOutcome::kCancelled);
}

TEST_F(SafetyStopTest, AnOdometryThatStartsAnewBlocks) {
  StartDriving();
  epoch_ = 2;
  ExpectBlockedBy(StopReason::kNewEpoch, GoalOutcome::kCancelled);
  EXPECT_NE(pilot_.Status().detail.find("epoch 2"), std::string::npos) << pilot_.Status().detail;
}

TEST_F(SafetyStopTest, ARoverThatIsCarriedOverTheFenceBlocks) {
  StartDriving();
  // The map is told bit by bit to be elsewhere, and with each bit somebody plans anew.
  double aside_m = 0;
  while (pilot_.Status().state == DriveState::kDriving && aside_m < 4) {
    aside_m += 0.01;
    map_from_odom_ = At(0, aside_m);
    pilot_.SetRoute({{5, 0, {}}});
    Tick();
  }
  EXPECT_NEAR(aside_m, 2, 0.15);
  ExpectBlockedBy(StopReason::kOutsideFence, GoalOutcome::kBlocked);
}

TEST(DrivingNames, EachValueHasANameOfItsOwn) {
  const auto expect_distinct = [](auto last) {
    using Value = decltype(last);
    std::set<std::string> names;
    const int num_values = static_cast<int>(last) + 1;
    for (int i = 0; i < num_values; ++i) names.insert(ToString(static_cast<Value>(i)));
    EXPECT_EQ(static_cast<int>(names.size()), num_values);
    EXPECT_EQ(names.count("unknown"), 0u);
    EXPECT_EQ(names.count(""), 0u);
  };
  expect_distinct(DriveState::kWarning);
  expect_distinct(StopReason::kVelocityConflict);
  expect_distinct(GoalOutcome::kReplaced);
  expect_distinct(DrivePhase::kArrived);
}

TEST(Route, AWaypointTakesPlaceAndHeadingOfTheGoal) {
  const Rigid3 goal(ExpSO3({0, 0, 0.5}), Eigen::Vector3d(3, -4, 7));
  const Waypoint waypoint = ToWaypoint(goal);
  EXPECT_DOUBLE_EQ(waypoint.x_m, 3);
  EXPECT_DOUBLE_EQ(waypoint.y_m, -4);
  ASSERT_TRUE(waypoint.heading_rad);
  EXPECT_NEAR(*waypoint.heading_rad, 0.5, 1e-12);
}

}  // namespace
}  // namespace arfm_vo
