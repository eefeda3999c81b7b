#include "arfm_vo/ros/messages/stereo_messages.h"

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/distortion_models.h>
#include <sensor_msgs/image_encodings.h>

#include "arfm_vo/ros/messages/conversions.h"

namespace arfm_vo {
namespace {

/// camera_info of a rectified eye (REP-104); `p3` = -fx * baseline on the right one.
sensor_msgs::CameraInfo MakeInfo(const StereoCamera& camera, const std_msgs::Header& header,
                                 double p3) {
  sensor_msgs::CameraInfo info;
  info.header = header;
  info.width = camera.width;
  info.height = camera.height;
  info.distortion_model = sensor_msgs::distortion_models::PLUMB_BOB;
  info.D.assign(5, 0.0);
  info.K = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.P = {camera.fx, 0, camera.cx, p3, 0, camera.fy, camera.cy, 0, 0, 0, 1, 0};
  return info;
}

}  // namespace

StereoMessages ToMessages(const SequencePair& pair, const StereoCamera& camera,
                          const std::string& frame_id) {
  std_msgs::Header header;
  header.stamp.fromSec(pair.images.stamp_s + kStampOffset_s);
  header.frame_id = frame_id;
  const auto to_image = [&](const cv::Mat& image) {
    return *cv_bridge::CvImage(header, sensor_msgs::image_encodings::MONO8, image).toImageMsg();
  };
  StereoMessages messages;
  messages.left = to_image(pair.images.left);
  messages.right = to_image(pair.images.right);
  messages.left_info = MakeInfo(camera, header, 0);
  messages.right_info = MakeInfo(camera, header, -camera.fx * camera.baseline_m);
  if (pair.true_world_from_camera) {
    messages.ground_truth.emplace();
    messages.ground_truth->header = header;
    messages.ground_truth->header.frame_id = "ground_truth";
    messages.ground_truth->pose = ToPoseMessage(*pair.true_world_from_camera);
  }
  return messages;
}

}  // namespace arfm_vo
