#include "simulation/can_memory_bus.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

const CanFrame kMemoryFrame = MakeCanFrame(0x111, {0, 100, 0, 0, 0, 0, 0, 0});

TEST(CanMemoryBus, AFrameReachesAllOtherEndsInOrder) {
  CanMemoryBus bus;
  const auto a = bus.OpenEnd(), b = bus.OpenEnd(), c = bus.OpenEnd();
  EXPECT_EQ(a->Send(kMemoryFrame), CanSendStatus::kSent);
  EXPECT_EQ(a->Send(MakeCanFrame(0x421, {1})), CanSendStatus::kSent);
  for (const auto* end : {&b, &c}) {
    EXPECT_EQ((*end)->Receive(), kMemoryFrame);
    EXPECT_EQ((*end)->Receive()->id, 0x421u);
    EXPECT_FALSE((*end)->Receive());
  }
  EXPECT_FALSE(a->Receive());
}

TEST(CanMemoryBus, FramesAreLostWhileTheInterfaceIsDown) {
  CanMemoryBus bus;
  const auto a = bus.OpenEnd(), b = bus.OpenEnd();
  bus.SetState(CanBusState::kDown);
  EXPECT_EQ(a->Send(kMemoryFrame), CanSendStatus::kDown);
  EXPECT_EQ(a->State(), CanBusState::kDown);
  bus.SetState(CanBusState::kUp);
  EXPECT_FALSE(b->Receive());
  EXPECT_EQ(a->Send(kMemoryFrame), CanSendStatus::kSent);
  EXPECT_TRUE(b->Receive());
}

TEST(CanMemoryBus, BusOffAndRestartAreToldByErrorFrames) {
  CanMemoryBus bus;
  const auto a = bus.OpenEnd();
  bus.SetState(CanBusState::kBusOff);
  EXPECT_EQ(a->Receive()->kind, CanFrameKind::kBusOff);
  EXPECT_EQ(a->Send(kMemoryFrame), CanSendStatus::kDown);
  bus.SetState(CanBusState::kUp);
  EXPECT_EQ(a->Receive()->kind, CanFrameKind::kRestarted);
  EXPECT_EQ(a->Send(kMemoryFrame), CanSendStatus::kSent);
}

TEST(CanMemoryBus, AFullQueueRefusesTheFrame) {
  CanMemoryBus bus;
  const auto a = bus.OpenEnd(), b = bus.OpenEnd();
  bus.SetBusy(true);
  EXPECT_EQ(a->Send(kMemoryFrame), CanSendStatus::kBusy);
  EXPECT_FALSE(b->Receive());
}

TEST(CanMemoryBus, AnEndMayGoBeforeTheOther) {
  CanMemoryBus bus;
  const auto a = bus.OpenEnd();
  bus.OpenEnd().reset();
  EXPECT_EQ(a->Send(kMemoryFrame), CanSendStatus::kSent);
}

TEST(CanFrame, IsWrittenAsCanDumpDoes) {
  EXPECT_EQ(ToString(kMemoryFrame), "111#0064000000000000");
  EXPECT_EQ(ToString(MakeCanFrame(0x7, {})), "007#");
}

TEST(CanFrame, HoldsAtMostEightBytes) {
  EXPECT_THROW(MakeCanFrame(1, {0, 1, 2, 3, 4, 5, 6, 7, 8}), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
