#pragma once

#include <tf2/buffer_core.h>

#include <optional>
#include <string>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/ros/messages/transforms.h"

namespace arfm_vo {

/// Lays recorded truth, the camera's pose in a world of its own, over the odometry: the first true
/// pose is where the odometry says that the camera is at that stamp.
class TruthAlignment {
 public:
  /// `buffer` must outlive this.
  TruthAlignment(const tf2::BufferCore& buffer, std::string reference_frame, std::string base_frame,
                 std::string camera_frame);

  /// The true pose of the base in the reference frame; nothing where tf cannot tell yet.
  std::optional<Rigid3> Align(const ros::Time& stamp, const Rigid3& truth_from_camera);
  /// The next pose is the first.
  void Reset() { reference_from_truth_.reset(); }

 private:
  const tf2::BufferCore& buffer_;
  std::string reference_frame_, base_frame_, camera_frame_;
  std::optional<Rigid3> reference_from_truth_;
};

}  // namespace arfm_vo
