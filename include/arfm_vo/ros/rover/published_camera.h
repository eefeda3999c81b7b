#pragma once

#include <camera_info_manager/camera_info_manager.h>
#include <image_transport/image_transport.h>
#include <ros/ros.h>

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>

#include "arfm_vo/ros/rover/drive_listener.h"

namespace arfm_vo {

/// One camera of the stereo camera: image_raw and camera_info, which is loaded from an URL, and the
/// service set_camera_info that sets and stores it, but not while the rover drives.
class PublishedCamera {
 public:
  /// `drive` must outlive the camera.
  PublishedCamera(const ros::NodeHandle& node, const std::string& name, const std::string& url,
                  const DriveListener& drive);

  /// With the calibration, or an empty one where it is not for pictures of this size.
  void Publish(const cv::Mat& grey, const std_msgs::Header& header);
  /// The calibration, whatever its size; K[0] is 0 where there is none.
  sensor_msgs::CameraInfo Loaded() { return manager_.getCameraInfo(); }
  /// Since its file was written; nothing where there is none.
  std::optional<double> AgeInDays();

 private:
  bool Set(sensor_msgs::SetCameraInfo::Request& request,
           sensor_msgs::SetCameraInfo::Response& response);

  const std::string name_, url_;
  const DriveListener& drive_;
  ros::NodeHandle node_;
  camera_info_manager::CameraInfoManager manager_;
  image_transport::CameraPublisher publisher_;
  ros::ServiceServer server_;
};

/// Whether the calibration is for pictures of this size.
bool HasSize(const sensor_msgs::CameraInfo& info, int width, int height);

}  // namespace arfm_vo
