#pragma once

#include <array>
#include <cstdint>
#include <variant>

#include "arfm_vo/driving/planar_motion.h"
#include "arfm_vo/hardware/can_frame.h"

namespace arfm_vo {

// The AgileX Bunker's CAN protocol V2: standard frames, 500 kbit/s, big-endian fields. A number
// that does not fit its field is sent as the nearest one that does, NaN as 0.

enum class ControlMode : uint8_t { kStandby = 0, kCan = 1, kUart = 2, kRemote = 3, kUnknown = 255 };
enum class VehicleState : uint8_t { kOk = 0, kEmergencyStop = 1, kFault = 2 };
enum class ChassisSide : uint8_t { kLeft = 0, kRight = 1 };

/// Bits of SystemState::error_bits, by ugv_sdk (low byte) and a manual of the family (high byte).
constexpr uint16_t kBatteryWarning = 0x0202, kRemoteLost = 0x0404;
/// All other bits are faults.
constexpr uint16_t kErrorBitsNoFault = 0x0002 | kRemoteLost;

// To the chassis.

/// What commands the chassis: motion (0x111), brake, control mode.
constexpr std::array<uint32_t, 3> kCommandIds = {0x111, 0x131, 0x421};

/// 0x111: the wanted motion, in steps of 1 mm/s and 1 mrad/s. To be repeated every 20 ms: after 500
/// ms without it the chassis stops.
struct MotionCommand {
  PlanarMotion motion;
};
/// 0x421: who may command; in standby the chassis hears only this.
struct ControlModeCommand {
  ControlMode mode = ControlMode::kStandby;
};
/// 0x441: clears latched errors.
struct ClearErrorsCommand {
  uint8_t error = 0;  ///< 0: all
};

/// 0x121: the front lamp. The protocol is read in ugv_sdk (agilex_protocol_v2.h).
struct LightCommand {
  bool is_on = false;
  uint8_t count = 0;
};

// From the chassis.

/// 0x211, every 100 to 200 ms. A vehicle state that the protocol does not name reads as kFault,
/// such a mode as kUnknown.
struct SystemState {
  VehicleState vehicle = VehicleState::kOk;
  ControlMode mode = ControlMode::kStandby;
  double battery_v = 0;
  uint16_t error_bits = 0;
  uint8_t count = 0;
};
/// 0x221, every 20 ms: the motion that the chassis measures on its tracks.
struct MotionState {
  PlanarMotion motion;
};
/// 0x251 (left), 0x252 (right), every 20 ms.
struct MotorState {
  ChassisSide side = ChassisSide::kLeft;
  int speed_rpm = 0;
  double current_a = 0;
  int32_t pulses = 0;
};
/// Bits of MotorDriverState::status_bits that are faults: supply low, motor too hot, overload,
/// driver too hot, sensor, driver. Bit 6 says that the driver is enabled.
constexpr uint8_t kMotorFaultBits = 0x3F;

/// 0x261 (left), 0x262 (right).
struct MotorDriverState {
  ChassisSide side = ChassisSide::kLeft;
  double supply_v = 0;
  int driver_celsius = 0;
  int motor_celsius = 0;
  uint8_t status_bits = 0;
};
/// 0x311, every 20 ms: the way of each track since power-up; wraps around at +-2^31.
struct TrackOdometer {
  int32_t left_mm = 0;
  int32_t right_mm = 0;
};
/// 0x361.
struct BatteryState {
  int charge_percent = 0;
  int health_percent = 0;
  double voltage_v = 0;
  double current_a = 0;
  double temperature_celsius = 0;
};

using ChassisCommand = std::variant<std::monostate, MotionCommand, ControlModeCommand,
                                    ClearErrorsCommand, LightCommand>;
using ChassisFeedback = std::variant<std::monostate, SystemState, MotionState, MotorState,
                                     MotorDriverState, TrackOdometer, BatteryState>;

CanFrame EncodeFrame(const ChassisCommand& command);
CanFrame EncodeFrame(const ChassisFeedback& feedback);

/// What the chassis says in `frame`; monostate where the frame is not a data frame, has another
/// identifier, or is too short for its fields. Never reads past frame.dlc.
ChassisFeedback DecodeFeedback(const CanFrame& frame);

/// What `frame` tells the chassis to do; monostate as DecodeFeedback.
ChassisCommand DecodeCommand(const CanFrame& frame);

}  // namespace arfm_vo
