#pragma once

#include <memory>
#include <optional>

#include "arfm_vo/driving/chassis_watch.h"
#include "arfm_vo/hardware/can_bus.h"
#include "arfm_vo/hardware/chassis_protocol.h"
#include "arfm_vo/simulation/tracked_plant.h"

namespace arfm_vo {

/// The tracked chassis at the other end of the CAN bus: powers up in standby, where it hears only
/// the control mode; stops 500 ms after the last motion command; the remote control outranks CAN,
/// and hands back to standby; its emergency stop button stops the tracks, and so does the brake.
class SimulatedChassis {
 public:
  SimulatedChassis(std::unique_ptr<CanBus> bus, TrackedPlant plant);

  /// Obeys what came over the bus, moves on to `now_s` (later than before), and sends the feedback
  /// that has fallen due.
  void Tick(double now_s);

  // What a person at the rover, or fate, can do.
  void PressEmergencyStop(bool is_pressed) { is_emergency_stop_ = is_pressed; }
  /// A fault of its own; error bits as in SystemState. Cleared by ClearErrorsCommand.
  void SetFault(uint16_t error_bits);
  /// The remote control takes over with a motion of its own.
  void TakeRemoteControl(const PlanarMotion& stick);
  void HandBack();
  /// Off: no feedback, no motion, and standby afterwards.
  void SetPower(bool is_on);
  /// What is silent while the rest goes on; nothing: all is told again.
  void Silence(std::optional<FeedbackKind> kind) { silent_ = kind; }
  /// Goes on with the feedback of now, whatever happens.
  void SetFrozenFeedback(bool is_frozen) { is_frozen_ = is_frozen; }
  /// Moves so whatever is commanded; nothing: obeys again.
  void SetRunaway(std::optional<PlanarMotion> motion) { runaway_ = motion; }
  /// A jammed track stands.
  void JamLeftTrack(bool is_jammed) { is_left_jammed_ = is_jammed; }
  /// The error bit of a lost remote control, which does not stop the chassis.
  void SetRemoteLost(bool is_lost) { is_remote_lost_ = is_lost; }
  void SetMotorStatus(uint8_t status_bits) { motor_status_bits_ = status_bits; }

  TrackedPlant& plant() { return plant_; }
  const TrackedPlant& plant() const { return plant_; }
  ControlMode mode() const { return mode_; }
  bool is_lamp_on() const { return is_lamp_on_; }
  bool is_brake_on() const { return is_brake_on_; }

 private:
  void Obey(double now_s);
  PlanarMotion MotionNow(double now_s) const;
  void SendFeedback(double now_s);
  void SendFastFeedback();
  void SendSlowFeedback();
  template <class Message>
  void Send(const Message& message) {
    bus_->Send(EncodeFrame(message));
  }

  std::unique_ptr<CanBus> bus_;
  TrackedPlant plant_;
  ControlMode mode_ = ControlMode::kStandby;
  bool is_on_ = true, is_emergency_stop_ = false, has_fault_ = false;
  bool is_frozen_ = false, is_left_jammed_ = false, is_remote_lost_ = false, is_lamp_on_ = false;
  bool is_brake_on_ = false;
  std::optional<PlanarMotion> runaway_;
  std::optional<FeedbackKind> silent_;
  TrackSpeeds told_speeds_;
  TrackWays told_ways_;
  uint8_t motor_status_bits_ = 0x40;  // the driver is enabled
  uint16_t error_bits_ = 0;
  uint8_t count_ = 0;
  PlanarMotion commanded_, stick_;
  double commanded_s_ = -1e9;
  bool has_ticked_ = false;
  double last_s_ = 0, fast_due_s_ = 0, slow_due_s_ = 0;
};

}  // namespace arfm_vo
