#include "arfm_vo/ros/odometry/pose_outputs.h"

#include <cv_bridge/cv_bridge.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/image_encodings.h>
#include <tf2_eigen/tf2_eigen.h>

#include <boost/make_shared.hpp>
#include <utility>

#include "arfm_vo/evaluation/match_picture.h"
#include "arfm_vo/ros/messages/conversions.h"
#include "arfm_vo/ros/messages/copy_fields.h"
#include "arfm_vo/ros/messages/transforms.h"

namespace arfm_vo {

static_assert(static_cast<uint8_t>(PoseStatus::kTracked) == OdometryStatus::TRACKED &&
              static_cast<uint8_t>(PoseStatus::kNoConsensus) == OdometryStatus::NO_CONSENSUS &&
              static_cast<uint8_t>(PoseStatus::kHeadSlewing) == OdometryStatus::HEAD_SLEWING &&
              static_cast<uint8_t>(PoseStatus::kDegraded) == OdometryStatus::DEGRADED);

PoseOutputs::PoseOutputs(ros::NodeHandle node, const PoseOutputOptions& options,
                         std::string base_frame)
    : options_(options),
      base_frame_(std::move(base_frame)),
      odometry_publisher_(node.advertise<nav_msgs::Odometry>("odom", 10)),
      path_publisher_(node.advertise<nav_msgs::Path>("path", 1, true)),
      status_publisher_(node.advertise<OdometryStatus>("status", 10)),
      keyframe_publisher_(node.advertise<KeyframeStamped>("keyframe", 100)),
      picture_publisher_(image_transport::ImageTransport(node).advertise("matches_image", 1)) {}

void PoseOutputs::Publish(const SessionUpdate& pose, const StereoFrameStamped& frame,
                          uint32_t num_dropped) {
  std_msgs::Header header;
  header.stamp = frame.header.stamp;
  header.frame_id = options_.odom_frame;
  // First, so that who drives by the pose hears of a new epoch before its poses.
  PublishStatus(pose, frame, header, num_dropped);
  if (pose.IsTried()) PublishOdometry(pose, header);
  if (pose.update.pose.IsMeasured()) {  // nobody steers by what no picture told
    if (options_.publish_tf)
      broadcaster_.sendTransform(
          MakeTransform(header.stamp, header.frame_id, base_frame_, pose.odom_from_base));
    if (path_.Add(header, ToPoseMessage(pose.odom_from_base)))
      path_publisher_.publish(path_.path());
  }
  if (pose.keyframe) {
    const auto keyframe = boost::make_shared<KeyframeStamped>(ToMessage(*pose.keyframe));
    keyframe->header = header;
    keyframe_publisher_.publish(keyframe);
  }
}

void PoseOutputs::PublishStatus(const SessionUpdate& pose, const StereoFrameStamped& frame,
                                const std_msgs::Header& header, uint32_t num_dropped) {
  OdometryStatus status;
  status.header = header;
  status.state = static_cast<uint8_t>(pose.update.pose.status);
  status.text = pose.text;
  status.is_keyframe = pose.update.is_keyframe;
  status.epoch = pose.epoch;
  status.num_features = static_cast<uint32_t>(frame.keypoint_x.size());
  status.num_right_features = frame.num_right_keypoints;
  status.num_stereo_points = static_cast<uint32_t>(frame.point_keypoint.size());
  ARFM_COPY_FIELDS(status, pose.update.pose, num_matches, num_inliers, rms_px)
  status.num_seen_by_both = static_cast<uint32_t>(CountWithRight(pose.update.observations));
  ARFM_COPY_FIELDS(status, frame, has_features, ratio_threshold, grey_mean, grey_variance,
                   stage_names, stage_ms)
  status.row_residual_px = pose.update.median_row_residual_px;
  status.num_dropped_arfm = frame.num_dropped_pairs;
  status.num_dropped_pose = num_dropped;
  for (const auto& [name, ms] : pose.update.stage_ms) {
    status.stage_names.push_back(name);
    status.stage_ms.push_back(ms);
  }
  status_publisher_.publish(boost::make_shared<OdometryStatus>(std::move(status)));
}

void PoseOutputs::PublishOdometry(const SessionUpdate& pose, const std_msgs::Header& header) {
  const auto odometry = boost::make_shared<nav_msgs::Odometry>();
  odometry->header = header;
  odometry->child_frame_id = base_frame_;
  odometry->pose.pose = ToPoseMessage(pose.odom_from_base);
  odometry->pose.covariance = ToCovarianceMessage(pose.covariance);
  odometry->twist.twist = tf2::toMsg(pose.twist);
  odometry->twist.covariance = ToCovarianceMessage(pose.twist_covariance);
  odometry_publisher_.publish(odometry);
}

void PoseOutputs::PublishPicture(const cv::Mat& left, const StereoFrame& frame,
                                 const SessionUpdate& pose, const std_msgs::Header& header) {
  if (picture_publisher_.getNumSubscribers() == 0) return;
  const cv_bridge::CvImage picture(header, sensor_msgs::image_encodings::BGR8,
                                   DrawMatches(left, frame, pose.update));
  picture_publisher_.publish(picture.toImageMsg());
}

}  // namespace arfm_vo
