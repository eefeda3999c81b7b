#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "arfm_vo/driving/pilot.h"
#include "arfm_vo/hardware/can_bus.h"
#include "arfm_vo/hardware/chassis_protocol.h"

namespace arfm_vo {

/// The newest of everything that the chassis has said.
struct ChassisReadings {
  std::optional<SystemState> system;
  std::optional<MotionState> motion;
  std::optional<TrackOdometer> odometer;
  std::optional<BatteryState> battery;
  std::array<std::optional<MotorState>, 2> motors;         ///< [ChassisSide]
  std::array<std::optional<MotorDriverState>, 2> drivers;  ///< [ChassisSide]
};

/// 0x131: byte 0 is 1 to lock the tracks, 0 to release them; by the manual of the Hunter 2.0, of
/// the same family.
constexpr uint32_t kBrakeCommandId = 0x131;

/// Whether `frame` commands the chassis, whoever has sent it: see kCommandIds.
bool IsCommand(const CanFrame& frame);

/// `motion` within what may go out on the bus: 0.1 m/s, and the turn in place at that speed.
PlanarMotion LimitMotion(const PlanarMotion& motion);

/// Frames since the link was made.
struct ChassisTraffic {
  long num_sent = 0;
  long num_send_busy = 0;   ///< dropped: send queue full
  long num_send_down = 0;   ///< dropped: bus not up
  long num_received = 0;    ///< frames of the protocol
  long num_unreadable = 0;  ///< frames that the protocol does not have, or too short
  long num_error_frames = 0;
  long num_bus_off = 0;
  long num_foreign_commands = 0;    ///< of another driver on the same bus
  uint32_t foreign_command_id = 0;  ///< of the last of them
};

/// Talks to the chassis: commands out, feedback in, and what becomes of the bus meanwhile.
class ChassisLink {
 public:
  explicit ChassisLink(std::unique_ptr<CanBus> bus);

  /// The identifiers that the chassis speaks with, and those of commands, for OpenCanBus. What goes
  /// out by the same end does not come back.
  static CanFilters Filters();

  /// What came since the last call, oldest first. Reads a bounded number of frames, so that a flood
  /// cannot hold the caller up.
  std::vector<ChassisFeedback> Receive();

  /// Sends the motion, and before it a request for CAN mode where the chassis is in another one (at
  /// most every 0.2 s, and at once when the mode changes), and the lamp's state when it changes and
  /// every 0.5 s while it is on. Nothing where the command may not speak. No speed and no turn rate
  /// above the limits goes out, whatever the command says.
  void Send(double now_s, const DriveCommand& command);

  /// A motion of zero, then standby, where anything was ever sent.
  void SendFarewell();
  void SendClearErrors() { SendFrame(EncodeFrame(ClearErrorsCommand{})); }

  /// Whether commands get through: the bus is up, takes frames, and its queue is not stuck.
  bool IsBusUp() const;
  CanBusState BusState() const { return bus_->State(); }
  std::optional<GuardStop> StandingStop() const { return bus_->StandingStop(); }
  void ReleaseGuard() { bus_->ReleaseGuard(); }
  const ChassisReadings& Readings() const { return readings_; }
  const ChassisTraffic& Traffic() const { return traffic_; }

 private:
  CanSendStatus SendFrame(const CanFrame& frame);
  void RequestCanMode(double now_s);
  void SendLamp(double now_s, bool is_on);
  void Keep(const ChassisFeedback& feedback);

  std::unique_ptr<CanBus> bus_;
  ChassisReadings readings_;
  ChassisTraffic traffic_;
  CanSendStatus last_send_ = CanSendStatus::kSent;
  int num_busy_in_a_row_ = 0;
  bool has_spoken_ = false;
  bool was_bus_lost_ = false;
  bool is_lamp_on_ = false;
  double lamp_sent_s_ = 0;
  uint8_t num_lamp_frames_ = 0;
  std::optional<double> mode_requested_s_;
  std::optional<ControlMode> mode_at_request_;
};

}  // namespace arfm_vo
