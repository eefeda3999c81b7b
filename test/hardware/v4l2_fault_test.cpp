#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

#include "hardware/v4l2_capture.h"

namespace arfm_vo {
namespace {

using V4l2FaultTest = V4l2Test;

/// Writes `control` of vivid, as `v4l2-ctl -c` does.
void SetControl(const std::string& control) {
  const std::string command = std::string("v4l2-ctl -d ") + kVivid + " -c " + control;
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
}

struct Fault {
  const char* name;
  std::function<void()> inject;
  int StereoCameraStatus::*sign;  ///< the count that must rise, or the fault was not there
  int rise = 1;                   ///< by at least this
  double lasts_s = 0;             ///< before it is taken away; 0: it goes by itself
  std::function<void()> end = [] {};
};

/// Injects a fault into a running camera; tells how it was seen and how long after the injection
/// three more pairs had come, counted from where it was seen and is over.
void ShowRecovery(Capture& capture, const Fault& fault) {
  ASSERT_TRUE(capture.Take(5, 30)) << fault.name << ": " << capture.camera.status().problem;
  const StereoCameraStatus before = capture.camera.status();
  const StereoCameraStatus& now = capture.camera.status();
  const double injected_s = MonotonicNow();
  const auto since = [&] { return MonotonicNow() - injected_s; };
  fault.inject();
  std::string problem;
  double seen_s = 0;
  while ((seen_s == 0 && since() < 10) || since() < fault.lasts_s) {
    capture.Step();
    if (seen_s == 0 && now.*fault.sign >= before.*fault.sign + fault.rise) seen_s = since();
    if (!now.problem.empty()) problem = now.problem.substr(0, now.problem.find('\n'));
  }
  fault.end();
  const bool has_recovered = capture.Take(3, 10);
  const double recovery_s = since();
  std::printf("| %s | %.1f | %.2f | %s | %d | %d | %d | %d | %.2f |\n", fault.name, fault.lasts_s,
              seen_s, problem.empty() ? "no failure" : problem.c_str(),
              now.num_failures - before.num_failures, now.num_dropped - before.num_dropped,
              now.num_corrupted - before.num_corrupted,
              now.num_unpaired_left - before.num_unpaired_left + now.num_unpaired_right -
                  before.num_unpaired_right,
              recovery_s);
  EXPECT_GT(seen_s, 0) << fault.name << " was not seen: was it injected?";
  EXPECT_TRUE(has_recovered) << fault.name << ": " << now.problem;
  EXPECT_LT(recovery_s, 5) << fault.name;
}

constexpr char kFaultTable[] =
    "| fault | lasts, s | seen after, s | as | failures | dropped | corrupted | alone | three "
    "pairs "
    "again after, s |\n|---|---|---|---|---|---|---|---|---|\n";

TEST_F(V4l2FaultTest, EveryInjectedFaultEndsInRecovery) {
  const auto control = [](const char* text) { return [text] { SetControl(text); }; };
  const auto failures = &StereoCameraStatus::num_failures;
  const Fault faults[] = {
      {"half of the buffers dropped", control("percentage_of_dropped_buffers=50"),
       &StereoCameraStatus::num_dropped, 1, 3, control("percentage_of_dropped_buffers=0")},
      {"all buffers dropped", control("percentage_of_dropped_buffers=100"), failures, 1, 2,
       control("percentage_of_dropped_buffers=0")},
      {"a buffer marked as corrupted", control("inject_v4l2_buf_flag_error=1"),
       &StereoCameraStatus::num_corrupted},
      {"unplugged (disconnect)", control("disconnect=1"), failures},
      {"fatal error while streaming", control("inject_fatal_streaming_error=1"), failures},
      {"error of QBUF", control("inject_vidioc_qbuf_error=1"), failures},
      {"unplugged, then no buffers (REQBUFS)",
       [] {
         SetControl("inject_vidioc_reqbufs_error=1");
         SetControl("disconnect=1");
       },
       failures, 2},
      {"fatal error, then no stream (STREAMON)",
       [] {
         SetControl("inject_vidioc_streamon_error=1");
         SetControl("inject_fatal_streaming_error=1");
       },
       failures, 2},
  };
  std::printf("%s", kFaultTable);
  for (const Fault& fault : faults) {
    Capture capture(VividOptions());
    ShowRecovery(capture, fault);
    EXPECT_EQ(capture.num_back, 0) << fault.name;
  }
}

TEST_F(V4l2FaultTest, AnCameraThatFallsSilentOrLateIsSurvivedWithoutAWrongPair) {
  NumberedCameras cameras(kLeft, kRight);
  const Fault faults[] = {
      {"right camera silent", [&] { cameras.is_right_silent = true; },
       &StereoCameraStatus::num_failures, 1, 2, [&] { cameras.is_right_silent = false; }},
      {"right camera 25 ms late", [&] { cameras.right_late_s = 0.025; },
       &StereoCameraStatus::num_unpaired_left, 1, 2, [&] { cameras.right_late_s = 0; }},
  };
  std::printf("%s", kFaultTable);
  for (const Fault& fault : faults) {
    Capture capture(LoopbackOptions(), &cameras);
    ShowRecovery(capture, fault);
    EXPECT_EQ(capture.num_wrong, 0) << fault.name;
    EXPECT_EQ(capture.num_foreign, 0) << fault.name;
    EXPECT_EQ(capture.num_back, 0) << fault.name;
  }
}

}  // namespace
}  // namespace arfm_vo
