#include "arfm_vo/hardware/can_bus.h"

#include <gtest/gtest.h>

#include <system_error>

#include "base/refusal.h"
#include "hardware/await_frame.h"
#include "hardware/guard/loopback_socket.h"

namespace arfm_vo {
namespace {

const CanFrame kUdpFrame = MakeCanFrame(0x111, {0, 100, 0xFF, 0x9C, 0, 0, 0, 1});

class CanUdpBusTest : public ::testing::Test {
 protected:
  const uint16_t port_a_ = FreePort(), port_b_ = FreePort();
};

TEST_F(CanUdpBusTest, FramesArriveByteForByteInOrder) {
  const auto a = OpenCanBus(UdpAddress(port_a_, port_b_)),
             b = OpenCanBus(UdpAddress(port_b_, port_a_));
  EXPECT_FALSE(b->Receive());
  EXPECT_EQ(a->Send(kUdpFrame), CanSendStatus::kSent);
  EXPECT_EQ(a->Send(MakeCanFrame(0x421, {1})), CanSendStatus::kSent);
  EXPECT_EQ(AwaitFrame(*b), kUdpFrame);
  EXPECT_EQ(AwaitFrame(*b), MakeCanFrame(0x421, {1}));
  EXPECT_FALSE(b->Receive());
}

TEST_F(CanUdpBusTest, WhereNobodyListensFramesAreRefused) {
  const auto a = OpenCanBus(UdpAddress(port_a_, port_b_));
  a->Send(kUdpFrame);
  EXPECT_EQ(a->Send(kUdpFrame), CanSendStatus::kBusy);
}

TEST_F(CanUdpBusTest, TheOtherEndMayComeBack) {
  const auto a = OpenCanBus(UdpAddress(port_a_, port_b_));
  for (int i = 0; i < 3; ++i) a->Send(kUdpFrame);
  const auto b = OpenCanBus(UdpAddress(port_b_, port_a_));
  a->Send(kUdpFrame);
  EXPECT_EQ(a->Send(kUdpFrame), CanSendStatus::kSent);
  EXPECT_EQ(AwaitFrame(*b), kUdpFrame);
}

TEST_F(CanUdpBusTest, StrangersAreNotHeardAndDatagramsOfAWrongSizeAreOther) {
  const auto a = OpenCanBus(UdpAddress(port_a_, port_b_));
  const LoopbackSocket stranger, peer(port_b_);
  for (const int size : {3, 64}) {
    ASSERT_TRUE(stranger.SendTo(port_a_, std::string(size, 'x')));
    EXPECT_FALSE(a->Receive());
    ASSERT_TRUE(peer.SendTo(port_a_, std::string(size, 'x')));
    EXPECT_EQ(AwaitFrame(*a).kind, CanFrameKind::kOther) << size;
  }
}

TEST_F(CanUdpBusTest, ATakenPortIsAnError) {
  const auto a = OpenCanBus(UdpAddress(port_a_, port_b_));
  EXPECT_THROW(OpenCanBus(UdpAddress(port_a_, port_b_)), std::system_error);
}

TEST(CanAddress, IsAnInterfaceOrTwoPorts) {
  for (const char* address :
       {"", "udp:1", "udp:1:", "udp:0:5", "udp:1:70000", "can 0", "an_interface_name_too_long"}) {
    EXPECT_THROW(OpenCanBus(address), std::invalid_argument) << address;
  }
}

TEST(CanAddress, AnInterfaceThatIsNotThereIsNamedInTheError) {
  EXPECT_THAT(RefusalOf<std::system_error>([] { OpenCanBus("nocan7"); }),
              testing::HasSubstr("nocan7"));
}

}  // namespace
}  // namespace arfm_vo
