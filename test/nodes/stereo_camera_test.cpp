#include <arfm_vo/DriveStatus.h>
#include <gmock/gmock.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>
#include <sensor_msgs/SetCameraInfo.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <thread>

#include "arfm_vo/hardware/clock_offset.h"
#include "arfm_vo/ros/rover/stereo_camera_node.h"
#include "hardware/simulated_cameras.h"
#include "nodes/inbox.h"
#include "nodes/node_process.h"

namespace arfm_vo {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr int kWidth = 8, kHeight = 4;

/// Simulated cameras on the machine's clock.
VideoEnvironment InRealTime(SimulatedCameras& world) {
  VideoEnvironment environment = world.Environment();
  environment.now_s = [&world] { return world.now_s = MonotonicNow(); };
  environment.wait = [&world](const std::vector<int>& descriptors, double timeout_s) {
    const double arrival_s = descriptors.empty() ? 1e300 : world.NextArrival() - world.now_s;
    const double wait_s = std::min(std::max(timeout_s, 0.0), arrival_s);
    std::this_thread::sleep_for(std::chrono::duration<double>(wait_s));
    world.now_s = MonotonicNow();
  };
  return environment;
}

sensor_msgs::CameraInfo Calibration(bool is_right, int width = kWidth) {
  sensor_msgs::CameraInfo info;
  info.width = static_cast<uint32_t>(width);
  info.height = kHeight;
  info.distortion_model = "plumb_bob";
  info.D.assign(5, 0);
  info.K = {500, 0, 4, 0, 500, 2, 0, 0, 1};
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.P = {500, 0, 4, is_right ? -60.0 : 0.0, 0, 500, 2, 0, 0, 0, 1, 0};
  return info;
}

class StereoCameraNodeTest : public testing::Test {
 protected:
  StereoCameraNodeTest() {
    std::filesystem::remove_all(folder_);
    ros::NodeHandle options("/stereo/camera");
    options.setParam("left_device", "left");
    options.setParam("right_device", "right");
    options.setParam("video/width", kWidth);
    options.setParam("video/height", kHeight);
    options.setParam("left_camera_info_url", "file://" + folder_ + "/left.yaml");
    options.setParam("right_camera_info_url", "file://" + folder_ + "/right.yaml");
    Start();
  }
  ~StereoCameraNodeTest() override { std::filesystem::remove_all(folder_); }

  void Start() {
    node_.reset();
    node_ = std::make_unique<StereoCameraNode>(
        ros::NodeHandle("/stereo"), ros::NodeHandle("/stereo/camera"), InRealTime(world_));
  }
  /// What set_camera_info of a camera answers.
  static std::string Set(const std::string& side, const sensor_msgs::CameraInfo& info) {
    const std::string name = "/stereo/" + side + "/set_camera_info";
    sensor_msgs::SetCameraInfo call;
    call.request.camera_info = info;
    // The service is of this process: somebody must spin while it is called.
    ros::AsyncSpinner spinner(1);
    spinner.start();
    if (!ros::service::waitForService(name, ros::Duration(30))) return "no " + name;
    if (!CallService(name, call)) return "no answer";
    return call.response.success ? "" : "refused: " + call.response.status_message;
  }
  /// Waits until a camera_info with this P[3] comes, or one more where there is none.
  void AwaitBaseline(double p3) {
    WaitUntil([&] { return right_info_.size() > 0 && right_info_.all().back().P[3] == p3; },
              "P[3] of " + std::to_string(p3));
  }

