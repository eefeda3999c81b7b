#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "arfm_vo/base/random.h"
#include "arfm_vo/hardware/chassis_driver.h"
#include "simulation/can_memory_bus.h"

// A million frames of all kinds, identifiers, lengths and bytes, half of them of the protocol.

namespace arfm_vo {
namespace {

constexpr int kNumFrames = 500000;  // in each of two tests
const std::vector<uint32_t> kProtocolIds = {0x111, 0x121, 0x211, 0x221, 0x251, 0x252,
                                            0x261, 0x262, 0x311, 0x361, 0x421, 0x441};
/// What the chassis measures; whatever it holds, it moves nothing.
const std::vector<uint32_t> kMeasuredIds = {0x221, 0x251, 0x252, 0x311, 0x361};

class FrameSource {
 public:
  explicit FrameSource(int seed, std::vector<uint32_t> ids) : engine_(seed), ids_(std::move(ids)) {}

  CanFrame Next() {
    CanFrame frame;
    frame.kind = static_cast<CanFrameKind>(Draw(8) == 0 ? Draw(5) : 0);
    frame.id = Draw(2) == 0 ? ids_[Draw(static_cast<uint32_t>(ids_.size()))] : Draw(0x20000000);
    frame.dlc = static_cast<uint8_t>(Draw(10) == 0 ? Draw(256) : Draw(9));
    for (uint8_t& byte : frame.bytes) byte = static_cast<uint8_t>(Draw(256));
    return frame;
  }

 private:
  uint32_t Draw(uint32_t count) {
    return std::min(count - 1, static_cast<uint32_t>(RandomUnit(engine_) * count));
  }
  RandomEngine engine_;
  std::vector<uint32_t> ids_;
};

TEST(ChassisFuzz, NoFrameMovesARoverThatIsNotStarted) {
  CanMemoryBus bus;
  const auto other = bus.OpenEnd();
  ChassisDriver driver(PilotOptions{}, bus.OpenEnd());
  FrameSource source(1, kProtocolIds);
  for (int i = 0; i < kNumFrames; ++i) {
    other->Send(source.Next());
    if (i % 100 == 0) driver.Tick(10 + 0.0002 * i);
    ASSERT_FALSE(other->Receive()) << "frame " << i;
  }
}

TEST(ChassisFuzz, NoFrameMakesAStartedRoverExceedItsLimits) {
  CanMemoryBus bus;
  const auto other = bus.OpenEnd();
  PilotOptions options;
  options.operator_watch.is_required = false;
  options.velocity_needs_pose = false;
  ChassisDriver driver(options, bus.OpenEnd());
  FrameSource source(2, kMeasuredIds);
  int num_moving = 0;
  for (int i = 0; i < kNumFrames; ++i) {
    other->Send(source.Next());
    if (i % 20 != 0) continue;
    const double now_s = 10 + 0.001 * i;
    SystemState state;
    state.mode = ControlMode::kCan;
    state.count = static_cast<uint8_t>(i / 20);
    other->Send(EncodeFrame(state));
    driver.pilot().SetVelocity(now_s, {});  // no start while a velocity is commanded
    driver.pilot().Start(now_s);            // whenever a fuzzed frame has blocked it
    driver.pilot().SetVelocity(now_s, {0.1, 0});
    driver.Tick(now_s);
    while (const auto frame = other->Receive()) {
      const ChassisCommand command = DecodeCommand(*frame);
      const auto* motion = std::get_if<MotionCommand>(&command);
      if (!motion) continue;
      num_moving += !motion->motion.IsZero();
      ASSERT_LE(std::abs(motion->motion.forward_mps), kMaxSpeed_mps);
      ASSERT_LE(std::abs(motion->motion.turn_radps), 0.35);
    }
  }
  EXPECT_GT(num_moving, 0);
}

}  // namespace
}  // namespace arfm_vo
