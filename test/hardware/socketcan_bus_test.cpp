#include "arfm_vo/hardware/socketcan_bus.h"

#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "hardware/await_frame.h"

namespace arfm_vo {
namespace {

const CanFrame kFrame = MakeCanFrame(0x111, {0, 100, 0xFF, 0x9C, 0, 0, 0, 0});

bool RunsWell(const std::string& command) { return std::system(command.c_str()) == 0; }

/// Writes frames as any other program on the bus could, error frames included.
class RawSocket {
 public:
  RawSocket() : fd_(::socket(PF_CAN, SOCK_RAW, CAN_RAW)) {
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(::if_nametoindex("vcan0"));
    EXPECT_EQ(::bind(fd_.Get(), reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  }
  void Write(uint32_t id_with_flags, uint8_t dlc = 8) {
    can_frame raw{};
    raw.can_id = id_with_flags;
    raw.can_dlc = dlc;
    EXPECT_EQ(::write(fd_.Get(), &raw, sizeof(raw)), static_cast<ssize_t>(sizeof(raw)));
  }

 private:
  FileDescriptor fd_;
};

/// Needs the kernel's virtual CAN interface vcan0 and the right to change it, as the virtual
/// machine of scripts/test_hardware.sh has.
class SocketCanTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (::if_nametoindex("vcan0") == 0)
      GTEST_SKIP() << "there is no interface vcan0; scripts/test_hardware.sh runs this in a "
                      "virtual machine that has one";
    ASSERT_TRUE(RunsWell("ip link set vcan0 up"));
  }
};

TEST_F(SocketCanTest, FramesArriveByteForByte) {
  const auto a = OpenCanBus("vcan0"), b = OpenCanBus("vcan0");
  EXPECT_EQ(a->Send(kFrame), CanSendStatus::kSent);
  EXPECT_EQ(a->Send(MakeCanFrame(0x421, {1})), CanSendStatus::kSent);
  EXPECT_EQ(AwaitFrame(*b), kFrame);
  EXPECT_EQ(AwaitFrame(*b), MakeCanFrame(0x421, {1}));
  EXPECT_FALSE(b->Receive());
  EXPECT_FALSE(a->Receive());
}

TEST_F(SocketCanTest, OnlyStandardDataFramesPassTheFilter) {
  SocketCanBus bus("vcan0", {{0x200, 0x600}});
  RawSocket raw;
  for (const uint32_t id : {0x111u, 0x421u, 0x211u | CAN_RTR_FLAG, 0x211u | CAN_EFF_FLAG, 0x361u})
    raw.Write(id);
  EXPECT_EQ(AwaitFrame(bus).id, 0x361u);
  EXPECT_FALSE(bus.Receive());
}

TEST_F(SocketCanTest, WithoutAFilterRemoteAndExtendedFramesAreTold) {
  SocketCanBus bus("vcan0");
  RawSocket raw;
  raw.Write(0x211u | CAN_RTR_FLAG);
  raw.Write(0x211u | CAN_EFF_FLAG);
  raw.Write(0x211u, 3);
  EXPECT_EQ(AwaitFrame(bus).kind, CanFrameKind::kOther);
  EXPECT_EQ(AwaitFrame(bus).kind, CanFrameKind::kOther);
  const CanFrame frame = AwaitFrame(bus);
  EXPECT_EQ(frame.kind, CanFrameKind::kData);
  EXPECT_EQ(frame.dlc, 3);
}

TEST_F(SocketCanTest, AnInterfaceThatGoesDownAndUpIsSurvived) {
  SocketCanBus bus("vcan0");
  ASSERT_TRUE(RunsWell("ip link set vcan0 down"));
  EXPECT_FALSE(bus.Receive());
  EXPECT_EQ(bus.State(), CanBusState::kDown);
  EXPECT_EQ(bus.Send(kFrame), CanSendStatus::kDown);
  EXPECT_FALSE(bus.Receive());
  ASSERT_TRUE(RunsWell("ip link set vcan0 up"));
  EXPECT_EQ(bus.Send(kFrame), CanSendStatus::kSent);
  EXPECT_EQ(bus.State(), CanBusState::kUp);
}

TEST_F(SocketCanTest, SendingIsEnoughToNoticeThatTheInterfaceIsDown) {
  SocketCanBus bus("vcan0");
  ASSERT_TRUE(RunsWell("ip link set vcan0 down"));
  EXPECT_EQ(bus.Send(kFrame), CanSendStatus::kDown);
  EXPECT_EQ(bus.State(), CanBusState::kDown);
  ASSERT_TRUE(RunsWell("ip link set vcan0 up"));
}

TEST_F(SocketCanTest, AnInterfaceThatIsTakenAwayAndMadeAgainIsSurvived) {
  SocketCanBus bus("vcan0");
  ASSERT_TRUE(RunsWell("ip link del vcan0"));
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(bus.Receive());
    EXPECT_EQ(bus.Send(kFrame), CanSendStatus::kDown);
  }
  EXPECT_EQ(bus.State(), CanBusState::kDown);
  ASSERT_TRUE(RunsWell("ip link add vcan0 type vcan && ip link set vcan0 up"));
  EXPECT_EQ(bus.Send(kFrame), CanSendStatus::kSent);
  RawSocket().Write(0x211);
  EXPECT_EQ(AwaitFrame(bus).id, 0x211u);
}

TEST_F(SocketCanTest, AnInterfaceThatIsGoneIsLookedForWithoutModprobe) {
  // The kernel's modprobe is a script meanwhile, which leaves a file behind.
  const std::string script = ::testing::TempDir() + "noting_modprobe", note = script + "_ran";
  std::ofstream(script) << "#!/bin/sh\ntouch " << note << "\n";
  ASSERT_TRUE(RunsWell("chmod +x " + script + " && rm -f " + note));
  SocketCanBus bus("vcan0");
  ASSERT_TRUE(RunsWell("ip link del vcan0"));
  ASSERT_TRUE(RunsWell("echo " + script + " > /proc/sys/kernel/modprobe"));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(bus.Send(kFrame), CanSendStatus::kDown);
  EXPECT_FALSE(std::filesystem::exists(note));
  EXPECT_EQ(::if_nametoindex("vcan0"), 0u);
  EXPECT_TRUE(std::filesystem::exists(note)) << "this test would not notice it";
  ASSERT_TRUE(RunsWell("echo /sbin/modprobe > /proc/sys/kernel/modprobe"));
  ASSERT_TRUE(RunsWell("ip link add vcan0 type vcan && ip link set vcan0 up"));
}

TEST_F(SocketCanTest, NothingIsSentFromBusOffToRestart) {
  SocketCanBus bus("vcan0", {{0x200, 0x600}});
  SocketCanBus listener("vcan0", {{0x111, 0x7FF}});
  RawSocket raw;
  raw.Write(CAN_ERR_FLAG | CAN_ERR_BUSOFF);
  EXPECT_EQ(AwaitFrame(bus).kind, CanFrameKind::kBusOff);
  EXPECT_EQ(bus.State(), CanBusState::kBusOff);
  EXPECT_EQ(bus.Send(kFrame), CanSendStatus::kDown);
  while (const auto frame = listener.Receive()) EXPECT_NE(frame->kind, CanFrameKind::kData);
  raw.Write(CAN_ERR_FLAG | CAN_ERR_RESTARTED);
  EXPECT_EQ(AwaitFrame(bus).kind, CanFrameKind::kRestarted);
  EXPECT_EQ(bus.State(), CanBusState::kUp);
  EXPECT_EQ(bus.Send(kFrame), CanSendStatus::kSent);
}

TEST_F(SocketCanTest, AFrameFromTheChassisProvesThatTheBusIsBack) {
  SocketCanBus bus("vcan0", {{0x200, 0x600}});
  RawSocket raw;
  raw.Write(CAN_ERR_FLAG | CAN_ERR_BUSOFF);
  raw.Write(0x211);
  EXPECT_EQ(AwaitFrame(bus).kind, CanFrameKind::kBusOff);
  EXPECT_EQ(AwaitFrame(bus).id, 0x211u);
  EXPECT_EQ(bus.State(), CanBusState::kUp);
}

TEST_F(SocketCanTest, OtherErrorFramesDoNotStopTheBus) {
  SocketCanBus bus("vcan0");
  RawSocket().Write(CAN_ERR_FLAG | CAN_ERR_CRTL);
  EXPECT_EQ(AwaitFrame(bus).kind, CanFrameKind::kError);
  EXPECT_EQ(bus.State(), CanBusState::kUp);
}

TEST_F(SocketCanTest, AFloodOfOtherFramesDoesNotCoverTheChassis) {
  SocketCanBus bus("vcan0", {{0x200, 0x600}});
  RawSocket raw;
  for (int i = 0; i < 20000; ++i) raw.Write(0x7FF);
  raw.Write(0x211);
  EXPECT_EQ(AwaitFrame(bus).id, 0x211u);
  EXPECT_FALSE(bus.Receive());
}

TEST_F(SocketCanTest, TheSendQueueIsShort) {
  // A bus of 160 bit/s holds the frames back.
  if (!RunsWell("tc qdisc add dev vcan0 root tbf rate 160bit burst 80 limit 100000"))
    GTEST_SKIP() << "the kernel has no token bucket filter";
  SocketCanBus bus("vcan0");
  int num_sent = 0;
  while (num_sent < 100 && bus.Send(kFrame) == CanSendStatus::kSent) ++num_sent;
  EXPECT_EQ(bus.Send(kFrame), CanSendStatus::kBusy);
  EXPECT_LE(num_sent, 16);
  EXPECT_EQ(bus.State(), CanBusState::kUp);
  ASSERT_TRUE(RunsWell("tc qdisc del dev vcan0 root"));
}

}  // namespace
}  // namespace arfm_vo
