#include "arfm_vo/ros/rover/stereo_camera_node.h"

#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/hardware/monotonic_clock.h"
#include "arfm_vo/ros/node/parameters.h"

namespace arfm_vo {
namespace {

constexpr double kStep_s = 0.1;
constexpr double kReport_s = 1;

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
  updater_.add("calibration", [this](Diagnostics& diagnostics) {
    const VideoOptions& video = options_.camera.video;
    ReportCalibration(left_.Loaded(), right_.Loaded(), video.width, video.height, diagnostics);
  });
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
    status_.Set(status);
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
  left_.Publish(pair.left.grey, header);
  right_.Publish(pair.right.grey, header);
}

void StereoCameraNode::Report(Diagnostics& diagnostics) {
  const StereoCameraStatus status = status_.Get();
  ReportCamera(status, reported_, options_.camera, options_.health, diagnostics);
  diagnostics.add("times the wall clock was set", num_clock_jumps_.load());
  reported_ = status;
}

}  // namespace arfm_vo
