#include "arfm_vo/hardware/chassis_protocol.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace arfm_vo {
namespace {

constexpr uint32_t kMotionCommandId = 0x111;
constexpr uint32_t kLightCommandId = 0x121;
constexpr uint32_t kSystemStateId = 0x211;
constexpr uint32_t kMotionStateId = 0x221;
constexpr uint32_t kMotorStateId = 0x251;
constexpr uint32_t kMotorDriverStateId = 0x261;
constexpr uint32_t kTrackOdometerId = 0x311;
constexpr uint32_t kBatteryId = 0x361;
constexpr uint32_t kControlModeId = 0x421;
constexpr uint32_t kClearErrorsId = 0x441;

/// `value / step` rounded and cut off at the limits of Integer; NaN gives 0.
template <class Integer>
Integer Saturate(double value, double step = 1) {
  const double scaled = std::round(value / step);
  if (std::isnan(scaled)) return 0;
  return static_cast<Integer>(std::clamp<double>(scaled, std::numeric_limits<Integer>::min(),
                                                 std::numeric_limits<Integer>::max()));
}

/// Big-endian fields of 1, 2 or 4 bytes one after another.
class FieldWriter {
 public:
  explicit FieldWriter(uint32_t id) { frame_.id = id; }
  template <class Integer>
  FieldWriter& Put(Integer value) {
    const uint32_t bits = static_cast<std::make_unsigned_t<Integer>>(value);
    for (int shift = 8 * (static_cast<int>(sizeof(Integer)) - 1); shift >= 0; shift -= 8)
      frame_.bytes[frame_.dlc++] = static_cast<uint8_t>(bits >> shift);
    return *this;
  }
  /// The frame, filled up with zeros to `dlc` bytes.
  CanFrame Finish(uint8_t dlc) {
    frame_.dlc = dlc;
    return frame_;
  }

 private:
  CanFrame frame_;
};

class FieldReader {
 public:
  explicit FieldReader(const CanFrame& frame) : frame_(frame) {}
  template <class Integer>
  Integer Get() {
    uint32_t bits = 0;
    for (size_t i = 0; i < sizeof(Integer); ++i) bits = bits << 8 | frame_.bytes[next_++];
    return static_cast<Integer>(bits);
  }

 private:
  const CanFrame& frame_;
  int next_ = 0;
};

bool HoldsFields(const CanFrame& frame, uint8_t num_bytes) {
  return frame.dlc >= num_bytes && frame.dlc <= frame.bytes.size();
}

PlanarMotion ReadMotion(const CanFrame& frame) {
  FieldReader fields(frame);
  const double forward_mps = fields.Get<int16_t>() * 0.001;
  return {forward_mps, fields.Get<int16_t>() * 0.001};
}

CanFrame WriteMotion(uint32_t id, const PlanarMotion& motion) {
  return FieldWriter(id)
      .Put(Saturate<int16_t>(motion.forward_mps, 0.001))
      .Put(Saturate<int16_t>(motion.turn_radps, 0.001))
      .Finish(8);
}

ControlMode ReadMode(uint8_t value) {
  return value <= 3 ? static_cast<ControlMode>(value) : ControlMode::kUnknown;
}

SystemState ReadSystemState(const CanFrame& frame) {
  FieldReader fields(frame);
  SystemState state;
  const auto vehicle = fields.Get<uint8_t>();
  state.vehicle = vehicle <= 1 ? static_cast<VehicleState>(vehicle) : VehicleState::kFault;
  state.mode = ReadMode(fields.Get<uint8_t>());
  state.battery_v = fields.Get<uint16_t>() * 0.1;
  state.error_bits = fields.Get<uint16_t>();
  fields.Get<uint8_t>();  // reserved
  state.count = fields.Get<uint8_t>();
  return state;
}

MotorState ReadMotorState(const CanFrame& frame) {
  FieldReader fields(frame);
  MotorState state;
  state.side = static_cast<ChassisSide>(frame.id - kMotorStateId);
  state.speed_rpm = fields.Get<int16_t>();
  state.current_a = fields.Get<int16_t>() * 0.1;
  state.pulses = fields.Get<int32_t>();
  return state;
}

MotorDriverState ReadMotorDriverState(const CanFrame& frame) {
  FieldReader fields(frame);
  MotorDriverState state;
  state.side = static_cast<ChassisSide>(frame.id - kMotorDriverStateId);
  state.supply_v = fields.Get<uint16_t>() * 0.1;
  state.driver_celsius = fields.Get<int16_t>();
  // NOLINTNEXTLINE(bugprone-signed-char-misuse): degrees, below zero too
  state.motor_celsius = fields.Get<int8_t>();
  state.status_bits = fields.Get<uint8_t>();
  return state;
}

TrackOdometer ReadTrackOdometer(const CanFrame& frame) {
  FieldReader fields(frame);
  const auto left_mm = fields.Get<int32_t>();
  return {left_mm, fields.Get<int32_t>()};
}

BatteryState ReadBattery(const CanFrame& frame) {
  FieldReader fields(frame);
  BatteryState battery;
  battery.charge_percent = fields.Get<uint8_t>();
  battery.health_percent = fields.Get<uint8_t>();
  battery.voltage_v = fields.Get<uint16_t>() * 0.1;
  battery.current_a = fields.Get<int16_t>() * 0.1;
  battery.temperature_celsius = fields.Get<int16_t>() * 0.1;
  return battery;
}

}  // namespace

