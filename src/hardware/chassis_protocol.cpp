#include "arfm_vo/hardware/chassis_protocol.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace arfm_vo {
namespace {

/// `value / step` rounded and cut off at the limits of Integer; NaN gives 0.
template <class Integer>
Integer Saturate(double value, double step = 1) {
  const double scaled = std::round(value / step);
  if (std::isnan(scaled)) return 0;
  return static_cast<Integer>(std::clamp<double>(scaled, std::numeric_limits<Integer>::min(),
                                                 std::numeric_limits<Integer>::max()));
}

/// Makes a frame of what List tells.
class FieldWriter {
 public:
  void Begin(uint32_t id) { frame_.id = id; }
  void Begin(uint32_t left_id, ChassisSide side) { Begin(left_id + static_cast<uint32_t>(side)); }
  template <class Raw, class Value>
  void operator()(const Value& value, Raw, double step = 1) {
    const uint32_t bits =
        static_cast<std::make_unsigned_t<Raw>>(Saturate<Raw>(static_cast<double>(value), step));
    for (int shift = 8 * (static_cast<int>(sizeof(Raw)) - 1); shift >= 0; shift -= 8)
      frame_.bytes[frame_.dlc++] = static_cast<uint8_t>(bits >> shift);
  }
  /// Filled up with zeros, but for a command of one byte.
  CanFrame Finish() {
    if (frame_.dlc > 1) frame_.dlc = 8;
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

/// Takes a frame for what List tells, as far as it is that and is not too short.
class FieldReader {
 public:
  explicit FieldReader(const CanFrame& frame) : frame_(frame) {}

  void Begin(uint32_t id) { is_whole_ = frame_.id == id && frame_.dlc <= frame_.bytes.size(); }
  void Begin(uint32_t left_id, ChassisSide& side) {
    side = frame_.id == left_id ? ChassisSide::kLeft : ChassisSide::kRight;
    Begin(left_id + static_cast<uint32_t>(side));
  }
  template <class Raw, class Value>
  void operator()(Value& value, Raw, double step = 1) {
    is_whole_ = is_whole_ && next_ + sizeof(Raw) <= frame_.dlc;
    if (!is_whole_) return;
    uint32_t bits = 0;
    for (size_t i = 0; i < sizeof(Raw); ++i) bits = bits << 8 | frame_.bytes[next_++];
    if constexpr (std::is_enum_v<Value>) {
      value = Known(static_cast<Value>(bits));
    } else {
      value = static_cast<Value>(static_cast<Raw>(bits) * step);
    }
  }
  bool IsWhole() const { return is_whole_; }

 private:
  const CanFrame& frame_;
  size_t next_ = 0;
  bool is_whole_ = false;
};

// Each frame: its identifier, and its big-endian fields one after another, of each the value, the
// integer that it goes as, and that one's unit.

template <class Fields>
void List(PlanarMotion& motion, Fields& fields) {
  fields(motion.forward_mps, int16_t(), 0.001);
  fields(motion.turn_radps, int16_t(), 0.001);
}

template <class Fields>
void List(MotionCommand& command, Fields& fields) {
  fields.Begin(0x111);
  List(command.motion, fields);
}

template <class Fields>
void List(ControlModeCommand& command, Fields& fields) {
  fields.Begin(0x421);
  fields(command.mode, uint8_t());
}

template <class Fields>
void List(ClearErrorsCommand& command, Fields& fields) {
  fields.Begin(0x441);
  fields(command.error, uint8_t());
}

template <class Fields>
void List(LightCommand& command, Fields& fields) {
  uint16_t takes_commands = 1, rear = command.is_on ? 1 : 0, reserved = 0;
  fields.Begin(0x121);
  fields(takes_commands, uint8_t());
  fields(command.is_on, uint8_t());
  fields(rear, uint16_t());
  fields(reserved, uint16_t());
  fields(reserved, uint8_t());
  fields(command.count, uint8_t());
}

template <class Fields>
void List(SystemState& state, Fields& fields) {
  uint8_t reserved = 0;
  fields.Begin(0x211);
  fields(state.vehicle, uint8_t());
  fields(state.mode, uint8_t());
  fields(state.battery_v, uint16_t(), 0.1);
  fields(state.error_bits, uint16_t());
  fields(reserved, uint8_t());
  fields(state.count, uint8_t());
}

template <class Fields>
void List(MotionState& state, Fields& fields) {
  fields.Begin(0x221);
  List(state.motion, fields);
}

template <class Fields>
void List(MotorState& state, Fields& fields) {
  fields.Begin(0x251, state.side);
  fields(state.speed_rpm, int16_t());
  fields(state.current_a, int16_t(), 0.1);
  fields(state.pulses, int32_t());
}

template <class Fields>
void List(MotorDriverState& state, Fields& fields) {
  fields.Begin(0x261, state.side);
  fields(state.supply_v, uint16_t(), 0.1);
  fields(state.driver_celsius, int16_t());
  fields(state.motor_celsius, int8_t());
  fields(state.status_bits, uint8_t());
}

template <class Fields>
void List(TrackOdometer& odometer, Fields& fields) {
  fields.Begin(0x311);
  fields(odometer.left_mm, int32_t());
  fields(odometer.right_mm, int32_t());
}

template <class Fields>
void List(BatteryState& battery, Fields& fields) {
  fields.Begin(0x361);
  fields(battery.charge_percent, uint8_t());
  fields(battery.health_percent, uint8_t());
  fields(battery.voltage_v, uint16_t(), 0.1);
  fields(battery.current_a, int16_t(), 0.1);
  fields(battery.temperature_celsius, int16_t(), 0.1);
}

template <class Fields>
void List(std::monostate&, Fields&) {}

template <class Message>
CanFrame Encode(const Message& message) {
  FieldWriter writer;
  std::visit([&](auto one) { List(one, writer); }, message);
  return writer.Finish();
}

template <class Message, class Messages>
bool Read(const CanFrame& frame, Messages& read) {
  FieldReader reader(frame);
  Message message;
  List(message, reader);
  if (reader.IsWhole()) read = message;
  return reader.IsWhole();
}

/// The one of the messages that the frame is.
template <class... Messages>
void Decode(const CanFrame& frame, std::variant<std::monostate, Messages...>& read) {
  if (frame.kind == CanFrameKind::kData) (Read<Messages>(frame, read) || ...);
}

}  // namespace

CanFrame EncodeFrame(const ChassisCommand& command) { return Encode(command); }
CanFrame EncodeFrame(const ChassisFeedback& feedback) { return Encode(feedback); }

ChassisFeedback DecodeFeedback(const CanFrame& frame) {
  ChassisFeedback feedback;
  Decode(frame, feedback);
  return feedback;
}

ChassisCommand DecodeCommand(const CanFrame& frame) {
  ChassisCommand command;
  Decode(frame, command);
  return command;
}

}  // namespace arfm_vo
