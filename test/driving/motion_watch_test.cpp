#include "arfm_vo/driving/motion_watch.h"

#include <gtest/gtest.h>

#include <vector>

namespace arfm_vo {
namespace {

constexpr double kWatchTick_s = 0.02, kGauge_m = 0.583;

class MotionWatchTest : public ::testing::Test {
 protected:
  /// Commands `commanded` for `duration_s` while the tracks run as `left_mps` and `right_mps`.
  void Run(double duration_s, const PlanarMotion& commanded, double left_mps, double right_mps) {
    const TrackKinematics kinematics({kGauge_m, 1.0});
    for (const double end_s = now_s_ + duration_s; now_s_ < end_s; now_s_ += kWatchTick_s) {
      ways_.left_m += kWatchTick_s * left_mps;
      ways_.right_m += kWatchTick_s * right_mps;
      watch_.ObserveRest(now_s_, commanded.IsZero());
      watch_.ObserveCommand(now_s_, commanded);
      watch_.ObserveWays(ways_);
      watch_.ObserveMotion(now_s_, kinematics.MotionOf({left_mps, right_mps}));
      watch_.ObserveCounter(now_s_, counter_ += counter_step_);
    }
  }
  StopReason Reason() const { return watch_.FindFault(now_s_).value_or(Fault{}).reason; }

