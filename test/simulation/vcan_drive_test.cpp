#include <gtest/gtest.h>
#include <net/if.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <thread>

#include "arfm_vo/hardware/chassis_driver.h"
#include "arfm_vo/simulation/simulated_chassis.h"

// The chassis driver and the simulated chassis over the kernel's CAN, in real time. Needs vcan0 and
// the right to change it, as the virtual machine of scripts/test_hardware.sh has.

namespace arfm_vo {
namespace {

bool RunsWell(const std::string& command) { return std::system(command.c_str()) == 0; }

double Now() {
  using Seconds = std::chrono::duration<double>;
  return Seconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Notes every frame that goes through it.
class NotingBus : public CanBus {
 public:
  NotingBus(std::unique_ptr<CanBus> bus, std::vector<std::string>* notes)
      : bus_(std::move(bus)), notes_(notes) {}
  CanSendStatus Send(const CanFrame& frame) override {
    const CanSendStatus status = bus_->Send(frame);
    if (status == CanSendStatus::kSent) notes_->push_back(ToString(frame));
    return status;
  }
  std::optional<CanFrame> Receive() override { return bus_->Receive(); }
  CanBusState State() const override { return bus_->State(); }

 private:
  std::unique_ptr<CanBus> bus_;
  std::vector<std::string>* notes_;
};

/// A row of the table that scripts/test_hardware.sh collects.
void PrintRow(const std::string& fault, const std::string& stop, const std::string& remedy) {
  std::cout << "| " << fault << " | " << stop << " | " << remedy << " |\n";
}
std::string ToMilliseconds(double duration_s) {
  return std::to_string(std::lround(1000 * duration_s));
}

class VcanDriveTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (::if_nametoindex("vcan0") == 0)
      GTEST_SKIP() << "there is no interface vcan0; scripts/test_hardware.sh runs this in a "
                      "virtual machine that has one";
    ASSERT_TRUE(RunsWell("ip link set vcan0 up"));
    PilotOptions options;
    options.velocity_needs_pose = false;
    options.operator_watch.is_required = false;
    options.max_tick_gap_s = 60;  // an emulated machine on a busy one holds this process up
    driver_ = std::make_unique<ChassisDriver>(
        options, std::make_unique<NotingBus>(OpenCanBus("vcan0", ChassisLink::Filters()), &sent_));
    chassis_ = std::make_unique<SimulatedChassis>(OpenCanBus("vcan0", {{0x000, 0x200}}),
                                                  TrackedPlant({}, RoverPose{}));
  }

  template <class Done>
  bool RunUntil(double limit_s, Done&& done) {
    const double end_s = Now() + limit_s;
    for (int i = 0; Now() < end_s && !done(); ++i) {
      chassis_->Tick(Now());
      if (wants_velocity_) driver_->pilot().SetVelocity(Now(), {0.1, 0});
      if (i % 4 == 0) driver_->Tick(Now());
      if (StopSeconds() < 0 && driver_->pilot().Status().motion.IsZero()) stopped_s_ = Now();
      Sleep(0.005);
    }
    return done();
  }
  void Sleep(double duration_s) {
    const double wake_s = Now() + duration_s;
    std::this_thread::sleep_for(std::chrono::duration<double>(duration_s));
    overslept_s_ += Now() - wake_s;
  }
  void Run(double duration_s) {
    RunUntil(duration_s, [] { return false; });
  }
  /// Goes on driving while the command runs, as a driver does.
  void RunBeside(const std::string& command) {
    std::atomic<bool> is_done{false}, is_well{false};
    std::thread shell([&] {
      is_well = RunsWell(command);
      is_done = true;
    });
    RunUntil(60, [&] { return is_done.load(); });
    shell.join();
    EXPECT_TRUE(is_well) << command;
  }
  void StartDriving() {
    Run(0.3);
    ASSERT_TRUE(driver_->pilot().Start(Now()).is_accepted);
    wants_velocity_ = true;
    ASSERT_TRUE(RunUntil(5, [&] { return driver_->pilot().Status().motion.forward_mps > 0.09; }));
    ASSERT_TRUE(RunUntil(5, [&] { return chassis_->plant().Speeds().left_mps > 0.05; }));
  }
  /// A velocity that streams on would forbid it.
  void StartAgain() {
    wants_velocity_ = false;
    EXPECT_TRUE(RunUntil(5, [&] { return driver_->pilot().Start(Now()).is_accepted; }));
    wants_velocity_ = true;
    EXPECT_TRUE(RunUntil(5, [&] { return chassis_->plant().Speeds().left_mps > 0.05; }));
  }
  double StopSeconds() const { return stopped_s_; }
  StopReason Reason() const { return driver_->pilot().Status().reason; }

