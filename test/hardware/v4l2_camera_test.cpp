#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <thread>

#include "arfm_vo/hardware/monotonic_clock.h"
#include "arfm_vo/hardware/stereo_camera_device.h"
#include "arfm_vo/hardware/v4l2_call.h"
#include "hardware/loopback_writer.h"
#include "hardware/simulated_cameras.h"

namespace arfm_vo {
namespace {

constexpr char kLeft[] = "/dev/video10", kRight[] = "/dev/video11", kVivid[] = "/dev/video0";

void SleepUntil(double time_s) {
  const double wait_s = time_s - MonotonicNow();
  if (wait_s > 0) std::this_thread::sleep_for(std::chrono::duration<double>(wait_s));
}

/// Needs the kernel's v4l2loopback and vivid, as the virtual machine of scripts/test_hardware.sh
/// has them.
class V4l2CameraTest : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* path : {kLeft, kRight, kVivid})
      if (!std::filesystem::exists(path))
        GTEST_SKIP() << "no " << path << ": scripts/test_hardware.sh runs this";
  }
};

/// Two cameras that show numbered pictures at a rate, each picture at once on both; what goes wrong
/// is set from outside.
class NumberedCameras {
 public:
  static constexpr int kWidth = 320, kHeight = 240;
  static constexpr double kRate_hz = 20;

  NumberedCameras()
      : left_(kLeft, kWidth, kHeight),
        right_(kRight, kWidth, kHeight),
        thread_([this] { Run(); }) {}
  ~NumberedCameras() {
    is_stopping_ = true;
    thread_.join();
  }

  std::atomic<bool> is_right_silent{false};
  std::atomic<int> drop_right_every{0}, drop_left_every{0};
  std::atomic<double> right_late_s{0};

 private:
  void Run() {
    double next_s = MonotonicNow();
    for (int number = 1; !is_stopping_; ++number) {
      SleepUntil(next_s);
      cv::Mat picture(kHeight, kWidth, CV_8UC1, cv::Scalar(number % 200));
      std::copy_n(reinterpret_cast<const uint8_t*>(&number), sizeof(number), picture.data);
      if (!IsDropped(number, drop_left_every)) left_.Write(picture);
      SleepUntil(MonotonicNow() + right_late_s);
      if (!is_right_silent && !IsDropped(number, drop_right_every)) right_.Write(picture);
      next_s = std::max(next_s + 1 / kRate_hz, MonotonicNow() + 0.2 / kRate_hz);
    }
  }
  static bool IsDropped(int number, int every) { return every > 0 && number % every == 0; }

  LoopbackWriter left_, right_;
  std::atomic<bool> is_stopping_{false};
  std::thread thread_;
};

StereoCameraOptions LoopbackOptions() {
  StereoCameraOptions options;
  options.left_device = kLeft;
  options.right_device = kRight;
  options.video.width = NumberedCameras::kWidth;
  options.video.height = NumberedCameras::kHeight;
  options.video.rate_hz = NumberedCameras::kRate_hz;
  options.max_skew_s = 0.01;
  return options;
}

/// Both halves of a picture of vivid's test generator as the two eyes.
StereoCameraOptions VividOptions() {
  StereoCameraOptions options;
  options.left_device = kVivid;
  options.right_device = "";
  options.video.width = 320;
  options.video.height = 360;
  options.video.rate_hz = 10;
  options.video.input = 0;
  return options;
}

/// What was captured: every pair is of one moment, and stamps rise.
struct Capture {
  explicit Capture(const StereoCameraOptions& options)
      : camera(options, VideoEnvironment::Kernel()) {}

  /// Captures until `num_pairs` more have come; false after `timeout_s`.
  bool Take(int num_pairs, double timeout_s) {
    const double end_s = MonotonicNow() + timeout_s;
    for (const int goal = num_taken + num_pairs; num_taken < goal;) {
      if (MonotonicNow() > end_s) return false;
      if (const auto pair = camera.Step(0.2)) Check(*pair);
    }
    return true;
  }
  void Check(const FramePair& pair) {
    ++num_taken;
    num_wrong += ReadNumber(pair.left) != ReadNumber(pair.right);
    num_back += pair.left.stamp_s <= last_stamp_s;
    last_stamp_s = pair.left.stamp_s;
  }

  StereoCameraDevice camera;
  int num_taken = 0, num_wrong = 0, num_back = 0;
  double last_stamp_s = 0;
};

TEST_F(V4l2CameraTest, AThousandPairsWithoutAWrongOne) {
  NumberedCameras cameras;
  cameras.drop_left_every = 17;
  cameras.drop_right_every = 23;
  Capture capture(LoopbackOptions());
  ASSERT_TRUE(capture.Take(1000, 400)) << capture.camera.status().problem;
  const StereoCameraStatus& status = capture.camera.status();
  std::printf(
      "| pairs | wrong | stamps back | largest skew, ms | alone left | alone right |\n"
      "|---|---|---|---|---|---|\n");
  std::printf("| %d | %d | %d | %.2f | %d | %d |\n", capture.num_taken, capture.num_wrong,
              capture.num_back, 1e3 * status.max_skew_s, status.num_unpaired_left,
              status.num_unpaired_right);
  EXPECT_EQ(capture.num_wrong, 0);
  EXPECT_EQ(capture.num_back, 0);
  EXPECT_LE(status.max_skew_s, 0.01);
  EXPECT_GT(status.num_unpaired_left, 10);
  EXPECT_GT(status.num_unpaired_right, 10);
}

