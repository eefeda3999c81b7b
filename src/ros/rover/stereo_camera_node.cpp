#include "arfm_vo/ros/rover/stereo_camera_node.h"

#include <algorithm>
#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/format.h"
#include "arfm_vo/ros/node/parameters.h"

namespace arfm_vo {
namespace {

constexpr double kStep_s = 0.1;
constexpr double kReport_s = 1;
constexpr double kMinRateShare = 0.8;      ///< of the rate asked for; fewer pairs are a warning
constexpr double kMaxUnpairedShare = 0.1;  ///< of a camera's frames since the last report; as well
/// A stereo camera's baseline is shorter, m.
constexpr double kMaxBaseline_m = 10;

bool IsCalibrated(const sensor_msgs::CameraInfo& info) { return info.K[0] > 0; }

double UnpairedShare(const StereoCameraStatus& status, const StereoCameraStatus& before) {
  const int num_pairs = status.num_pairs - before.num_pairs;
  const int num_unpaired = std::max(status.num_unpaired_left - before.num_unpaired_left,
                                    status.num_unpaired_right - before.num_unpaired_right);
  return num_unpaired == 0 ? 0 : static_cast<double>(num_unpaired) / (num_unpaired + num_pairs);
}

/// Why an open camera gave no pair since the last report; empty where that is not known.
std::string WhyNoPairs(const StereoCameraStatus& status, const StereoCameraStatus& before,
                       const StereoCameraOptions& camera) {
  const bool has_left = status.num_unpaired_left > before.num_unpaired_left;
  const bool has_right = status.num_unpaired_right > before.num_unpaired_right;
  if (status.num_ambiguous > before.num_ambiguous)
    return Format(
        "frames of one camera come within %.1f ms, as two for one partner (max_skew_s is %.1f ms): "
        "its rate is higher than asked, or its stamps are wrong",
        2e3 * camera.max_skew_s, 1e3 * camera.max_skew_s);
  if (has_left && has_right)
    return Format("the cameras' frames are %.1f ms apart (max_skew_s is %.1f ms)",
                  1e3 * status.rejected_skew_s, 1e3 * camera.max_skew_s);
  return "";
}

}  // namespace

void ReportCamera(const StereoCameraStatus& status, const StereoCameraStatus& before,
                  const StereoCameraOptions& camera, Diagnostics& diagnostics) {
  diagnostics.addf("pairs a second", "%.2f", status.rate_hz);
  diagnostics.add("pairs", status.num_pairs);
  diagnostics.addf("skew, right - left, last pair (ms)", "%.3f", 1e3 * status.skew_s);
  diagnostics.addf("skew, largest (ms)", "%.3f", 1e3 * status.max_skew_s);
  diagnostics.add("frames without partner, left", status.num_unpaired_left);
  diagnostics.add("frames without partner, right", status.num_unpaired_right);
  diagnostics.add("frames too close to be told apart", status.num_ambiguous);
  diagnostics.add("frames dropped by the driver", status.num_dropped);
  diagnostics.add("frames corrupted", status.num_corrupted);
  diagnostics.add("frames without a usable stamp", status.num_stamped_late);
  diagnostics.add("failures", status.num_failures);
  diagnostics.add("times opened", status.num_opened);
  if (status.exposure) diagnostics.addf("exposure (ms)", "%.2f", 1e3 * status.exposure->time_s);
  if (status.exposure && status.exposure->gain) diagnostics.add("gain", *status.exposure->gain);
  if (!status.warning.empty()) diagnostics.add("not as asked", status.warning);
  const double share = UnpairedShare(status, before);
  const bool has_pairs = status.num_pairs > before.num_pairs;
  const std::string why_none = has_pairs ? "" : WhyNoPairs(status, before, camera);
  if (!status.is_open) return diagnostics.summary(Diagnostics::ERROR, status.problem);
  if (!why_none.empty()) return diagnostics.summary(Diagnostics::ERROR, "no pairs: " + why_none);
  if (!status.problem.empty()) return diagnostics.summary(Diagnostics::ERROR, status.problem);
  if (!has_pairs && share > 0)
    return diagnostics.summary(Diagnostics::ERROR, "no pairs: frames come from one camera alone");
  if (!has_pairs) return diagnostics.summary(Diagnostics::WARN, "no pairs since the last report");
  if (share > kMaxUnpairedShare)
    return diagnostics.summaryf(Diagnostics::WARN, "%.0f %% of a camera's frames have no partner",
                                100 * share);
  if (status.rate_hz < kMinRateShare * camera.video.rate_hz)
    return diagnostics.summaryf(Diagnostics::WARN, "%.1f pairs a second, asked are %.1f",
                                status.rate_hz, camera.video.rate_hz);
  if (!status.warning.empty()) return diagnostics.summary(Diagnostics::WARN, status.warning);
  diagnostics.summary(Diagnostics::OK, "pairs come");
}

void ReportCalibration(const sensor_msgs::CameraInfo& left, const sensor_msgs::CameraInfo& right,
                       int width, int height, Diagnostics& diagnostics) {
  if (!IsCalibrated(left) || !IsCalibrated(right)) {
    const bool is_one = IsCalibrated(left) || IsCalibrated(right);
    return diagnostics.summary(
        Diagnostics::WARN,
        is_one ? std::string(IsCalibrated(left) ? "right" : "left") + " camera is not calibrated"
               : "not calibrated (calibrate_stereo, set_camera_info or left_camera_info_url)");
  }
  for (const auto& [side, info] : {std::pair("left", &left), {"right", &right}})
    if (!HasSize(*info, width, height))
      return diagnostics.summaryf(Diagnostics::ERROR,
                                  "%s calibration is for %ux%u, pictures are %dx%d: not used", side,
                                  info->width, info->height, width, height);
  const double baseline_m = -right.P[3] / right.P[0];
  diagnostics.addf("baseline (m)", "%.4f", baseline_m);
  if (!(baseline_m > 0 && baseline_m < kMaxBaseline_m))
    return diagnostics.summaryf(
        Diagnostics::ERROR,
        "baseline is %.4g m: P[3] of the right camera must be -fx * baseline "
        "in m; are the cameras swapped?",
        baseline_m);
  diagnostics.summary(Diagnostics::OK, "calibrated");
}

void StereoCameraNodeOptions::Check() const {
  camera.Check();
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
    if (const auto days = right_.AgeInDays()) diagnostics.addf("age (days)", "%.1f", *days);
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
  ReportCamera(status, reported_, options_.camera, diagnostics);
  diagnostics.add("times the wall clock was set", num_clock_jumps_.load());
  reported_ = status;
}

}  // namespace arfm_vo