CanFrame EncodeFrame(const MotionCommand& command) {
  return WriteMotion(kMotionCommandId, command.motion);
}

CanFrame EncodeFrame(const ControlModeCommand& command) {
  return MakeCanFrame(kControlModeId, {static_cast<uint8_t>(command.mode)});
}

CanFrame EncodeFrame(const ClearErrorsCommand& command) {
  return MakeCanFrame(kClearErrorsId, {command.error});
}

CanFrame EncodeFrame(const LightCommand& command) {
  constexpr uint8_t kTakesCommands = 1;
  const uint8_t mode = command.is_on ? 1 : 0;
  return MakeCanFrame(kLightCommandId, {kTakesCommands, mode, 0, mode, 0, 0, 0, command.count});
}

CanFrame EncodeFrame(const SystemState& state) {
  return FieldWriter(kSystemStateId)
      .Put(static_cast<uint8_t>(state.vehicle))
      .Put(static_cast<uint8_t>(state.mode))
      .Put(Saturate<uint16_t>(state.battery_v, 0.1))
      .Put(state.error_bits)
      .Put<uint8_t>(0)
      .Put(state.count)
      .Finish(8);
}

CanFrame EncodeFrame(const MotionState& state) { return WriteMotion(kMotionStateId, state.motion); }

CanFrame EncodeFrame(const MotorState& state) {
  return FieldWriter(kMotorStateId + static_cast<uint32_t>(state.side))
      .Put(Saturate<int16_t>(state.speed_rpm))
      .Put(Saturate<int16_t>(state.current_a, 0.1))
      .Put(state.pulses)
      .Finish(8);
}

CanFrame EncodeFrame(const MotorDriverState& state) {
  return FieldWriter(kMotorDriverStateId + static_cast<uint32_t>(state.side))
      .Put(Saturate<uint16_t>(state.supply_v, 0.1))
      .Put(Saturate<int16_t>(state.driver_celsius))
      .Put(Saturate<int8_t>(state.motor_celsius))
      .Put(state.status_bits)
      .Finish(8);
}

CanFrame EncodeFrame(const TrackOdometer& odometer) {
  return FieldWriter(kTrackOdometerId).Put(odometer.left_mm).Put(odometer.right_mm).Finish(8);
}

CanFrame EncodeFrame(const BatteryState& battery) {
  return FieldWriter(kBatteryId)
      .Put(Saturate<uint8_t>(battery.charge_percent))
      .Put(Saturate<uint8_t>(battery.health_percent))
      .Put(Saturate<uint16_t>(battery.voltage_v, 0.1))
      .Put(Saturate<int16_t>(battery.current_a, 0.1))
      .Put(Saturate<int16_t>(battery.temperature_celsius, 0.1))
      .Finish(8);
}

ChassisFeedback DecodeFeedback(const CanFrame& frame) {
  if (frame.kind != CanFrameKind::kData) return {};
  switch (frame.id) {
    case kSystemStateId:
      if (HoldsFields(frame, 8)) return ReadSystemState(frame);
      break;
    case kMotionStateId:
      if (HoldsFields(frame, 4)) return MotionState{ReadMotion(frame)};
      break;
    case kMotorStateId:
    case kMotorStateId + 1:
      if (HoldsFields(frame, 8)) return ReadMotorState(frame);
      break;
    case kMotorDriverStateId:
    case kMotorDriverStateId + 1:
      if (HoldsFields(frame, 6)) return ReadMotorDriverState(frame);
      break;
    case kTrackOdometerId:
      if (HoldsFields(frame, 8)) return ReadTrackOdometer(frame);
      break;
    case kBatteryId:
      if (HoldsFields(frame, 8)) return ReadBattery(frame);
      break;
  }
  return {};
}

ChassisCommand DecodeCommand(const CanFrame& frame) {
  if (frame.kind != CanFrameKind::kData) return {};
  switch (frame.id) {
    case kMotionCommandId:
      if (HoldsFields(frame, 4)) return MotionCommand{ReadMotion(frame)};
      break;
    case kControlModeId:
      if (HoldsFields(frame, 1)) return ControlModeCommand{ReadMode(frame.bytes[0])};
      break;
    case kClearErrorsId:
      if (HoldsFields(frame, 1)) return ClearErrorsCommand{frame.bytes[0]};
      break;
    case kLightCommandId:
      if (HoldsFields(frame, 8)) return LightCommand{frame.bytes[1] != 0, frame.bytes[7]};
      break;
  }
  return {};
}

}  // namespace arfm_vo
