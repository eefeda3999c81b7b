#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/image/stereo_images.h"
#include "arfm_vo/odometry/trajectory.h"
#include "arfm_vo/pose/pose_estimate.h"

namespace arfm_vo {

struct OdometryOptions {
  void Check() const {}
  template <class Visitor>
  void VisitFields(Visitor&&) {}
};

/// What one pair brought.
struct OdometryUpdate {
  double stamp_s = 0;
  PoseEstimate pose;  ///< as known at once, before any later correction
  bool is_keyframe = false;
  int num_keypoints_left = 0, num_keypoints_right = 0, num_stereo_points = 0;
  std::vector<std::pair<std::string, double>>
      stage_ms;  ///< wall time of each stage, in their order
};

/// Stereo visual odometry in process: the same floors as the node chain, without ROS. Repeatable:
/// the same input gives the same output to the last bit.
class VisualOdometry {
 public:
  /// Throws std::invalid_argument where the camera or an option is wrong.
  VisualOdometry(const StereoCamera& camera, const OdometryOptions& options);
  ~VisualOdometry();

  /// Takes the next pair, later than the one before. Throws std::invalid_argument where the images
  /// do not fit the camera.
  OdometryUpdate Process(const StereoImages& images);

  /// Global bundle adjustment over all keyframes and points (Fig. 4) where it is switched on, then
  /// the pose of every frame, relative to its refined keyframe.
  Trajectory Finish();

 private:
  class Pipeline;
  std::unique_ptr<Pipeline> pipeline_;
};

}  // namespace arfm_vo