  std::vector<std::string> sent_;
  std::unique_ptr<ChassisDriver> driver_;
  std::unique_ptr<SimulatedChassis> chassis_;
  bool wants_velocity_ = false;
  double stopped_s_ = 0;
  double overslept_s_ = 0;  ///< what an emulated machine on a busy one took from this process
};

/// The frames with identifiers of commands in a log of `candump -L`, as ToString writes them.
std::vector<std::string> CommandsInLog(const std::string& path) {
  std::ifstream file(path);
  std::string time, interface, frame;
  std::vector<std::string> commands;
  while (file >> time >> interface >> frame)
    for (const char* command : {"111#", "121#", "421#"})
      if (frame.rfind(command, 0) == 0) commands.push_back(frame);
  return commands;
}

TEST_F(VcanDriveTest, CandumpSeesWhatTheDriverSendsByteForByte) {
  const std::string log =
      std::filesystem::temp_directory_path() / ("candump_" + std::to_string(::getpid()));
  std::ofstream{log};  // the shell may be slow to open it
  ASSERT_TRUE(RunsWell("candump -L vcan0 > " + log + " & echo $! > " + log + ".pid"));
  ASSERT_TRUE(RunUntil(20, [&] { return std::filesystem::file_size(log) > 0; }));
  StartDriving();
  Run(1);
  driver_.reset();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  ASSERT_TRUE(RunsWell("kill $(cat " + log + ".pid)"));
  const std::vector<std::string> seen = CommandsInLog(log);
  EXPECT_EQ(seen, sent_);
  ASSERT_GE(seen.size(), 20u);  // fewer than 50 a second where the machine is an emulated one
  EXPECT_EQ(seen[0], "421#01");
  EXPECT_EQ(seen[1], "111#0000000000000000");
  EXPECT_NE(std::find(seen.begin(), seen.end(), "111#0064000000000000"), seen.end());
  EXPECT_EQ(seen[seen.size() - 3], "111#0000000000000000");
  EXPECT_EQ(seen[seen.size() - 2], "421#00");
  EXPECT_EQ(seen.back().substr(0, 9), "121#01000") << "the lamp is off";
}

TEST_F(VcanDriveTest, AnInterfaceThatGoesDownBlocksAndIsNotResumedWithoutStart) {
  StartDriving();
  ASSERT_TRUE(RunsWell("ip link set vcan0 down"));
  const double down_s = Now();
  EXPECT_TRUE(RunUntil(0.2, [&] { return Reason() == StopReason::kBusDown; }));
  PrintRow("`ip link set vcan0 down`", ToMilliseconds(Now() - down_s),
           "`ip link set vcan0 up`; start");
  Run(1);
  EXPECT_LT(chassis_->plant().Speeds().left_mps, 0.001);
  ASSERT_TRUE(RunsWell("ip link set vcan0 up"));
  Run(1);
  EXPECT_EQ(Reason(), StopReason::kBusDown);
  EXPECT_TRUE(driver_->link().IsBusUp());
  EXPECT_LT(chassis_->plant().Speeds().left_mps, 0.001);
  StartAgain();
}

TEST_F(VcanDriveTest, AnAdapterThatComesBackUnderAnotherNameIsNotDriven) {
  StartDriving();
  RunBeside("ip link del vcan0");
  EXPECT_TRUE(RunUntil(5, [&] { return Reason() == StopReason::kBusDown; }));
  RunBeside("ip link add dev vcan9 type vcan && ip link set vcan9 up");
  Run(1);
  EXPECT_FALSE(driver_->pilot().Start(Now()).is_accepted) << "vcan0 is not there";
  EXPECT_LT(chassis_->plant().Speeds().left_mps, 0.001);
  // The names of the simulated chassis' and of the driver's interface are the same again.
  RunBeside("ip link del vcan9 && ip link add dev vcan0 type vcan && ip link set vcan0 up");
  StartAgain();
  PrintRow("`ip link del vcan0`, and the adapter is back as vcan9", "before `ip` has ended",
           "its name is vcan0 again; start");
}

TEST_F(VcanDriveTest, GarbageWrongLengthsAndAFloodDoNotDisturbTheDrive) {
  StartDriving();
  for (const char* frame : {"211#01", "211#", "311#00000000", "221#7FFF", "2FF#0102030405060708",
                            "211#R", "00000211#0100000000000000"})
    RunBeside(std::string("cansend vcan0 ") + frame);
  RunBeside("cangen vcan0 -g 0 -n 20000 -I 7FF -L r > /dev/null &");
  Run(3);
  EXPECT_EQ(Reason(), StopReason::kNone);
  EXPECT_GT(chassis_->plant().Speeds().left_mps, 0.05);
  EXPECT_GE(driver_->link().Traffic().num_unreadable, 4);
  PrintRow("garbage, wrong lengths, 20000 foreign frames", "drives on", "-");
}

TEST_F(VcanDriveTest, TheButtonIsObeyedWithin200MillisecondsUnderAFlood) {
  StartDriving();
  RunBeside("cangen vcan0 -g 1 -n 3000 -I 3FF -L 8 > /dev/null &");
  Run(0.5);
  ASSERT_GT(driver_->pilot().Status().motion.forward_mps, 0.09) << ToString(Reason());
  const double pressed_s = Now();
  chassis_->PressEmergencyStop(true);
  stopped_s_ = -1;
  overslept_s_ = 0;
  ASSERT_TRUE(RunUntil(5, [&] { return Reason() == StopReason::kChassisEmergency; }));
  const double stop_s = StopSeconds() - pressed_s;
  EXPECT_LE(stop_s - overslept_s_, 0.2) << "stopped after " << stop_s << " s";
  PrintRow("emergency stop button under a flood", ToMilliseconds(stop_s),
           "release the button; start");
}

}  // namespace
}  // namespace arfm_vo
