#include "arfm_vo/ros/odometry/arfm_node.h"

#include <algorithm>
#include <boost/make_shared.hpp>

#include "arfm_vo/base/stopwatch.h"
#include "arfm_vo/ros/messages/conversions.h"
#include "arfm_vo/ros/node/parameters.h"

namespace arfm_vo {

ArfmNode::ArfmNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : node_(node),
      private_node_(private_node),
      options_(ReadParameters<ArfmNodeOptions>(private_node)),
      topics_(ResolveStereoTopics(node)),
      learned_(options_.remember_calibration),
      diagnostics_(node, private_node, private_node.getNamespace()),
      worker_(options_.max_waiting_pairs,
              [this](const std::exception& error) { figures_.refusals.Add(error.what()); }) {
  diagnostics_.setHardwareID("arfm_vo");
  diagnostics_.add("stereo pairs", this, &ArfmNode::Report);
  features_ = node.advertise<StereoFrameStamped>(
      "features", 2, [this](const ros::SingleSubscriberPublisher&) { Connect(); },
      [this](const ros::SingleSubscriberPublisher&) {
        if (features_.getNumSubscribers() == 0) input_.reset();
      });
  requests_ = node.subscribe<FeaturesRequest>(
      "features_request", 10,
      [this](const FeaturesRequestConstPtr& request) {
        worker_.Post([this, request] { Answer(*request); });
      },
      {}, ros::TransportHints().tcpNoDelay());
  timer_ = node.createWallTimer(ros::WallDuration(1), [this](const ros::WallTimerEvent&) {
    // A nodelet's queue takes nothing while the node is made, also not that who waited for features
    // is connected.
    if (features_.getNumSubscribers() > 0) Connect();
    ReportFigures();
  });
}

ArfmNode::~ArfmNode() {
  worker_.RunAndWait([this] {
    TellAtEnd("arfm_node: " + std::to_string(figures_.num_published) + " pairs, " +
              std::to_string(figures_.num_with_features) + " with features, " +
              std::to_string(worker_.num_dropped()) + " dropped, " +
              std::to_string(figures_.refusals.num()) + " refused" + figures_.times.Total());
  });
}

void ArfmNode::Connect() {
  if (input_) return;
  input_ = std::make_unique<StereoInput>(node_, private_node_,
                                         PairExactly([this](const StereoMessagePair& pair) {
                                           ++input_->counts.pairs;
                                           worker_.PostLossy([this, pair] { Process(pair); });
                                         }));
}

void ArfmNode::ReportFigures() {
  const StereoInputCounts counts = input_ ? input_->counts : StereoInputCounts();
  const std::string obstacle = input_ ? input_->TellObstacle() : "";
  if (input_) TellDrops();
  worker_.Post([this, is_idle = !input_, counts, obstacle] {
    figures_.is_idle = is_idle;
    figures_.input = counts;
    figures_.input_obstacle = obstacle;
    diagnostics_.force_update();
  });
}

void ArfmNode::TellDrops() {
  const uint32_t num_dropped = worker_.num_dropped();
  if (drop_watch_.IsDue(num_dropped > num_dropped_before_ ? "drops" : ""))
    ROS_WARN(
        "%u of %u pairs dropped so far: this computer is too slow for the rate and size of the "
        "images; lower them",
        num_dropped, input_->counts.pairs);
  num_dropped_before_ = num_dropped;
}

void ArfmNode::Process(const StereoMessagePair& pair) {
  if (!AcceptStamp(pair.left->header.stamp)) return;
  PrepareFrontend(pair);
  CheckSize(*pair.left, *pair.left_info, topics_.left_image);
  CheckSize(*pair.right, *pair.right_info, topics_.right_image);
  const StereoImages images{pair.left->header.stamp.toSec(),
                            ToGrey(pair.left, topics_.left_image, window_),
                            ToGrey(pair.right, topics_.right_image, window_)};
  Announced announced{pair, images, StereoFrameStamped(), frontend_->Look(images), nullptr};
  announced.message = ToMessage(announced.frame, camera_);
  announced.message.has_features = false;
  announced.message.header = pair.left->header;
  announced.message.pair_number = ++figures_.num_published;
  announced.message.num_dropped_pairs = worker_.num_dropped();
  if (options_.features_always) {
    PublishFeatures(announced);
  } else {
    features_.publish(announced.message);
    announced_.push_back(std::move(announced));
    if (announced_.size() > static_cast<size_t>(options_.max_kept_pairs)) announced_.pop_front();
  }
  figures_.refusals.Clear();
}

void ArfmNode::PublishFeatures(Announced& pair) {
  if (!pair.whole) pair.whole = Complete(pair);
  features_.publish(pair.whole);
}

StereoFrameStampedConstPtr ArfmNode::Complete(const Announced& pair) {
  Stopwatch stopwatch;
  StageTimes stages;
  const StereoFrame frame = frontend_->Complete(pair.frame, pair.images, &stages);
  const auto message = boost::make_shared<StereoFrameStamped>(ToMessage(frame, camera_));
  message->header = pair.message.header;
  message->pair_number = pair.message.pair_number;
  message->num_dropped_pairs = pair.message.num_dropped_pairs;
  for (const auto& [name, ms] : stages) {
    message->stage_names.push_back(name);
    message->stage_ms.push_back(ms);
  }
  ++figures_.num_with_features;
  figures_.times.Add(stopwatch.LapMs());
  figures_.num_left = message->keypoint_x.size();
  figures_.num_right = message->num_right_keypoints;
  figures_.num_points = message->point_keypoint.size();
  return message;
}

void ArfmNode::Answer(const FeaturesRequest& request) {
  const auto pair = std::find_if(announced_.begin(), announced_.end(), [&](const auto& announced) {
    return announced.message.header.stamp == request.stamp;
  });
  if (pair == announced_.end()) return;
  if (request.wanted) return PublishFeatures(*pair);
  announced_.erase(announced_.begin(), std::next(pair));
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
    announced_.clear();
  }
  return true;
}

