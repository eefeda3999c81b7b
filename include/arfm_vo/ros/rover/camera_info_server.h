#pragma once

#include <camera_info_manager/camera_info_manager.h>
#include <ros/ros.h>

#include <functional>
#include <string>

namespace arfm_vo {

/// The camera_info of one eye, loaded from an URL, and the service set_camera_info that sets and
/// stores it.
class CameraInfoServer {
 public:
  /// `find_refusal` says why set_camera_info is refused now; empty where it is not.
  CameraInfoServer(ros::NodeHandle node, const std::string& name, const std::string& url,
                   std::function<std::string()> find_refusal);

  /// K[0] is 0 where there is none.
  sensor_msgs::CameraInfo Get() { return manager_.getCameraInfo(); }

 private:
  bool Set(sensor_msgs::SetCameraInfo::Request& request,
           sensor_msgs::SetCameraInfo::Response& response);
  void Store(const sensor_msgs::CameraInfo& info);

  const std::string name_, url_;
  const std::function<std::string()> find_refusal_;
  camera_info_manager::CameraInfoManager manager_;
  ros::ServiceServer server_;
};

}  // namespace arfm_vo