  /// Of the calibration.
  const std::string folder_ = ros::param::param<std::string>("~folder", "no folder");
  SimulatedCameras world_;
  std::unique_ptr<StereoCameraNode> node_;
  Inbox<sensor_msgs::Image> left_{"/stereo/left/image_raw"}, right_{"/stereo/right/image_raw"};
  Inbox<sensor_msgs::CameraInfo> left_info_{"/stereo/left/camera_info"},
      right_info_{"/stereo/right/camera_info"};
  Diagnoses diagnoses_;
};

TEST_F(StereoCameraNodeTest, BothCamerasOfAPairHaveOneStampOfRosTime) {
  const ros::Time start = ros::Time::now();
  WaitUntil([&] { return left_.size() >= 5 && right_.size() >= 5 && right_info_.size() >= 5; },
            "pairs");
  for (const auto& right : right_.all()) {
    EXPECT_EQ(right.encoding, "mono8");
    EXPECT_EQ(right.header.frame_id, "left_camera_optical");
    EXPECT_GT(right.header.stamp, start - ros::Duration(1));
    EXPECT_LT(right.header.stamp, ros::Time::now());
    // The pictures show the number of their moment: the same in both cameras of one stamp.
    for (const auto& left : left_.all())
      EXPECT_EQ(left.header.stamp == right.header.stamp,
                std::equal(left.data.begin(), left.data.begin() + 4, right.data.begin()));
  }
}

TEST_F(StereoCameraNodeTest, SetCameraInfoIsRefusedWhileTheRoverDrives) {
  ros::NodeHandle node("/stereo");
  auto publisher = node.advertise<DriveStatus>("drive_status", 1, true);
  DriveStatus status;
  status.state = DriveStatus::DRIVING;
  publisher.publish(status);
  const std::string refusal = "refused: camera_info is not set: the rover drives: stop it first";
  WaitUntil([&] { return Set("left", Calibration(false)) == refusal; }, "the refusal");
  std::filesystem::remove_all(folder_);  // of answers before the status had come
  EXPECT_EQ(Set("left", Calibration(false)), refusal);
  EXPECT_FALSE(std::filesystem::exists(folder_));
  status.state = DriveStatus::BLOCKED;
  publisher.publish(status);
  WaitUntil([&] { return Set("left", Calibration(false)).empty(); }, "acceptance");
}

TEST_F(StereoCameraNodeTest, ACalibrationThatIsNotFiniteIsRefusedByName) {
  sensor_msgs::CameraInfo info = Calibration(true);
  info.D.back() = INFINITY;
  EXPECT_EQ(Set("left", info), "refused: camera_info is not set: D[4] is not a finite number");
  info = Calibration(true);
  info.P[3] = NAN;
  EXPECT_EQ(Set("left", info), "refused: camera_info is not set: P[3] is not a finite number");
  EXPECT_FALSE(std::filesystem::exists(folder_));
}

TEST_F(StereoCameraNodeTest, SetCameraInfoIsPublishedAndStoredForTheNextStart) {
  diagnoses_.Await(": calibration", DiagnosticStatus::WARN, "not calibrated");
  WaitUntil([&] { return right_info_.size() > 0; }, "camera_info");
  EXPECT_EQ(right_info_.last().K[0], 0);
  EXPECT_EQ(Set("left", Calibration(false)), "");
  diagnoses_.Await(": calibration", DiagnosticStatus::WARN, "right camera is not calibrated");
  EXPECT_EQ(Set("right", Calibration(true)), "");
  AwaitBaseline(-60);
  diagnoses_.Await(": calibration", DiagnosticStatus::OK, "calibrated");
  EXPECT_EQ(right_info_.last().K[0], 500);
  EXPECT_TRUE(std::filesystem::exists(folder_ + "/left.yaml"));
  EXPECT_TRUE(std::filesystem::exists(folder_ + "/right.yaml"));
  Start();
  diagnoses_.Await(": calibration", DiagnosticStatus::OK, "calibrated");
  const int num_before = right_info_.size();
  WaitUntil([&] { return right_info_.size() > num_before; }, "camera_info after the start");
  EXPECT_EQ(right_info_.last().P[3], -60);
}

TEST_F(StereoCameraNodeTest, ACalibrationForAnotherSizeIsAnErrorAndNotPublished) {
  EXPECT_EQ(Set("left", Calibration(false, 640)), "");
  EXPECT_EQ(Set("right", Calibration(true, 640)), "");
  diagnoses_.Await(": calibration", DiagnosticStatus::ERROR, "640x4, pictures are 8x4");
  WaitUntil([&] { return right_info_.size() > 0; }, "camera_info");
  EXPECT_EQ(right_info_.last().K[0], 0);
  EXPECT_EQ(right_info_.last().width, 8u);
}

TEST_F(StereoCameraNodeTest, AnUnpluggedCameraIsAnErrorAndSurvived) {
  diagnoses_.Await(": camera", DiagnosticStatus::OK, "pairs come");
  Inbox<rosgraph_msgs::Log> console("/rosout");
  WaitUntil([&] { return console.has_publisher(); }, "the console");
  world_.faults[1].is_unplugged = true;
  diagnoses_.Await(": camera", DiagnosticStatus::ERROR, "device");
  diagnoses_.Await(": camera", DiagnosticStatus::ERROR, "device");
  // It is tried again and again, and said once (or twice, where it ends in two ways).
  const auto is_error = [](const auto& line) { return line.level == rosgraph_msgs::Log::ERROR; };
  WaitUntil([&] { return std::any_of(console.all().begin(), console.all().end(), is_error); },
            "the console to tell of it");
  EXPECT_LE(std::count_if(console.all().begin(), console.all().end(), is_error), 2);
  world_.faults[1].is_unplugged = false;
  diagnoses_.Await(": camera", DiagnosticStatus::OK, "pairs come");
}

/// What the program prints; fills its exit status.
std::string RunProgram(const std::string& arguments, int& status) {
  const std::string command = ARFM_VO_PROGRAM_DIR "/stereo_camera_node " + arguments + " 2>&1";
  return Finish(::popen(command.c_str(), "r"), status);
}

TEST(StereoCameraProgram, AWrongParameterEndsItWithItsNameAndListSaysWhatThereIs) {
  int status = 0;
  EXPECT_THAT(RunProgram("__name:=wrong _video/width:=-1", status),
              testing::HasSubstr("video.width"));
  EXPECT_NE(status, 0);
  EXPECT_THAT(RunProgram("--list", status), testing::HasSubstr("/dev/video"));
  EXPECT_THAT(RunProgram("--list /dev/no_such_camera", status),
              testing::HasSubstr("/dev/no_such_camera: No such file"));
  EXPECT_NE(status, 0);
}

}  // namespace
}  // namespace arfm_vo