void ArfmNode::PrepareFrontend(const StereoMessagePair& pair) {
  const StereoCamera camera = MakeStereoCamera(*pair.left_info, *pair.right_info);
  if (frontend_ && camera == camera_) return;
  frontend_ = std::make_unique<StereoFrontend>(camera, options_.algorithm.frontend);
  if (const auto known = learned_.ReadFor(camera)) frontend_->SetCorrection(*known);
  camera_ = camera;
  announced_.clear();
  const auto& distortion = pair.left_info->D;
  const bool is_distorted =
      std::any_of(distortion.begin(), distortion.end(), [](double d) { return d != 0; });
  if (is_distorted && topics_.left_image.find("image_raw") != std::string::npos)
    ROS_WARN(
        "%s is raw by its name, and its camera_info has distortion: where it is not rectified, "
        "give odometry.launch rectify:=true",
        topics_.left_image.c_str());
  ROS_INFO("stereo camera %dx%d, focal length %.1f px, baseline %.4f m", camera.width,
           camera.height, camera.fx, camera.baseline_m);
}

void ArfmNode::Report(Diagnostics& status) {
  figures_.times.Report(status);
  status.add("pairs published", figures_.num_published);
  status.add("with features", figures_.num_with_features);
  status.add("pairs dropped", worker_.num_dropped());
  status.add("pairs refused", figures_.refusals.num());
  status.add("pairs that came again or late", figures_.num_strays);
  status.add("left images", figures_.input.left);
  status.add("right images", figures_.input.right);
  status.add("left features", figures_.num_left);
  status.add("right features", figures_.num_right);
  status.add("stereo points", figures_.num_points);
  if (figures_.is_idle)
    return status.summary(Diagnostics::OK, "idle: nobody subscribes to features");
  if (figures_.refusals.IsTold(status)) return;
  if (!figures_.input_obstacle.empty())
    return status.summary(Diagnostics::WARN, "no pairs: " + figures_.input_obstacle);
  status.summary(Diagnostics::OK, "pairs come");
}

}  // namespace arfm_vo
