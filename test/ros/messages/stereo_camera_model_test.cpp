#include <gtest/gtest.h>

#include <functional>
#include <utility>

#include "arfm_vo/ros/messages/stereo_messages.h"
#include "base/refusal.h"

namespace arfm_vo {
namespace {

/// camera_info of a camera of KITTI's shape; `p3` is P[3].
sensor_msgs::CameraInfo MakeInfo(double p3) {
  sensor_msgs::CameraInfo info;
  info.width = 1226;
  info.height = 370;
  info.P = {700, 0, 600, p3, 0, 710, 180, 0, 0, 0, 1, 0};
  return info;
}

const sensor_msgs::CameraInfo kLeft = MakeInfo(0), kRight = MakeInfo(-350);

TEST(StereoCameraModel, TakesIntrinsicsFromTheLeftAndTheBaselineFromTheRight) {
  const double baseline_m = 350. / 700;
  EXPECT_TRUE(MakeStereoCamera(kLeft, kRight) ==
              (StereoCamera{700, 710, 600, 180, baseline_m, 1226, 370}));
}

TEST(StereoCameraModel, SaysWhatIsWrongWithTheCameras) {
  using Info = sensor_msgs::CameraInfo;
  const std::pair<const char*, std::function<void(Info&, Info&)>> rows[] = {
      {"P[3] is 0", [](auto&, auto& right) { right.P[3] = 0; }},
      {"in mm", [](auto&, auto& right) { right.P[3] = -350e3; }},
      {"swapped", [](auto&, auto& right) { right.P[3] = 350; }},
      {"swapped", [](auto& left, auto& right) { std::swap(left, right); }},
      {"not finite", [](auto&, auto& right) { right.P[3] = NAN; }},
      {"cx is 600 in the left P and 610", [](auto&, auto& right) { right.P[2] = 610; }},
      {"fy is 710 in the left P and 711", [](auto&, auto& right) { right.P[5] = 711; }},
      {"skew", [](auto& left, auto&) { left.P[1] = 0.5; }},
      {"left camera_info: the focal lengths in P are 0 and 0: this camera is not calibrated",
       [](auto& left, auto&) { left.P.fill(0); }},
      {"left image is 1226x370, the right one 1241x370",
       [](auto&, auto& right) { right.width = 1241; }},
      {"size", [](auto& left, auto& right) { left.width = right.width = 0; }},
      {"binning", [](auto& left, auto&) { left.binning_x = 2; }},
      {"region", [](auto&, auto& right) { right.roi.x_offset = 8; }}};
  for (const auto& [complaint, spoil] : rows) {
    Info left = kLeft, right = kRight;
    spoil(left, right);
    EXPECT_INVALID(MakeStereoCamera(left, right), complaint);
  }
}

TEST(StereoCameraModel, AnImageHasTheSizeThatItsCameraInfoTells) {
  sensor_msgs::Image image;
  image.width = kRight.width;
  image.height = kRight.height;
  CheckSize(image, kRight, "/right");
  image.width -= 8;
  EXPECT_INVALID(CheckSize(image, kRight, "/right"),
                 "/right is 1218x370, its camera_info says 1226x370");
}

}  // namespace
}  // namespace arfm_vo
