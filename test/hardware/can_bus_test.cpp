#include "arfm_vo/hardware/can_bus.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>

#include <system_error>

#include "arfm_vo/hardware/file_descriptor.h"
#include "base/refusal.h"
#include "hardware/await_frame.h"

namespace arfm_vo {
namespace {

const CanFrame kUdpFrame = MakeCanFrame(0x111, {0, 100, 0xFF, 0x9C, 0, 0, 0, 1});

struct LoopbackSocket {
  FileDescriptor fd{::socket(AF_INET, SOCK_DGRAM, 0)};
  sockaddr_in address{};

  /// Of a free port where it is 0.
  explicit LoopbackSocket(uint16_t port = 0) {
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ::bind(fd.Get(), reinterpret_cast<sockaddr*>(&address), sizeof(address));
    socklen_t size = sizeof(address);
    ::getsockname(fd.Get(), reinterpret_cast<sockaddr*>(&address), &size);
  }
  uint16_t Port() const { return ntohs(address.sin_port); }
  void SendTo(uint16_t port, size_t size) const {
    sockaddr_in to = address;
    to.sin_port = htons(port);
    const std::vector<char> bytes(size, 'x');
    ASSERT_GT(
        ::sendto(fd.Get(), bytes.data(), size, 0, reinterpret_cast<sockaddr*>(&to), sizeof(to)), 0);
  }
};

uint16_t FreePort() { return LoopbackSocket().Port(); }

std::string Address(uint16_t local, uint16_t peer) {
  return "udp:" + std::to_string(local) + ":" + std::to_string(peer);
}

class CanUdpBusTest : public ::testing::Test {
 protected:
  const uint16_t port_a_ = FreePort(), port_b_ = FreePort();
};

TEST_F(CanUdpBusTest, FramesArriveByteForByteInOrder) {
  const auto a = OpenCanBus(Address(port_a_, port_b_)), b = OpenCanBus(Address(port_b_, port_a_));
  EXPECT_FALSE(b->Receive());
  EXPECT_EQ(a->Send(kUdpFrame), CanSendStatus::kSent);
  EXPECT_EQ(a->Send(MakeCanFrame(0x421, {1})), CanSendStatus::kSent);
  EXPECT_EQ(AwaitFrame(*b), kUdpFrame);
  EXPECT_EQ(AwaitFrame(*b), MakeCanFrame(0x421, {1}));
  EXPECT_FALSE(b->Receive());
}

TEST_F(CanUdpBusTest, WhereNobodyListensFramesAreRefused) {
  const auto a = OpenCanBus(Address(port_a_, port_b_));
  a->Send(kUdpFrame);
  EXPECT_EQ(a->Send(kUdpFrame), CanSendStatus::kBusy);
}

TEST_F(CanUdpBusTest, TheOtherEndMayComeBack) {
  const auto a = OpenCanBus(Address(port_a_, port_b_));
  for (int i = 0; i < 3; ++i) a->Send(kUdpFrame);
  const auto b = OpenCanBus(Address(port_b_, port_a_));
  a->Send(kUdpFrame);
  EXPECT_EQ(a->Send(kUdpFrame), CanSendStatus::kSent);
  EXPECT_EQ(AwaitFrame(*b), kUdpFrame);
}

TEST_F(CanUdpBusTest, StrangersAreNotHeardAndDatagramsOfAWrongSizeAreOther) {
  const auto a = OpenCanBus(Address(port_a_, port_b_));
  const LoopbackSocket stranger, peer(port_b_);
  for (const size_t size : {size_t{3}, size_t{64}}) {
    stranger.SendTo(port_a_, size);
    EXPECT_FALSE(a->Receive());
    peer.SendTo(port_a_, size);
    EXPECT_EQ(AwaitFrame(*a).kind, CanFrameKind::kOther) << size;
  }
}

TEST_F(CanUdpBusTest, ATakenPortIsAnError) {
  const auto a = OpenCanBus(Address(port_a_, port_b_));
  EXPECT_THROW(OpenCanBus(Address(port_a_, port_b_)), std::system_error);
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

TEST(CanFrame, HoldsEightBytesAndIsWrittenAsCanDumpDoes) {
  EXPECT_EQ(ToString(MakeCanFrame(0x111, {0, 100, 0, 0, 0, 0, 0, 0})), "111#0064000000000000");
  EXPECT_EQ(ToString(MakeCanFrame(0x7, {})), "007#");
  EXPECT_THROW(MakeCanFrame(1, {0, 1, 2, 3, 4, 5, 6, 7, 8}), std::invalid_argument);
}

TEST(CanBusState, EachHasANameOfItsOwn) {
  EXPECT_STREQ(ToString(CanBusState::kUp), "up");
  EXPECT_STREQ(ToString(CanBusState::kBusOff), "bus-off");
  EXPECT_STREQ(ToString(CanBusState::kDown), "down");
}

}  // namespace
}  // namespace arfm_vo
