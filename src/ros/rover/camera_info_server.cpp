#include "arfm_vo/ros/rover/camera_info_server.h"

#include <camera_calibration_parsers/parse.h>
#include <ros/package.h>
#include <ros/service_manager.h>

#include <filesystem>
#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/ros/messages/message_checks.h"

namespace arfm_vo {
namespace {

constexpr char kService[] = "set_camera_info";

/// The file that a file:// or package:// URL means.
std::string PathOf(const std::string& url) {
  const std::string file = "file://", package = "package://";
  if (url.compare(0, file.size(), file) == 0) return url.substr(file.size());
  Require(url.compare(0, package.size(), package) == 0,
          url + ": neither a file:// nor a package:// URL");
  const size_t end = url.find('/', package.size());
  const std::string name = url.substr(package.size(), end - package.size());
  const std::string folder = ros::package::getPath(name);
  Require(end != std::string::npos && !folder.empty(), url + ": there is no package " + name);
  return folder + url.substr(end);
}

void RequireFiniteMatrices(const sensor_msgs::CameraInfo& info) {
  RequireFinite(info.D, "D");
  RequireFinite(info.K, "K");
  RequireFinite(info.R, "R");
  RequireFinite(info.P, "P");
}

}  // namespace

CameraInfoServer::CameraInfoServer(ros::NodeHandle node, const std::string& name,
                                   const std::string& url,
                                   std::function<std::string()> find_refusal)
    : name_(name),
      url_(url.empty() ? "file://${ROS_HOME}/camera_info/${NAME}.yaml" : url),
      find_refusal_(std::move(find_refusal)),
      manager_(node, name, url_) {
  // The manager's own service knows no reason to refuse.
  ros::ServiceManager::instance()->unadvertiseService(node.resolveName(kService));
  server_ = node.advertiseService(kService, &CameraInfoServer::Set, this);
}

bool CameraInfoServer::Set(sensor_msgs::SetCameraInfo::Request& request,
                           sensor_msgs::SetCameraInfo::Response& response) {
  try {
    const std::string refusal = find_refusal_();
    Require(refusal.empty(), refusal);
    RequireFiniteMatrices(request.camera_info);
    Store(request.camera_info);
    manager_.setCameraInfo(request.camera_info);
    response.success = true;
  } catch (const std::exception& error) {
    response.status_message = std::string("camera_info is not set: ") + error.what();
    ROS_WARN("%s eye: %s", name_.c_str(), response.status_message.c_str());
  }
  return true;
}

void CameraInfoServer::Store(const sensor_msgs::CameraInfo& info) {
  const std::filesystem::path path = PathOf(manager_.resolveURL(url_, name_));
  std::filesystem::create_directories(path.parent_path());
  Require(camera_calibration_parsers::writeCalibration(path, name_, info),
          path.string() + ": cannot be written");
}

}  // namespace arfm_vo
