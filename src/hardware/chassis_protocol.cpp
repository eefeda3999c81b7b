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

/// The big-endian fields of a frame one after another, for List.
class FieldWriter {
 public:
  explicit FieldWriter(uint32_t id) { frame_.id = id; }

  template <class Raw, class Value>
  void operator()(const Value& value, Raw, double step = 1) {
    const uint32_t bits =
        static_cast<std::make_unsigned_t<Raw>>(Saturate<Raw>(static_cast<double>(value), step));
    for (int shift = 8 * (static_cast<int>(sizeof(Raw)) - 1); shift >= 0; shift -= 8)
      frame_.bytes[frame_.dlc++] = static_cast<uint8_t>(bits >> shift);
  }
  /// Filled up with zeros.
  CanFrame Finish() {
    frame_.dlc = 8;
    return frame_;
  }

 private:
  CanFrame frame_;
};

VehicleState Known(VehicleState state) {
  return state <= VehicleState::kEmergencyStop ? state : VehicleState::kFault;
}
ControlMode Known(ControlMode mode) {
  return mode <= ControlMode::kRemote ? mode : ControlMode::kUnknown;
}

class FieldReader {
 public:
  explicit FieldReader(const CanFrame& frame) : frame_(frame) {}

  template <class Raw, class Value>
  void operator()(Value& value, Raw, double step = 1) {
    uint32_t bits = 0;
    for (size_t i = 0; i < sizeof(Raw); ++i) bits = bits << 8 | frame_.bytes[next_++];
    if constexpr (std::is_enum_v<Value>) {
      value = Known(static_cast<Value>(bits));
    } else {
      value = static_cast<Value>(static_cast<Raw>(bits) * step);
    }
  }

 private:
  const CanFrame& frame_;
  int next_ = 0;
};

// The fields of each frame: the value, the integer that it goes as, and that one's unit.

template <class Fields>
void List(PlanarMotion& motion, Fields& fields) {
  fields(motion.forward_mps, int16_t(), 0.001);
  fields(motion.turn_radps, int16_t(), 0.001);
}
template <class Fields>
void List(SystemState& state, Fields& fields) {
  uint8_t reserved = 0;
  fields(state.vehicle, uint8_t());
  fields(state.mode, uint8_t());
  fields(state.battery_v, uint16_t(), 0.1);
  fields(state.error_bits, uint16_t());
  fields(reserved, uint8_t());
  fields(state.count, uint8_t());
}
template <class Fields>
void List(MotorState& state, Fields& fields) {
  fields(state.speed_rpm, int16_t());
  fields(state.current_a, int16_t(), 0.1);
  fields(state.pulses, int32_t());
}
template <class Fields>
void List(MotorDriverState& state, Fields& fields) {
  fields(state.supply_v, uint16_t(), 0.1);
  fields(state.driver_celsius, int16_t());
  fields(state.motor_celsius, int8_t());
  fields(state.status_bits, uint8_t());
}
template <class Fields>
void List(TrackOdometer& odometer, Fields& fields) {
  fields(odometer.left_mm, int32_t());
  fields(odometer.right_mm, int32_t());
}
template <class Fields>
void List(BatteryState& battery, Fields& fields) {
  fields(battery.charge_percent, uint8_t());
  fields(battery.health_percent, uint8_t());
  fields(battery.voltage_v, uint16_t(), 0.1);
  fields(battery.current_a, int16_t(), 0.1);
  fields(battery.temperature_celsius, int16_t(), 0.1);
}

template <class State>
CanFrame Write(uint32_t id, State state) {
  FieldWriter fields(id);
  List(state, fields);
  return fields.Finish();
}

bool HoldsFields(const CanFrame& frame, uint8_t num_bytes) {
  return frame.dlc >= num_bytes && frame.dlc <= frame.bytes.size();
}

/// Reads `state` of the frame; false where this is too short for it.
template <class State>
bool Read(const CanFrame& frame, uint8_t num_bytes, State& state) {
  if (!HoldsFields(frame, num_bytes)) return false;
  FieldReader fields(frame);
  List(state, fields);
  return true;
}
template <class State>
ChassisFeedback ReadFeedback(const CanFrame& frame, uint8_t num_bytes, State state = {}) {
  return Read(frame, num_bytes, state) ? ChassisFeedback(state) : ChassisFeedback();
}

uint32_t Number(ChassisSide side) { return static_cast<uint32_t>(side); }
ChassisSide SideOf(const CanFrame& frame, uint32_t left_id) {
  return static_cast<ChassisSide>(frame.id - left_id);
}

}  // namespace

CanFrame EncodeFrame(const MotionCommand& command) {
  return Write(kMotionCommandId, command.motion);
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
CanFrame EncodeFrame(const SystemState& state) { return Write(kSystemStateId, state); }
CanFrame EncodeFrame(const MotionState& state) { return Write(kMotionStateId, state.motion); }
CanFrame EncodeFrame(const MotorState& state) {
  return Write(kMotorStateId + Number(state.side), state);
}
CanFrame EncodeFrame(const MotorDriverState& state) {
  return Write(kMotorDriverStateId + Number(state.side), state);
}
CanFrame EncodeFrame(const TrackOdometer& odometer) { return Write(kTrackOdometerId, odometer); }
CanFrame EncodeFrame(const BatteryState& battery) { return Write(kBatteryId, battery); }

ChassisFeedback DecodeFeedback(const CanFrame& frame) {
  if (frame.kind != CanFrameKind::kData) return {};
  switch (frame.id) {
    case kSystemStateId:
      return ReadFeedback<SystemState>(frame, 8);
    case kMotionStateId:
      if (PlanarMotion motion; Read(frame, 4, motion)) return MotionState{motion};
      return {};
    case kMotorStateId:
    case kMotorStateId + 1:
      return ReadFeedback(frame, 8, MotorState{SideOf(frame, kMotorStateId)});
    case kMotorDriverStateId:
    case kMotorDriverStateId + 1:
      return ReadFeedback(frame, 6, MotorDriverState{SideOf(frame, kMotorDriverStateId)});
    case kTrackOdometerId:
      return ReadFeedback<TrackOdometer>(frame, 8);
    case kBatteryId:
      return ReadFeedback<BatteryState>(frame, 8);
  }
  return {};
}

ChassisCommand DecodeCommand(const CanFrame& frame) {
  PlanarMotion motion;
  if (frame.kind != CanFrameKind::kData || !HoldsFields(frame, 1)) return {};
  switch (frame.id) {
    case kMotionCommandId:
      if (Read(frame, 4, motion)) return MotionCommand{motion};
      return {};
    case kControlModeId:
      return ControlModeCommand{Known(static_cast<ControlMode>(frame.bytes[0]))};
    case kClearErrorsId:
      return ClearErrorsCommand{frame.bytes[0]};
    case kLightCommandId:
      if (HoldsFields(frame, 8)) return LightCommand{frame.bytes[1] != 0, frame.bytes[7]};
  }
  return {};
}

}  // namespace arfm_vo
