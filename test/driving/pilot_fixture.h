#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "arfm_vo/driving/pilot.h"
#include "driving/attend.h"

namespace arfm_vo {

inline constexpr double kTick_s = 0.02;
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A pilot whose pose, chassis and bus are well unless a test says otherwise. The rover itself does
/// not move: what counts is what the pilot commands.
class PilotTest : public ::testing::Test {
 protected:
  static PilotOptions Options() {
    PilotOptions options;
    options.max_stall_s = 1e9;
    options.motion.jam_s = 3600;  // its tracks stand
    return options;
  }

  void Observe() {
    if (bus_up_ && tells_state_) {
      pilot_.chassis_watch().ObserveFeedback(now_s_, FeedbackKind::kMotion);
      pilot_.chassis_watch().Observe(now_s_, chassis_);
    }
    if (bus_up_ && tells_tracks_) pilot_.ObserveTracks(now_s_, way_mm_, way_mm_);
    pilot_.chassis_watch().ObserveBus(bus_up_);
    const auto challenge = pilot_.operator_watch().Advance(now_s_, 1);
    if (has_operator_ && challenge) pilot_.operator_watch().ObserveAnswer(now_s_, *challenge);
    if (has_epoch_) pilot_.ObserveEpoch(1, now_s_ - 0.1);
    if (has_pose_) pilot_.ObservePose(now_s_, {now_s_ - 0.1, pose_, {}});
    if (has_pose_ && has_covariance_)
      pilot_.ObserveUncertainty(now_s_, {now_s_ - 0.1, sigma_m_, heading_sigma_rad_});
  }

  DriveCommand Run(double duration_s) {
    DriveCommand command;
    const int num_ticks = static_cast<int>(std::round(duration_s / kTick_s));
    for (int i = 0; i < num_ticks; ++i) {
      now_s_ += kTick_s;
      Observe();
      command = pilot_.Tick(now_s_);
    }
    return command;
  }

  /// The tracks creep at 25 mm/s.
  void Creep() {
    for (int i = 0; i < 160; ++i, way_mm_ += i % 2) Run(kTick_s);
  }

  /// A pilot as at first, but for what change(options) does.
  template <class Change>
  void Remake(const Change& change) {
    PilotOptions options = Options();
    change(options);
    pilot_ = Pilot(options);
    chassis_ = {};
  }
  void Remake() {
    Remake([](PilotOptions&) {});
  }

  /// Started and driving at a goal 5 m ahead.
  void StartDriving() {
    Run(0.1);
    chassis_.authority = ChassisAuthority::kUs;
    ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
    pilot_.SetRoute({{5, 0, {}}});
    ASSERT_GT(Run(2).chassis_motion.forward_mps, 0.09);
  }

  /// Started, without a goal.
  void Start() {
    chassis_.authority = ChassisAuthority::kUs;
    Run(0.1);
    ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
  }

  /// Started in the mode that stops after each step to look.
  void StartStopLookGo() {
    Remake([](PilotOptions& options) { options.stop_look_go.is_on = true; });
    Start();
  }

  DriveState State() const { return pilot_.Status().state; }
  StopReason Reason() const { return pilot_.Status().reason; }

  Pilot pilot_{Options()};
  double now_s_ = 100;
  ChassisStatus chassis_;
  bool bus_up_ = true, has_pose_ = true, has_operator_ = true;
  bool tells_state_ = true, tells_tracks_ = true, has_epoch_ = true, has_covariance_ = true;
  Rigid3 pose_;
  int way_mm_ = 0;  ///< of the tracks
  double sigma_m_ = 0.01, heading_sigma_rad_ = 0.01;
};

}  // namespace arfm_vo
