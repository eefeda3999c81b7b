#include "arfm_vo/features/keypoint_mask.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "arfm_vo/base/check.h"
#include "arfm_vo/image/png_image.h"

namespace arfm_vo {
namespace {

/// How far the patch around a keypoint reaches that is aligned from image to image.
constexpr int kReach_px = 8;

std::string ToText(const cv::Size& size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

cv::Mat ReadMask(const std::string& path) {
  try {
    GreyWindow window;
    return ReadGreyPng(path, window);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("left_mask: ") + error.what());
  }
}

}  // namespace

KeypointMask::KeypointMask(const std::string& path, const cv::Size& size) {
  if (path.empty()) return;
  const cv::Mat mask = ReadMask(path);
  Require(mask.size() == size, "left_mask: " + path + ": its size is " + ToText(mask.size()) +
                                   ", the camera's is " + ToText(size));
  const int num_shown = cv::countNonZero(mask);
  Require(num_shown > 0, "left_mask: " + path + ": it is black everywhere and hides all");
  Require(num_shown < size.area(),
          "left_mask: " + path + ": it is black nowhere and hides nothing");
  const cv::Mat patch =
      cv::getStructuringElement(cv::MORPH_RECT, cv::Size(2 * kReach_px + 1, 2 * kReach_px + 1));
  cv::erode(mask, shows_, patch);
}

bool KeypointMask::Hides(const Keypoint& keypoint) const {
  if (shows_.empty()) return false;
  const int x = std::clamp(static_cast<int>(std::lround(keypoint.x)), 0, shows_.cols - 1);
  const int y = std::clamp(static_cast<int>(std::lround(keypoint.y)), 0, shows_.rows - 1);
  return shows_.at<uint8_t>(y, x) == 0;
}

Features KeypointMask::WithoutHidden(Features features) const {
  if (shows_.empty()) return features;
  Features shown;
  for (int i = 0; i < features.size(); ++i) {
    if (Hides(features.keypoints[i])) continue;
    shown.keypoints.push_back(features.keypoints[i]);
    shown.descriptors.push_back(features.descriptors.row(i));
  }
  return shown;
}

}  // namespace arfm_vo
