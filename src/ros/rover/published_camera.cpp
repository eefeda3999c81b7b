#include "arfm_vo/ros/rover/published_camera.h"

#include <camera_calibration_parsers/parse.h>
#include <cv_bridge/cv_bridge.h>
#include <ros/package.h>
#include <ros/service_manager.h>
#include <sensor_msgs/image_encodings.h>

#include <boost/make_shared.hpp>
#include <chrono>
#include <filesystem>

#include "arfm_vo/base/array_checks.h"
#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

constexpr char kService[] = "set_camera_info";
constexpr int kCameraQueueSize = 2;

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

}  // namespace

bool HasSize(const sensor_msgs::CameraInfo& info, int width, int height) {
  return static_cast<int>(info.width) == width && static_cast<int>(info.height) == height;
}

PublishedCamera::PublishedCamera(const ros::NodeHandle& node, const std::string& name,
                                 const std::string& url, const DriveListener& drive)
    : name_(name),
      url_(url.empty() ? "file://${ROS_HOME}/camera_info/${NAME}.yaml" : url),
      drive_(drive),
      node_(node, name),
      manager_(node_, name, url_),
      publisher_(
          image_transport::ImageTransport(node_).advertiseCamera("image_raw", kCameraQueueSize)) {
  // The manager's own service knows no reason to refuse.
  ros::ServiceManager::instance()->unadvertiseService(node_.resolveName(kService));
  server_ = node_.advertiseService(kService, &PublishedCamera::Set, this);
}

std::optional<double> PublishedCamera::AgeInDays() {
  try {
    const auto age = std::filesystem::file_time_type::clock::now() -
                     std::filesystem::last_write_time(PathOf(manager_.resolveURL(url_, name_)));
    return std::chrono::duration<double>(age).count() / (24 * 3600);
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

void PublishedCamera::Publish(const cv::Mat& grey, const std_msgs::Header& header) {
  if (publisher_.getNumSubscribers() == 0) return;
  const auto info = boost::make_shared<sensor_msgs::CameraInfo>(Loaded());
  if (!HasSize(*info, grey.cols, grey.rows)) *info = {};
  info->width = static_cast<uint32_t>(grey.cols);
  info->height = static_cast<uint32_t>(grey.rows);
  info->header = header;
  const cv_bridge::CvImage image(header, sensor_msgs::image_encodings::MONO8, grey);
  publisher_.publish(image.toImageMsg(), info);
}

bool PublishedCamera::Set(sensor_msgs::SetCameraInfo::Request& request,
                          sensor_msgs::SetCameraInfo::Response& response) {
  try {
    Require(!drive_.IsDriving(), "the rover drives: stop it first");
    RequireFinite(request.camera_info.D, "D");
    RequireFinite(request.camera_info.K, "K");
    RequireFinite(request.camera_info.R, "R");
    RequireFinite(request.camera_info.P, "P");
    const std::filesystem::path path = PathOf(manager_.resolveURL(url_, name_));
    std::filesystem::create_directories(path.parent_path());
    Require(camera_calibration_parsers::writeCalibration(path, name_, request.camera_info),
            path.string() + ": cannot be written");
    manager_.setCameraInfo(request.camera_info);
    response.success = true;
  } catch (const std::exception& error) {
    response.status_message = std::string("camera_info is not set: ") + error.what();
    ROS_WARN("%s camera: %s", name_.c_str(), response.status_message.c_str());
  }
  return true;
}

}  // namespace arfm_vo
