#include <cmath>

#include "arfm_vo/hardware/chassis_driver.h"
#include "arfm_vo/hardware/guard/chassis_guard.h"
#include "arfm_vo/hardware/image_conversion.h"
#include "arfm_vo/hardware/pan_tilt_unit.h"
#include "fuzz/byte_source.h"
#include "fuzz/fuzz_targets.h"
#include "fuzz/promise.h"
#include "hardware/simulated_line.h"
#include "simulation/can_memory_bus.h"

namespace arfm_vo {
namespace {

constexpr uint32_t kProtocolIds[] = {0x111, 0x121, 0x211, 0x221, 0x251, 0x252,
                                     0x261, 0x262, 0x311, 0x361, 0x421, 0x441};

CanFrame TakeFrame(ByteSource& bytes) {
  CanFrame frame;
  const uint8_t kind = bytes.Byte();
  frame.kind = kind < 200 ? CanFrameKind::kData : static_cast<CanFrameKind>(kind % 5);
  const uint8_t id = bytes.Byte();
  frame.id = id < 200 ? kProtocolIds[id % std::size(kProtocolIds)] : bytes.Raw<uint32_t>();
  const uint8_t dlc = bytes.Byte();
  frame.dlc = dlc < 200 ? 8 : dlc;
  for (uint8_t& byte : frame.bytes) byte = bytes.Byte();
  return frame;
}

/// What is understood of a command survives being sent again.
void CheckRoundTrip(const CanFrame& frame) {
  const ChassisCommand command = DecodeCommand(frame);
  const auto* motion = std::get_if<MotionCommand>(&command);
  if (!motion) return;
  const ChassisCommand back = DecodeCommand(EncodeFrame(*motion));
  const auto* again = std::get_if<MotionCommand>(&back);
  Promise(again && std::abs(again->motion.forward_mps - motion->motion.forward_mps) < 1e-9 &&
              std::abs(again->motion.turn_radps - motion->motion.turn_radps) < 1e-9,
          "a motion command survives the round trip");
}

/// A chassis that says anything at all, and a rover that was told to drive.
void Drive(const std::string& input) {
  ByteSource bytes(input);
  CanMemoryBus bus;
  const auto chassis = bus.OpenEnd();
  PilotOptions options;
  options.operator_watch.is_required = false;
  options.velocity_needs_pose = false;
  ChassisDriver driver(options, bus.OpenEnd());
  for (double now_s = 10; !bytes.IsEmpty(); now_s += 0.02) {
    const uint8_t action = bytes.Byte();
    if (action % 8 == 0) driver.pilot().Start(now_s);
    if (action % 8 <= 3) driver.pilot().SetVelocity(now_s, {0.1, 0.1});
    for (int i = 0; i < action / 64; ++i) {
      const CanFrame frame = TakeFrame(bytes);
      CheckRoundTrip(frame);
      chassis->Send(frame);
    }
    driver.Tick(now_s);
    while (const auto frame = chassis->Receive()) {
      const ChassisCommand command = DecodeCommand(*frame);
      if (const auto* motion = std::get_if<MotionCommand>(&command))
        Promise(std::abs(motion->motion.forward_mps) <= kMaxSpeed_mps &&
                    std::abs(motion->motion.turn_radps) <= 0.35,
                "no speed above the limits");
    }
  }
}

/// A message of a chassis_node to its guard, or what else may come by the socket.
std::optional<GuardMessage> TakeMessage(ByteSource& bytes, double now_s, uint32_t& number) {
  const uint8_t kind = bytes.Byte();
  if (kind >= 250) {
    const std::string any = bytes.Bytes(2 * sizeof(GuardMessage));
    return ReadGuardMessage(any.data(), any.size());
  }
  GuardMessage message;
  message.number = kind < 200 ? ++number : bytes.Value<uint32_t>();
  message.sent_s = kind % 8 != 0 ? now_s : now_s + bytes.Value<double>();
  message.num_stops = bytes.Byte() % 4;
  message.frame = TakeFrame(bytes);
  std::string coded(reinterpret_cast<const char*>(&message), sizeof(message));
  if (kind % 16 == 1) coded[bytes.Byte() % coded.size()] = static_cast<char>(bytes.Byte());
  return ReadGuardMessage(coded.data(), coded.size());
}

/// A chassis_node, a chassis and a stranger on the bus who say anything at all.
void Guard(const std::string& input) {
  ByteSource bytes(input);
  CanMemoryBus bus;
  const auto chassis = bus.OpenEnd();
  ChassisGuard guard(bus.OpenEnd(), [](GuardStop) {});
  double now_s = 1000;
  uint32_t number = 0, newest = 0;
  bool is_silent = true;  // nothing was commanded yet
  const auto check = [&](bool may_move) {
    while (const auto frame = chassis->Receive()) {
      const ChassisCommand command = DecodeCommand(*frame);
      Promise(frame->kind != CanFrameKind::kData || command.index() != 0 ||
                  frame->id == kBrakeCommandId,
              "only commands go out");
      const auto* motion = std::get_if<MotionCommand>(&command);
      if (!motion) continue;
      Promise(!is_silent, "no motion before the first command");
      Promise(may_move || motion->motion.IsZero(), "what moves is fresh, new and not stopped");
      Promise(std::abs(motion->motion.forward_mps) <= kMaxSpeed_mps + 1e-9 &&
                  std::abs(motion->motion.turn_radps) <= 0.35 + 1e-9,
              "no speed above the limits");
    }
  };
  while (!bytes.IsEmpty()) {
    const uint8_t action = bytes.Byte();
    if (action % 8 < 4) {
      const auto message = TakeMessage(bytes, now_s, number);
      if (!message) continue;
      const double age_s = now_s - message->sent_s;
      const bool is_fresh = message->number > newest && age_s >= 0 && age_s <= 0.1;
      const ChassisCommand command = DecodeCommand(message->frame);
      if (is_fresh) newest = message->number;
      if (is_fresh && std::holds_alternative<MotionCommand>(command)) is_silent = false;
      guard.Take(now_s, *message);
      check(is_fresh);
    } else if (action % 8 == 4) {
      chassis->Send(TakeFrame(bytes));
    } else if (action % 8 == 5 && action < 64) {
      guard.Stop(GuardStop::kPacket);
      is_silent = false;
      guard.Tick(now_s);
      check(false);
      GuardMessage wrong_release;
      wrong_release.number = number = ++newest;
      wrong_release.sent_s = now_s;
      wrong_release.num_stops = 999;
      wrong_release.frame = EncodeFrame(MotionCommand{{0.1, 0}});
      guard.Take(now_s, wrong_release);
      check(false);
    } else if (action % 8 == 6 && action < 32) {
      guard.Disconnect();
      number = newest = 0;
    }
    now_s += 0.001 * (action / 8);
    Promise(guard.Tick(now_s).size() <= 501, "the chassis_node is told a bounded number of things");
    check(false);
  }
}

/// What becomes of a reply on a line that disturbs it.
std::string Disturb(const std::string& reply, ByteSource& bytes) {
  if (reply.empty() || bytes.IsEmpty()) return reply;
  switch (bytes.Byte() % 16) {
    case 0:
      return "";
    case 1:
      return reply + reply;
    case 2:
      return reply.substr(0, bytes.Below(static_cast<uint32_t>(reply.size())));
    case 3:
      return bytes.Bytes(40);
    case 4:
      return bytes.Bytes(40) + reply;
    case 5: {
      std::string garbled = reply;
      garbled[bytes.Below(static_cast<uint32_t>(reply.size()))] = static_cast<char>(bytes.Byte());
      return garbled;
    }
    default:
      return reply;
  }
}

void UsePanTilt(const std::string& input) {
  ByteSource bytes(input);
  SimulatedBench bench(SimulatedPtuOptions::Instant());
  bench.disturb = [&](const std::string& reply) { return Disturb(reply, bytes); };
  PanTiltUnit unit(std::make_unique<SimulatedLine>(bench), 0.1);
  for (int attempt = 0; attempt < 4 && !unit.Connect(); ++attempt) {
  }
  for (int i = 0; i < 100 && !bytes.IsEmpty(); ++i) {
    const uint8_t action = bytes.Byte();
    const PtuAxis axis = action & 1 ? PtuAxis::kPan : PtuAxis::kTilt;
    if (action % 16 < 8) {
      const auto reading = unit.ReadPosition(axis);
      Promise(!reading || std::isfinite(reading->position_rad), "positions are finite");
    } else if (action % 16 < 12) {
      unit.MoveTo(axis, bytes.Value<double>());
    } else if (action % 16 < 14) {
      unit.SetSpeed(axis, bytes.Value<double>());
    } else if (action % 16 == 14) {
      unit.StartHoming();
      unit.PollHoming();
    } else {
      unit.Connect();
    }
  }
}

/// A frame of a video device, all of whose sizes the driver tells.
void ConvertVideo(const std::string& input) {
  ByteSource bytes(input);
  constexpr const char* kFormats[] = {"GREY", "NV12", "YU12", "YUYV", "UYVY", "Y10 ",
                                      "Y12 ", "Y16 ", "RGGB", "BA81", "GRBG", "GBRG",
                                      "BGR3", "RGB3", "MJPG", "JPEG"};
  VideoFormat format;
  format.fourcc = ParseFourcc(kFormats[bytes.Byte() % std::size(kFormats)]);
  format.width = bytes.Value<int8_t>();
  format.height = bytes.Value<int8_t>();
  format.bytes_per_line = bytes.Value<int16_t>();
  const std::string data = bytes.Rest();
  Takes([&] {
    const auto grey = ToGrey(data.data(), data.size(), format);
    Promise(!grey || (grey->type() == CV_8UC1 && grey->cols == format.width &&
                      grey->rows == format.height),
            "a frame has its size");
  });
}

}  // namespace

std::vector<FuzzTarget> HardwareTargets() {
  return {{"can", Drive}, {"guard", Guard}, {"ptu", UsePanTilt}, {"video", ConvertVideo}};
}

}  // namespace arfm_vo
