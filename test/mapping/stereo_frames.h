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
    Keypoint keypoint;
    keypoint.x = static_cast<float>(points[i].x());
    keypoint.y = static_cast<float>(points[i].y());
    keypoint.scale = 2;
    keypoint.response = static_cast<float>(i);
    frame.features.keypoints.push_back(keypoint);
    StereoPoint point;
    point.keypoint = static_cast<int>(i);
    point.observation << points[i].x(), points[i].y(), points[i].x() - points[i].z();
    point.sigma_px = 0.5;
    point.x_in_camera = kCamera.Triangulate(points[i].x(), points[i].y(), points[i].z());
    frame.points.push_back(point);
  }
  return frame;
}

}  // namespace arfm_vo
