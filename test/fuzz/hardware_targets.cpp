#include <cmath>

#include "arfm_vo/hardware/can_memory_bus.h"
#include "arfm_vo/hardware/chassis_driver.h"
#include "arfm_vo/hardware/image_conversion.h"
#include "arfm_vo/hardware/pan_tilt_unit.h"
#include "fuzz/byte_source.h"
#include "fuzz/fuzz_targets.h"
#include "fuzz/promise.h"
#include "hardware/simulated_line.h"

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
  return {{"can", Drive}, {"ptu", UsePanTilt}, {"video", ConvertVideo}};
}

}  // namespace arfm_vo
