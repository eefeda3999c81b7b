#include <gmock/gmock.h>

#include <functional>
#include <map>
#include <string>

#include "arfm_vo/configuration/yaml_reader.h"
#include "arfm_vo/ros/rover/stereo_camera_node.h"

namespace arfm_vo {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using testing::HasSubstr;
using Wrapper = diagnostic_updater::DiagnosticStatusWrapper;

/// 10 pairs since the last report, as asked.
StereoCameraStatus GoodStatus() {
  StereoCameraStatus status;
  status.is_open = true;
  status.rate_hz = 10;
  status.num_pairs = 110;
  return status;
}

StereoCameraStatus StatusBefore() {
  StereoCameraStatus status = GoodStatus();
  status.num_pairs = 100;
  return status;
}

Wrapper Camera(const StereoCameraStatus& status) {
  Wrapper report;
  ReportCamera(status, StatusBefore(), {}, report);
  return report;
}

TEST(CameraHealth, FiguresAreTold) {
  StereoCameraStatus status = GoodStatus();
  status.num_unpaired_left = 3;
  status.num_unpaired_right = 4;
  status.num_ambiguous = 5;
  status.num_dropped = 6;
  status.num_corrupted = 7;
  status.num_stamped_late = 8;
  status.num_failures = 9;
  status.skew_s = 0.001;
  status.max_skew_s = 0.002;
  std::map<std::string, std::string> told;
  for (const auto& figure : Camera(status).values) told[figure.key] = figure.value;
  EXPECT_EQ(told["pairs"], "110");
  EXPECT_EQ(told["pairs a second"], "10.00");
  EXPECT_EQ(told["skew, right - left, last pair (ms)"], "1.000");
  EXPECT_EQ(told["skew, largest (ms)"], "2.000");
  EXPECT_EQ(told["frames without partner, left"], "3");
  EXPECT_EQ(told["frames without partner, right"], "4");
  EXPECT_EQ(told["frames too close to be told apart"], "5");
  EXPECT_EQ(told["frames dropped by the driver"], "6");
  EXPECT_EQ(told["frames corrupted"], "7");
  EXPECT_EQ(told["frames without a usable stamp"], "8");
  EXPECT_EQ(told["failures"], "9");
}

TEST(CameraHealth, WhatIsWrongHasItsLevelAndItsReason) {
  using Status = StereoCameraStatus;
  const auto without_pairs = [](Status& s, uint64_t left, uint64_t right, uint64_t ambiguous) {
    s.num_pairs = 100;
    s.num_unpaired_left = left;
    s.num_unpaired_right = right;
    s.num_ambiguous = ambiguous;
  };
  const struct {
    int level;
    const char* text;
    std::function<void(Status&)> spoil;
  } kCases[] = {
      {DiagnosticStatus::OK, "", [](Status&) {}},
      {DiagnosticStatus::ERROR, "/dev/video1",
       [](Status& s) {
         s.is_open = false;
         s.problem = "/dev/video1: No such device";
       }},
      {DiagnosticStatus::ERROR, "20.0 ms apart",
       [&](Status& s) {
         without_pairs(s, 10, 10, 0);
         s.rejected_skew_s = 0.02;
         s.problem = "no pairs yet";  // as before the first pair
       }},
      {DiagnosticStatus::ERROR, "from one camera alone",
       [&](Status& s) { without_pairs(s, 10, 0, 0); }},
      {DiagnosticStatus::ERROR, "right camera gives no frames",
       [&](Status& s) {
         without_pairs(s, 10, 0, 0);
         s.problem = "right camera gives no frames";
       }},
      {DiagnosticStatus::ERROR, "within 8.0 ms", [&](Status& s) { without_pairs(s, 10, 10, 10); }},
      {DiagnosticStatus::WARN, "", [](Status& s) { s.rate_hz = 7.9; }},
      {DiagnosticStatus::WARN, "17 %", [](Status& s) { s.num_unpaired_right = 2; }},  // of 12
      {DiagnosticStatus::WARN, "left camera: its gain cannot be set",
       [](Status& s) { s.warning = "left camera: its gain cannot be set"; }}};
  for (const auto& [level, text, spoil] : kCases) {
    Status status = GoodStatus();
    spoil(status);
    EXPECT_EQ(Camera(status).level, level) << text;
    EXPECT_THAT(Camera(status).message, HasSubstr(text));
  }
}

sensor_msgs::CameraInfo Info(double baseline_m) {
  sensor_msgs::CameraInfo info;
  info.width = 640;
  info.height = 480;
  info.K[0] = info.P[0] = 500;
  info.P[3] = -500 * baseline_m;
  return info;
}

TEST(CameraHealth, CalibrationIsWatched) {
  sensor_msgs::CameraInfo small = Info(0.2);
  small.width = 320;
  const struct {
    sensor_msgs::CameraInfo left, right;
    int level;
    const char* text;
  } rows[] = {{Info(0), Info(0.2), DiagnosticStatus::OK, ""},
              {{}, {}, DiagnosticStatus::WARN, ""},
              {Info(0), {}, DiagnosticStatus::WARN, "right camera is not calibrated"},
              {Info(0), small, DiagnosticStatus::ERROR, "320x480"},
              {Info(0), Info(200), DiagnosticStatus::ERROR, ""},  // in millimetres
              {Info(0), Info(-0.2), DiagnosticStatus::ERROR, "swapped"}};
  for (const auto& [left, right, level, text] : rows) {
    Wrapper report;
    ReportCalibration(left, right, 640, 480, report);
    EXPECT_EQ(report.level, level) << text;
    EXPECT_THAT(report.message, HasSubstr(text));
  }
}

TEST(StereoCameraNodeOptions, ShippedConfigIsReadStrictly) {
  const auto options = ReadYamlFile<StereoCameraNodeOptions>(std::string(ARFM_VO_SOURCE_DIR) +
                                                             "/config/camera.yaml");
  EXPECT_EQ(options.camera.left_device, "/dev/video0");
}

TEST(StereoCameraNodeOptions, PathsThatAreNoUrlsAreRefused) {
  StereoCameraNodeOptions options;
  options.left_camera_info_url = "/etc/rover/left.yaml";
  EXPECT_THROW(options.Check(), std::invalid_argument);
  options.left_camera_info_url = options.right_camera_info_url = "file:///etc/rover/left.yaml";
  EXPECT_THROW(options.Check(), std::invalid_argument);
  options.right_camera_info_url = "file:///etc/rover/right.yaml";
  EXPECT_NO_THROW(options.Check());
}

}  // namespace
}  // namespace arfm_vo
