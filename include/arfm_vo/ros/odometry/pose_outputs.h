#pragma once

#include <arfm_vo/OdometryStatus.h>
#include <arfm_vo/StereoFrameStamped.h>
#include <image_transport/image_transport.h>
#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>

#include <string>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/odometry/session.h"
#include "arfm_vo/ros/messages/display_messages.h"

namespace arfm_vo {

struct PoseOutputOptions {
  std::string odom_frame = "odom";  ///< of odom, path and tf; continuous
  bool publish_tf = true;           ///< odom_frame -> base_frame

  void Check() const { Require(!odom_frame.empty(), "odom_frame must not be empty"); }
  ARFM_FIELDS(odom_frame, publish_tf)
};

/// All that pose_node publishes: odom, path, status, keyframe, matches_image, tf.
class PoseOutputs {
 public:
  PoseOutputs(ros::NodeHandle node, const PoseOutputOptions& options, std::string base_frame);

  /// Publishes what a pair said, with the stamp of its image, status first. Where it is not tracked
  /// there is no tf, and odom has a large covariance; without the camera's tf or with the head
  /// slewing there is no odom either.
  void Publish(const SessionUpdate& pose, const StereoFrameStamped& frame, uint32_t num_dropped);

  /// Only where somebody looks at it.
  void PublishPicture(const cv::Mat& left, const StereoFrame& frame, const SessionUpdate& pose,
                      const std_msgs::Header& header);

  void ClearPath() { path_.Clear(); }

 private:
  void PublishStatus(const SessionUpdate& pose, const StereoFrameStamped& frame,
                     const std_msgs::Header& header, uint32_t num_dropped);
  void PublishOdometry(const SessionUpdate& pose, const std_msgs::Header& header);

  PoseOutputOptions options_;
  std::string base_frame_;
  BoundedPath path_;
  ros::Publisher odometry_publisher_, path_publisher_, status_publisher_, keyframe_publisher_;
  image_transport::Publisher picture_publisher_;
  tf2_ros::TransformBroadcaster broadcaster_;
};

}  // namespace arfm_vo
