#include "arfm_vo/hardware/bus_lock.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <memory>
#include <system_error>

#include "base/refusal.h"

namespace arfm_vo {
namespace {

std::string BusOfThisTest() { return "test" + std::to_string(::getpid()); }

TEST(BusLock, ASecondDriverIsRefusedUntilTheFirstIsGone) {
  auto first = std::make_unique<BusLock>(BusOfThisTest());
  EXPECT_THAT(RefusalOf<std::system_error>([] { BusLock{BusOfThisTest()}; }),
              testing::AllOf(testing::HasSubstr("another driver has it"),
                             testing::HasSubstr(BusOfThisTest())));
  EXPECT_NO_THROW(BusLock{BusOfThisTest() + "b"});
  first.reset();
  EXPECT_NO_THROW(BusLock{BusOfThisTest()});
}

TEST(BusLock, AKilledDriverLeavesNoLockBehind) {
  const std::string bus = BusOfThisTest();
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const BusLock lock(bus);
    ::raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_NO_THROW(BusLock{bus});
}

TEST(IsSimulatedBus, OnlyUdpAndVirtualInterfacesAre) {
  EXPECT_TRUE(IsSimulatedBus("udp:1:2"));
  EXPECT_TRUE(IsSimulatedBus("vcan0"));
  EXPECT_FALSE(IsSimulatedBus("can0"));
  EXPECT_FALSE(IsSimulatedBus("slcan0"));
}

}  // namespace
}  // namespace arfm_vo
