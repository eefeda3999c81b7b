#pragma once

#include <vector>

#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/reconstruction/stereo_frame.h"

namespace arfm_vo {

const StereoCamera kCamera{700, 700, 320, 240, 0.5, 640, 480};

/// A frame whose keypoint i has response i and lies at the given (u, v, disparity).
inline StereoFrame MakeFrame(const std::vector<Eigen::Vector3d>& points) {
  StereoFrame frame;
  frame.features.descriptors =
      cv::Mat(static_cast<int>(points.size()), 64, CV_32F, cv::Scalar(0.125));
  for (size_t i = 0; i < points.size(); ++i) {
    const double u = points[i].x(), v = points[i].y(), disparity = points[i].z();
    frame.features.keypoints.push_back(
        {static_cast<float>(u), static_cast<float>(v), 2, 0, static_cast<float>(i)});
    frame.points.push_back(
        {static_cast<int>(i), {u, v, u - disparity}, 0, 0.5, kCamera.Triangulate(u, v, disparity)});
  }
  return frame;
}

}  // namespace arfm_vo
