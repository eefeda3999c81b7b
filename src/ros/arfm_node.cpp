#include "arfm_vo/ros/arfm_node.h"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>

#include "arfm_vo/base/stopwatch.h"
#include "arfm_vo/ros/conversions.h"
#include "arfm_vo/ros/image_conversion.h"
#include "arfm_vo/ros/parameters.h"
#include "arfm_vo/ros/stereo_camera_model.h"

namespace arfm_vo {

using diagnostic_msgs::DiagnosticStatus;

void ArfmNodeOptions::Check() const {
  algorithm.Check();
  Require(max_waiting_pairs >= 1, "max_waiting_pairs must be at least 1");
}

ArfmNode::ArfmNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : options_(ReadParameters<ArfmNodeOptions>(private_node)),
      topics_(ResolveStereoTopics(node)),
      learned_(options_.learned),
      diagnostics_(node, private_node, private_node.getNamespace()),
      worker_(options_.max_waiting_pairs, [this](const std::exception& error) {
        ++figures_.num_refused;
        figures_.refusal = error.what();
        ROS_ERROR_THROTTLE(5, "pair refused: %s", error.what());
      }) {
  diagnostics_.setHardwareID("arfm_vo");
  diagnostics_.add("stereo pairs", this, &ArfmNode::Report);
  features_ = node.advertise<StereoFrameStamped>(
      "features", 2,
      [this, node, private_node](const ros::SingleSubscriberPublisher&) {
        Connect(node, private_node);
      },
      [this](const ros::SingleSubscriberPublisher&) { Disconnect(); });
  timer_ = node.createWallTimer(ros::WallDuration(1),
                                [this](const ros::WallTimerEvent&) { ReportFigures(); });
}

ArfmNode::~ArfmNode() {
  worker_.RunAndWait([this] {
    TellAtEnd("arfm_node: " + std::to_string(figures_.num_published) + " pairs worked on, " +
              std::to_string(worker_.num_dropped()) + " dropped, " +
              std::to_string(figures_.num_refused) + " refused");
  });
}

void ArfmNode::Connect(const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
  if (input_) return;
  input_ = std::make_unique<StereoInput>(node, private_node, [this](const StereoMessagePair& pair) {
    worker_.PostLossy([this, pair] { Process(pair); });
  });
}

void ArfmNode::Disconnect() {
  if (features_.getNumSubscribers() == 0) input_.reset();
}

void ArfmNode::ReportFigures() {
  const bool is_idle = !input_;
  if (is_idle) {
    input_watch_.Reset();
  } else {
    input_watch_.Tell(input_->counts(), topics_);
    TellDrops(input_->counts().pairs);
  }
  worker_.Post([this, is_idle, counts = is_idle ? StereoInputCounts() : input_->counts()] {
    figures_.is_idle = is_idle;
    figures_.input = counts;
    diagnostics_.force_update();
    figures_.input_before = counts;
  });
}

void ArfmNode::TellDrops(uint32_t num_pairs) {
  const uint32_t num_dropped = worker_.num_dropped();
  const bool has_dropped = num_dropped > num_dropped_before_;
  if (drop_watch_.IsDue(has_dropped ? "drops" : "", ros::WallTime::now().toSec()))
    ROS_WARN(
        "%u of %u pairs dropped so far: this computer is too slow for the rate and size of the "
        "images; lower them",
        num_dropped, num_pairs);
  num_dropped_before_ = num_dropped;
}

void ArfmNode::CheckNotRaw(const StereoMessagePair& pair) const {
  const std::vector<double>& distortion = pair.left_info->D;
  const bool is_distorted =
      std::any_of(distortion.begin(), distortion.end(), [](double d) { return d != 0; });
  if (is_distorted && topics_.left_image.find("image_raw") != std::string::npos)
    ROS_WARN(
        "%s is raw by its name, and its camera_info has distortion: where it is not rectified, "
        "give "
        "odometry.launch rectify:=true",
        topics_.left_image.c_str());
}

void ArfmNode::Process(const StereoMessagePair& pair) {
  Stopwatch stopwatch;
  if (!AcceptStamp(pair.left->header.stamp)) return;
  PrepareFrontend(pair);
  CheckSize(*pair.left, *pair.left_info, topics_.left_image);
  CheckSize(*pair.right, *pair.right_info, topics_.right_image);
  const StereoImages images{pair.left->header.stamp.toSec(),
                            ToGrey(pair.left, topics_.left_image, window_),
                            ToGrey(pair.right, topics_.right_image, window_)};
  StageTimes stages;
  const StereoFrame frame = frontend_->Process(images, &stages);
  Publish(pair, frame, stages);
  figures_.num_left = frame.features.size();
  figures_.num_right = frame.num_right_keypoints;
  figures_.num_points = static_cast<int>(frame.points.size());
  figures_.refusal.clear();
  figures_.ms = stopwatch.LapMs();
  figures_.rate.Tick();
}

bool ArfmNode::AcceptStamp(const ros::Time& stamp) {
  const StampVerdict verdict = stamps_.Judge(stamp);
  if (verdict == StampVerdict::kStray) {
    ++figures_.num_strays;
    ROS_WARN_THROTTLE(5, "a pair came again or late and is passed over: stamp %.3f", stamp.toSec());
    return false;
  }
  if (verdict == StampVerdict::kJumpBack) {
    ROS_WARN("time jumped back: starting anew");
    frontend_.reset();
  }
  return true;
}

void ArfmNode::PrepareFrontend(const StereoMessagePair& pair) {
  const StereoCamera camera = MakeStereoCamera(*pair.left_info, *pair.right_info);
  if (frontend_ && camera == camera_) return;
  frontend_ = std::make_unique<StereoFrontend>(camera, options_.algorithm.frontend);
  if (const auto known = learned_.ReadFor(camera)) frontend_->SetCorrection(*known);
  camera_ = camera;
  CheckNotRaw(pair);
  ROS_INFO("stereo camera %dx%d, focal length %.1f px, baseline %.4f m", camera.width,
           camera.height, camera.fx, camera.baseline_m);
}

void ArfmNode::Publish(const StereoMessagePair& pair, const StereoFrame& frame,
                       const StageTimes& stages) {
  const auto message = boost::make_shared<StereoFrameStamped>(ToMessage(frame, camera_));
  message->header = pair.left->header;
  message->pair_number = ++figures_.num_published;
  message->num_dropped_pairs = worker_.num_dropped();
  for (const auto& [name, ms] : stages) {
    message->stage_names.push_back(name);
    message->stage_ms.push_back(ms);
  }
  features_.publish(message);
}

void ArfmNode::Report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::string obstacle = figures_.input.Explain(figures_.input_before, topics_);
  if (figures_.is_idle)
    status.summary(DiagnosticStatus::OK, "idle: nobody subscribes to features");
  else if (!figures_.refusal.empty())
    status.summary(DiagnosticStatus::ERROR, "pair refused: " + figures_.refusal);
  else if (!obstacle.empty())
    status.summary(DiagnosticStatus::WARN, "no pairs: " + obstacle);
  else
    status.summary(DiagnosticStatus::OK, "pairs come");
  status.addf("pairs a second", "%.1f", figures_.rate.Get());
  status.add("pairs published", figures_.num_published);
  status.add("pairs dropped", worker_.num_dropped());
  status.add("pairs refused", figures_.num_refused);
  status.add("pairs that came again or late", figures_.num_strays);
  status.add("left images", figures_.input.left);
  status.add("right images", figures_.input.right);
  status.add("left features", figures_.num_left);
  status.add("right features", figures_.num_right);
  status.add("stereo points", figures_.num_points);
  status.addf("time of the last pair (ms)", "%.1f", figures_.ms);
}

}  // namespace arfm_vo
