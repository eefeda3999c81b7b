#include "arfm_vo/ros/rover/stereo_camera_node.h"

#include <sensor_msgs/image_encodings.h>

#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/hardware/monotonic_clock.h"
#include "arfm_vo/ros/node/parameters.h"

namespace arfm_vo {
namespace {

constexpr int kCameraQueueSize = 2;
constexpr double kStep_s = 0.1;
constexpr double kReport_s = 1;

sensor_msgs::ImagePtr ToMessage(const cv::Mat& grey, const std_msgs::Header& header) {
  auto message = boost::make_shared<sensor_msgs::Image>();
  message->header = header;
  message->width = static_cast<uint32_t>(grey.cols);
  message->height = static_cast<uint32_t>(grey.rows);
  message->encoding = sensor_msgs::image_encodings::MONO8;
  message->step = message->width;
  message->data.resize(grey.total());
  grey.copyTo(cv::Mat(grey.rows, grey.cols, CV_8UC1, message->data.data()));
  return message;
}

}  // namespace

void StereoCameraNodeOptions::Check() const {
  camera.Check();
  health.Check();
  for (const auto& [key, url] : {std::pair("left_camera_info_url", &left_camera_info_url),
                                 {"right_camera_info_url", &right_camera_info_url}})
    Require(url->empty() || url->find("://") != std::string::npos,
            std::string(key) + " must be an URL such as file:///etc/rover/left.yaml, is " + *url);
  Require(left_camera_info_url.empty() || left_camera_info_url != right_camera_info_url,
          "left_camera_info_url and right_camera_info_url must differ");
}

StereoCameraNode::Eye::Eye(const ros::NodeHandle& node, const std::string& name,
                           const std::string& url, const DriveListener& drive)
    : node_(node, name),
      calibration_(node_, name, url,
                   [&drive] { return drive.IsDriving() ? "the rover drives: stop it first" : ""; }),
      transport_(node_),
      publisher_(transport_.advertiseCamera("image_raw", kCameraQueueSize)) {}

sensor_msgs::CameraInfo StereoCameraNode::Eye::Fitting(int width, int height) {
  sensor_msgs::CameraInfo info = calibration_.Get();
  const bool has_size =
      static_cast<int>(info.width) == width && static_cast<int>(info.height) == height;
  if (!has_size) info = sensor_msgs::CameraInfo();
  info.width = static_cast<uint32_t>(width);
  info.height = static_cast<uint32_t>(height);
  return info;
}

void StereoCameraNode::Eye::Publish(const VideoFrame& frame, const std_msgs::Header& header) {
  if (publisher_.getNumSubscribers() == 0) return;
  auto info =
      boost::make_shared<sensor_msgs::CameraInfo>(Fitting(frame.grey.cols, frame.grey.rows));
  info->header = header;
  publisher_.publish(ToMessage(frame.grey, header), info);
}

StereoCameraNode::StereoCameraNode(ros::NodeHandle node, ros::NodeHandle private_node,
                                   VideoEnvironment environment)
    : options_(ReadParameters<StereoCameraNodeOptions>(private_node)),
      drive_(node),
      left_(node, "left", options_.left_camera_info_url, drive_),
      right_(node, "right", options_.right_camera_info_url, drive_),
      camera_(options_.camera, std::move(environment)),
      clock_(&MonotonicNow, [] { return ros::WallTime::now().toSec(); }),
      updater_(node, private_node, private_node.getNamespace()) {
  updater_.setHardwareID(options_.camera.left_device + " " + options_.camera.right_device);
  updater_.add("camera", this, &StereoCameraNode::Report);
  updater_.add("calibration", this, &StereoCameraNode::ReportCalibration);
  timer_ =
      node.createSteadyTimer(ros::WallDuration(kReport_s),
                             [this](const ros::SteadyTimerEvent&) { updater_.force_update(); });
  thread_ = std::thread([this] { Run(); });
}

StereoCameraNode::~StereoCameraNode() {
  timer_.stop();
  is_stopping_ = true;
  thread_.join();
}

void StereoCameraNode::Run() {
  while (!is_stopping_) {
    const std::optional<FramePair> pair = camera_.Step(kStep_s);
    if (pair) Publish(*pair);
    const StereoCameraStatus& status = camera_.status();
    if (status.problem != said_ && !status.problem.empty() && status.num_failures > 0)
      ROS_ERROR("%s", status.problem.c_str());
    if (status.problem.empty() && !said_.empty()) ROS_INFO("pairs come");
    said_ = status.problem;
    const std::lock_guard<std::mutex> lock(mutex_);
    status_ = status;
    num_clock_jumps_ = clock_.num_jumps();
  }
}

void StereoCameraNode::Publish(const FramePair& pair) {
  std_msgs::Header header;
  header.frame_id = options_.frame_id;
  header.stamp = ros::Time(clock_.ToWall(0.5 * (pair.left.stamp_s + pair.right.stamp_s)));
  // A wall clock that is steered moves stamps by less than the time between frames; one that is set
  // moves them anywhere, and who listens must hear of it.
  const bool was_set = clock_.num_jumps() != published_jumps_;
  if (header.stamp <= last_stamp_ && !was_set) return;
  published_jumps_ = clock_.num_jumps();
  last_stamp_ = header.stamp;
  left_.Publish(pair.left, header);
  right_.Publish(pair.right, header);
}

void StereoCameraNode::Report(diagnostic_updater::DiagnosticStatusWrapper& diagnostics) {
  StereoCameraStatus status;
  int num_jumps;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    status = status_;
    num_jumps = num_clock_jumps_;
  }
  ReportCamera(status, reported_, options_.camera, options_.health, diagnostics);
  diagnostics.add("times the wall clock was set", num_jumps);
  reported_ = status;
}

void StereoCameraNode::ReportCalibration(diagnostic_updater::DiagnosticStatusWrapper& diagnostics) {
  arfm_vo::ReportCalibration(left_.Loaded(), right_.Loaded(), options_.camera.video.width,
                             options_.camera.video.height, diagnostics);
}

}  // namespace arfm_vo