  MotionWatch watch_{MotionWatchOptions{}, kGauge_m};
  double now_s_ = 10;
  TrackWays ways_;
  int counter_ = 0, counter_step_ = 1;
};

TEST_F(MotionWatchTest, TheTracksAreComparedWithTheCommand) {
  struct Leg {
    double duration_s;
    PlanarMotion commanded;
    double left_mps, right_mps;
  };
  const Leg rest{1, {0, 0}, 0, 0}, excess{0.12, {0, 0}, 0.1, 0.1}, ahead{3, {0.1, 0}, 0.1, 0.1};
  const struct {
    const char* name;
    std::vector<Leg> legs;
    StopReason reason;
  } rows[] = {{"follows", {{5, {0.1, 0}, 0.09, 0.1}}, StopReason::kNone},
              {"runs out", {ahead, {0.4, {0, 0}, 0.05, 0.05}, rest}, StopReason::kNone},
              {"turns", {{5, {0, 0.1}, -0.029, 0.029}}, StopReason::kNone},
              {"moves at command zero", {rest, {0.5, {0, 0}, 0.1, 0.1}}, StopReason::kRunaway},
              {"responds to the stop", {ahead, {0.5, {0, 0}, 0.1, 0.1}}, StopReason::kNone},
              {"goes on after the stop", {ahead, {1, {0, 0}, 0.1, 0.1}}, StopReason::kRunaway},
              {"right is faster", {ahead, {0.5, {0.05, 0}, 0.05, 0.16}}, StopReason::kRunaway},
      {"left is faster", {ahead, {0.5, {0.05, 0}, 0.16, 0.05}}, StopReason::kRunaway},
              {"two short excesses", {rest, excess, rest, excess}, StopReason::kNone},
              {"a slow one stands", {{2.2, {0.02, 0}, 0, 0.02}}, StopReason::kTrackJammed}};
  for (const auto& [name, legs, reason] : rows) {
    watch_ = MotionWatch{MotionWatchOptions{}, kGauge_m};
    for (const Leg& leg : legs) Run(leg.duration_s, leg.commanded, leg.left_mps, leg.right_mps);
    EXPECT_EQ(Reason(), reason) << name;
  }
}

TEST_F(MotionWatchTest, AStartForgetsARunaway) {
  Run(1, {0, 0}, 0, 0);
  Run(0.5, {0, 0}, 0.1, 0.1);
  ASSERT_EQ(Reason(), StopReason::kRunaway);
  watch_.Reset();
  EXPECT_EQ(Reason(), StopReason::kNone);
}

TEST_F(MotionWatchTest, ACreepAtRestIsNoticedByItsWayAndNamed) {
  Run(2, {0.1, 0}, 0.1, 0.1);
  Run(2, {0, 0}, 0, 0);
  EXPECT_FALSE(watch_.FindMotionAtRest(now_s_));
  Run(2.3, {0, 0}, 0, -0.02);  // one track, 0.046 m
  EXPECT_FALSE(watch_.FindMotionAtRest(now_s_));
  Run(0.6, {0, 0}, 0, -0.02);
  ASSERT_TRUE(watch_.FindMotionAtRest(now_s_));
  EXPECT_EQ(watch_.FindMotionAtRest(now_s_)->reason, StopReason::kMotionAtRest);
  EXPECT_EQ(watch_.FindMotionAtRest(now_s_)->detail, "0.06 m (allowed 0.05 m)");
  EXPECT_EQ(Reason(), StopReason::kNone) << "too slow for a runaway";
  watch_.Reset();
  EXPECT_FALSE(watch_.FindMotionAtRest(now_s_));
}

TEST_F(MotionWatchTest, TheRunOutAfterAStopIsNoMotionAtRest) {
  Run(2, {0.1, 0}, 0.1, 0.1);
  Run(0.9, {0, 0}, 0.1, 0.1);
  Run(5, {0, 0}, 0, 0);
  EXPECT_FALSE(watch_.FindMotionAtRest(now_s_));
}

TEST_F(MotionWatchTest, ACreepThatOnlyTheMeasuredMotionOrTheOdometerTellsIsNoticed) {
  for (const bool is_by_odometer : {false, true}) {
    watch_.Reset();
    Run(2, {0, 0}, 0, 0);
    for (int i = 0; i < 150; ++i) {
      now_s_ += kWatchTick_s;
      if (is_by_odometer) watch_.ObserveWays({ways_.left_m += 0.0004, ways_.right_m});
      watch_.ObserveMotion(now_s_, {is_by_odometer ? 0 : 0.02, 0});
      watch_.ObserveRest(now_s_, true);
    }
    EXPECT_TRUE(watch_.FindMotionAtRest(now_s_)) << is_by_odometer;
  }
}

TEST_F(MotionWatchTest, NoiseAndOneWrongReadingAreNoMotionAtRest) {
  Run(2, {0, 0}, 0, 0);
  for (int i = 0; i < 3000; ++i) {
    now_s_ += kWatchTick_s;
    const bool is_misread = i == 1500;
    watch_.ObserveWays({is_misread ? 0.9 : 0.001 * (i % 2), 0});
    watch_.ObserveMotion(now_s_, {is_misread ? 30 : 0.004, 0.001});
    watch_.ObserveRest(now_s_, true);
    ASSERT_FALSE(watch_.FindMotionAtRest(now_s_)) << i;
  }
}

TEST_F(MotionWatchTest, WhoeverElseDrivesItIsNotJudged) {
  Run(2, {0, 0}, 0, 0);
  for (int i = 0; i < 100; ++i) {
    now_s_ += kWatchTick_s;
    watch_.ObserveWays({0.01 * i, 0.01 * i});
    watch_.ObserveRest(now_s_, false);
  }
  Run(2, {0, 0}, 0, 0);
  EXPECT_FALSE(watch_.FindMotionAtRest(now_s_));
}

TEST_F(MotionWatchTest, AWayOfBeforeDoesNotHideAJam) {
  for (const double time_s : {10., 13., 16.}) {
    watch_.ObserveWays({time_s > 10 ? 0.3 : 0, 0.1 * time_s});
    watch_.ObserveCommand(time_s, {0.1, 0});
  }
  EXPECT_EQ(watch_.FindFault(16)->reason, StopReason::kTrackJammed);
}

TEST_F(MotionWatchTest, ATrackThatStandsForTwoSecondsIsJammedAndNamed) {
  Run(1.8, {0.1, 0}, 0.1, 0);
  EXPECT_EQ(Reason(), StopReason::kNone);
  Run(0.4, {0.1, 0}, 0.1, 0);
  EXPECT_EQ(Reason(), StopReason::kTrackJammed);
  EXPECT_EQ(watch_.FindFault(now_s_)->detail, "the right one");
  watch_.Reset();
  EXPECT_EQ(Reason(), StopReason::kNone);
}

TEST_F(MotionWatchTest, ACounterThatStandsIsFrozenFeedback) {
  Run(1, {0, 0}, 0, 0);
  counter_step_ = 0;
  Run(0.9, {0, 0}, 0, 0);
  EXPECT_EQ(Reason(), StopReason::kNone);
  Run(0.2, {0, 0}, 0, 0);
  EXPECT_EQ(Reason(), StopReason::kFeedbackFrozen);
}

TEST_F(MotionWatchTest, AMotorThatDrawsTooMuchForTooLongIsAFault) {
  watch_.ObserveCurrent(10, 80);
  EXPECT_FALSE(watch_.FindFault(11));
  watch_.ObserveCurrent(12.1, 80);
  EXPECT_EQ(watch_.FindFault(12.1)->reason, StopReason::kMotorFault);
  EXPECT_EQ(watch_.FindFault(12.1)->detail, "80 A (allowed 60 A)");
  watch_.ObserveCurrent(12.2, 5);
  EXPECT_FALSE(watch_.FindFault(20));
  watch_.ObserveCurrent(21, 80);
  ASSERT_TRUE(watch_.FindFault(24));
  watch_.Reset();
  EXPECT_FALSE(watch_.FindFault(24)) << "as at a start";
}

}  // namespace
}  // namespace arfm_vo