TEST_F(V4l2CameraTest, AFormatThatIsNotThereIsAnsweredWithThoseThatAre) {
  StereoCameraOptions options = VividOptions();
  options.video.pixel_format = "MJPG";
  StereoCameraDevice camera(options, VideoEnvironment::Kernel());
  EXPECT_FALSE(camera.Step(0.1));
  EXPECT_THAT(camera.status().problem,
              testing::AllOf(testing::HasSubstr("MJPG"), testing::HasSubstr("YUYV"),
                             testing::HasSubstr("640x360")));
}

TEST_F(V4l2CameraTest, PairsComeInEveryFormat) {
  for (const char* format : {"GREY", "YUYV", "UYVY", "NV12", "RGGB"}) {
    StereoCameraOptions options = VividOptions();
    options.video.pixel_format = format;
    Capture capture(options);
    EXPECT_TRUE(capture.Take(2, 20)) << format << ": " << capture.camera.status().problem;
  }
}

/// Writes `control` of vivid, as `v4l2-ctl -c` does.
void SetControl(const std::string& control) {
  const std::string command = std::string("v4l2-ctl -d ") + kVivid + " -c " + control;
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
}

struct Fault {
  const char* name;
  std::function<void()> inject;
  double lasts_s;  ///< before it is taken away
  std::function<void()> end;
};

/// Injects a fault into a running camera; tells how it was seen and when pairs came again.
void ShowRecovery(const StereoCameraOptions& options, const Fault& fault) {
  Capture capture(options);
  ASSERT_TRUE(capture.Take(5, 30)) << fault.name << ": " << capture.camera.status().problem;
  const StereoCameraStatus before = capture.camera.status();
  fault.inject();
  std::string seen;
  const double end_s = MonotonicNow() + fault.lasts_s;
  while (MonotonicNow() < end_s) {
    if (const auto pair = capture.camera.Step(0.2)) capture.Check(*pair);
    if (!capture.camera.status().problem.empty()) seen = capture.camera.status().problem;
  }
  fault.end();
  const double ended_s = MonotonicNow();
  const bool has_recovered = capture.Take(3, 10);
  const double recovery_s = MonotonicNow() - ended_s;
  const StereoCameraStatus& after = capture.camera.status();
  if (seen.empty()) seen = after.num_failures > before.num_failures ? "failure" : "no failure";
  std::printf("| %s | %s | %d | %d | %d | %.2f |\n", fault.name,
              seen.substr(0, seen.find('\n')).c_str(), after.num_failures - before.num_failures,
              after.num_dropped - before.num_dropped, after.num_corrupted - before.num_corrupted,
              recovery_s);
  EXPECT_TRUE(has_recovered) << fault.name << ": " << after.problem;
  EXPECT_LT(recovery_s, 5) << fault.name;
  EXPECT_EQ(capture.num_back, 0) << fault.name;
  if (!options.IsSideBySide()) EXPECT_EQ(capture.num_wrong, 0) << fault.name;
}

constexpr char kFaultTable[] =
    "| fault | seen as | failures | frames dropped | frames corrupted | three pairs after, s |\n"
    "|---|---|---|---|---|---|\n";

TEST_F(V4l2CameraTest, EveryInjectedFaultEndsInRecovery) {
  const auto nothing = [] {};
  const auto control = [](const char* text) { return [text] { SetControl(text); }; };
  const Fault faults[] = {
      {"half of the buffers dropped", control("percentage_of_dropped_buffers=50"), 3,
       control("percentage_of_dropped_buffers=0")},
      {"all buffers dropped", control("percentage_of_dropped_buffers=100"), 2,
       control("percentage_of_dropped_buffers=0")},
      {"a buffer marked as corrupted", control("inject_v4l2_buf_flag_error=1"), 1, nothing},
      {"unplugged (disconnect)", control("disconnect=1"), 1, nothing},
      {"fatal error while streaming", control("inject_fatal_streaming_error=1"), 1, nothing},
      {"error of QBUF", control("inject_vidioc_qbuf_error=1"), 1, nothing},
      {"unplugged, then no buffers (REQBUFS)",
       [] {
         SetControl("inject_vidioc_reqbufs_error=1");
         SetControl("disconnect=1");
       },
       1, nothing},
      {"fatal error, then no stream (STREAMON)",
       [] {
         SetControl("inject_vidioc_streamon_error=1");
         SetControl("inject_fatal_streaming_error=1");
       },
       1, nothing},
  };
  std::printf("%s", kFaultTable);
  for (const Fault& fault : faults) ShowRecovery(VividOptions(), fault);
}

TEST_F(V4l2CameraTest, AnEyeThatFallsSilentOrLateIsSurvivedWithoutAWrongPair) {
  NumberedCameras cameras;
  std::printf("%s", kFaultTable);
  ShowRecovery(LoopbackOptions(),
               {"right eye silent for 3 s", [&] { cameras.is_right_silent = true; }, 3,
                [&] { cameras.is_right_silent = false; }});
  ShowRecovery(LoopbackOptions(),
               {"right eye 25 ms late for 2 s", [&] { cameras.right_late_s = 0.025; }, 2,
                [&] { cameras.right_late_s = 0; }});
}

}  // namespace
}  // namespace arfm_vo
