#include "arfm_vo/ros/odometry/arfm_node.h"

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <string>

#include "arfm_vo/base/stopwatch.h"
#include "arfm_vo/ros/input/stamp_order.h"
#include "arfm_vo/ros/node/console_watch.h"
#include "arfm_vo/ros/node/wall_rate.h"
#include "arfm_vo/ros/node/worker.h"
#include "arfm_vo/ros/odometry/frontend_pipeline.h"
#include "arfm_vo/ros/odometry/running_median.h"

namespace arfm_vo {

using diagnostic_msgs::DiagnosticStatus;

class ArfmNode::Impl {
 public:
  Impl(ros::NodeHandle node, ros::NodeHandle private_node);
  ~Impl();

 private:
  /// How the pairs since the start fared.
  struct Figures {
    uint32_t num_published = 0, num_refused = 0, num_strays = 0;
    std::string refusal;  ///< why the newest pair was refused; empty where it was not
    int num_left = 0, num_right = 0, num_points = 0;
    double ms = 0;
    RunningMedian times_ms{kTimedPairs};
    WallRate rate;
    bool is_idle = true;  ///< nobody subscribes to features
    StereoInputCounts input, input_before;
  };

  void Connect(const ros::NodeHandle& node, const ros::NodeHandle& private_node);
  void Disconnect();
  void ReportFigures();
  void TellDrops(uint32_t num_pairs);
  // On the worker's thread:
  void Process(const StereoMessagePair& pair);
  /// Says whether the pair is to be worked on; begins anew where time has jumped.
  bool AcceptStamp(const ros::Time& stamp);
  void Report(diagnostic_updater::DiagnosticStatusWrapper& status);

  const StereoTopics topics_;
  // Of the thread that calls back:
  StereoInputWatch input_watch_;
  ConsoleWatch drop_watch_;
  uint32_t num_dropped_before_ = 0;
  // Of the worker's thread:
  const std::unique_ptr<FrontendPipeline> pipeline_;
  StampOrder stamps_;
  Figures figures_;
  diagnostic_updater::Updater diagnostics_;
  Worker worker_;
  std::unique_ptr<StereoInput> input_;
  ros::Publisher features_;
  ros::WallTimer timer_;
};

ArfmNode::ArfmNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : impl_(std::make_unique<Impl>(node, private_node)) {}

ArfmNode::~ArfmNode() = default;

ArfmNode::Impl::Impl(ros::NodeHandle node, ros::NodeHandle private_node)
    : topics_(ResolveStereoTopics(node)),
      pipeline_(MakeFrontendPipeline(private_node, topics_)),
      diagnostics_(node, private_node, private_node.getNamespace()),
      worker_(pipeline_->max_waiting_pairs(), [this](const std::exception& error) {
        ++figures_.num_refused;
        figures_.refusal = error.what();
        ROS_ERROR_THROTTLE(5, "pair refused: %s", error.what());
      }) {
  diagnostics_.setHardwareID("arfm_vo");
  diagnostics_.add("stereo pairs", this, &Impl::Report);
  features_ = node.advertise<StereoFrameStamped>(
      "features", 2,
      [this, node, private_node](const ros::SingleSubscriberPublisher&) {
        Connect(node, private_node);
      },
      [this](const ros::SingleSubscriberPublisher&) { Disconnect(); });
  timer_ = node.createWallTimer(ros::WallDuration(1),
                                [this, node, private_node](const ros::WallTimerEvent&) {
                                  // A nodelet's queue takes nothing while the node is made, also
                                  // not that who waited for features is connected.
                                  if (features_.getNumSubscribers() > 0)
                                    Connect(node, private_node);
                                  ReportFigures();
                                });
}

ArfmNode::Impl::~Impl() {
  worker_.RunAndWait([this] {
    TellAtEnd("arfm_node: " + std::to_string(figures_.num_published) + " pairs worked on, " +
              std::to_string(worker_.num_dropped()) + " dropped, " +
              std::to_string(figures_.num_refused) + " refused" + TellTime(figures_.times_ms));
  });
}

void ArfmNode::Impl::Connect(const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
  if (input_) return;
  input_ = std::make_unique<StereoInput>(node, private_node, [this](const StereoMessagePair& pair) {
    worker_.PostLossy([this, pair] { Process(pair); });
  });
}

void ArfmNode::Impl::Disconnect() {
  if (features_.getNumSubscribers() == 0) input_.reset();
}

void ArfmNode::Impl::ReportFigures() {
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

void ArfmNode::Impl::TellDrops(uint32_t num_pairs) {
  const uint32_t num_dropped = worker_.num_dropped();
  const bool has_dropped = num_dropped > num_dropped_before_;
  if (drop_watch_.IsDue(has_dropped ? "drops" : "", ros::WallTime::now().toSec()))
    ROS_WARN(
        "%u of %u pairs dropped so far: this computer is too slow for the rate and size of the "
        "images; lower them",
        num_dropped, num_pairs);
  num_dropped_before_ = num_dropped;
}

void ArfmNode::Impl::Process(const StereoMessagePair& pair) {
  Stopwatch stopwatch;
  if (!AcceptStamp(pair.left->header.stamp)) return;
  const StereoFrameStampedPtr frame = pipeline_->Process(pair);
  frame->pair_number = ++figures_.num_published;
  frame->num_dropped_pairs = worker_.num_dropped();
  figures_.num_left = static_cast<int>(frame->keypoint_x.size());
  figures_.num_right = frame->num_right_keypoints;
  figures_.num_points = static_cast<int>(frame->point_keypoint.size());
  features_.publish(frame);
  figures_.refusal.clear();
  figures_.ms = stopwatch.LapMs();
  figures_.times_ms.Add(figures_.ms);
  figures_.rate.Tick();
}

bool ArfmNode::Impl::AcceptStamp(const ros::Time& stamp) {
  const StampVerdict verdict = stamps_.Judge(stamp);
  if (verdict == StampVerdict::kStray) {
    ++figures_.num_strays;
    ROS_WARN_THROTTLE(5, "a pair came again or late and is passed over: stamp %.3f", stamp.toSec());
    return false;
  }
  if (verdict == StampVerdict::kJumpBack) {
    ROS_WARN("time jumped back: starting anew");
    pipeline_->Reset();
  }
  return true;
}

void ArfmNode::Impl::Report(diagnostic_updater::DiagnosticStatusWrapper& status) {
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
