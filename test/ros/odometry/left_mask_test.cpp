#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "arfm_vo/odometry/stereo_frontend.h"
#include "base/folder_test.h"
#include "base/refusal.h"
#include "ros/textured_wall.h"

namespace arfm_vo {
namespace {

using LeftMask = FolderTest;

TEST_F(LeftMask, NothingUnderItIsUsed) {
  const TexturedWall wall;
  const StereoImages images = wall.Render(1, Rigid3());
  const int middle = wall.camera().height / 2;
  cv::Mat mask(wall.camera().height, wall.camera().width, CV_8UC1, cv::Scalar(255));
  mask.rowRange(middle, mask.rows).setTo(0);
  FrontendOptions options;
  options.left_mask = folder_ / "mask.png";
  cv::imwrite(options.left_mask, mask);
  const StereoFrame masked = StereoFrontend(wall.camera(), options).Process(images);
  const StereoFrame whole = StereoFrontend(wall.camera(), {}).Process(images);
  std::filesystem::remove(options.left_mask);
  EXPECT_INVALID(StereoFrontend(wall.camera(), options), "left_mask: " + options.left_mask);

  const auto num_below = [&](const StereoFrame& frame) {
    return std::count_if(frame.points.begin(), frame.points.end(), [&](const StereoPoint& point) {
      return frame.features.keypoints[point.keypoint].y >= middle;
    });
  };
  EXPECT_GT(num_below(whole), 50);
  EXPECT_EQ(num_below(masked), 0);
  EXPECT_GT(masked.points.size(), 50u);
  for (const Keypoint& keypoint : masked.features.keypoints) EXPECT_LT(keypoint.y, middle);
  EXPECT_EQ(masked.features.descriptors.rows, masked.features.size());
}

}  // namespace
}  // namespace arfm_vo
