#include "arfm_vo/ros/odometry/pose_node.h"

#include <diagnostic_updater/diagnostic_updater.h>
#include <image_transport/image_transport.h>
#include <ros/ros.h>
#include <tf2/buffer_core.h>

#include "arfm_vo/ros/input/exact_pairing.h"
#include "arfm_vo/ros/input/stereo_input.h"
#include "arfm_vo/ros/input/transform_input.h"
#include "arfm_vo/ros/node/console_watch.h"
#include "arfm_vo/ros/node/trigger_service.h"
#include "arfm_vo/ros/node/worker.h"
#include "arfm_vo/ros/odometry/pose_pipeline.h"

namespace arfm_vo {
namespace {

/// Images wait here for their features: more pairs than arfm_node works on and lets wait.
constexpr int kPairQueueSize = 10;

}  // namespace

class PoseNode::Impl {
 public:
  Impl(ros::NodeHandle node, ros::NodeHandle private_node);
  ~Impl();

 private:
  using Frame = StereoFrameStamped;
  using Image = sensor_msgs::Image;

  void Subscribe(ros::NodeHandle node, const ros::NodeHandle& private_node);
  void Offer(ros::NodeHandle node, ros::NodeHandle private_node);
  std::string Save();

  tf2::BufferCore buffer_;
  const std::unique_ptr<PosePipeline> pipeline_;  // of the worker's thread
  diagnostic_updater::Updater diagnostics_;
  Worker worker_;
  image_transport::ImageTransport transport_;
  ExactPairing<Frame, Image, Image> pairing_;
  std::unique_ptr<TransformInput> transforms_;  // of buffer_
  image_transport::Subscriber left_, right_;
  ros::Subscriber frames_, updates_, tracks_;
  ros::ServiceServer reset_, save_;
  ros::WallTimer timer_;
};

PoseNode::PoseNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : impl_(std::make_unique<Impl>(node, private_node)) {}

PoseNode::~PoseNode() = default;

PoseNode::Impl::Impl(ros::NodeHandle node, ros::NodeHandle private_node)
    : pipeline_(MakePosePipeline(node, private_node, buffer_)),
      diagnostics_(node, private_node, private_node.getNamespace()),
      worker_(pipeline_->max_waiting_pairs(),
              [this](const std::exception& error) {
                pipeline_->CountRefused(error);
                ROS_ERROR_THROTTLE(5, "pair refused: %s", error.what());
              }),
      transport_(node),
      pairing_(kPairQueueSize, [this](const auto& frame, const auto& left, const auto& right) {
        worker_.PostLossy([this, frame, left, right] {
          if (pipeline_->Process(*frame, left, right)) worker_.Release();
        });
      }) {
  if (pipeline_->max_held_pairs() > 0) worker_.Hold(pipeline_->max_held_pairs());
  Offer(node, private_node);
  Subscribe(node, private_node);
}

PoseNode::Impl::~Impl() {
  if (pipeline_->saves_at_end()) TellSavedAtEnd("the trajectory is", [this] { return Save(); });
}

void PoseNode::Impl::Offer(ros::NodeHandle node, ros::NodeHandle private_node) {
  diagnostics_.setHardwareID("arfm_vo");
  diagnostics_.add("odometry", pipeline_.get(), &PosePipeline::ReportOdometry);
  diagnostics_.add("calibration", [this](auto& status) { pipeline_->ReportCalibration(status); });
  diagnostics_.add("scale", [this](auto& status) { pipeline_->ReportScale(status); });
  timer_ = node.createWallTimer(ros::WallDuration(1), [this](const ros::WallTimerEvent&) {
    worker_.Post([this] { diagnostics_.force_update(); });
  });
  reset_ = OfferTrigger(private_node, "reset", [this] {
    worker_.RunAndWait([this] { pipeline_->StartEpoch(); });
    ROS_WARN("reset: the next pair begins a new map where the base stands");
    return std::string("the next pair begins a new map where the base stands");
  });
  save_ = OfferTrigger(private_node, "save_trajectory", [this] { return Save(); });
}

void PoseNode::Impl::Subscribe(ros::NodeHandle node, const ros::NodeHandle& private_node) {
  transforms_ = std::make_unique<TransformInput>(node, buffer_);
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  const image_transport::TransportHints hints("raw", no_delay, private_node);
  updates_ = node.subscribe<MapUpdateStamped>(
      "map_update", 2,
      [this](const MapUpdateStampedConstPtr& update) {
        worker_.Post([this, update] { pipeline_->Apply(*update); });
      },
      ros::VoidConstPtr(), no_delay);
  tracks_ = node.subscribe<nav_msgs::Odometry>(
      "track_odometry", 50, [this](const nav_msgs::OdometryConstPtr& odometry) {
        worker_.Post([this, odometry] { pipeline_->AddTrack(*odometry); });
      });
  left_ = transport_.subscribe(
      StereoTopic(node, "left/image_rect"), kPairQueueSize,
      [this](const sensor_msgs::ImageConstPtr& image) { pairing_.Add<1>(image); }, {}, hints);
  right_ = transport_.subscribe(
      StereoTopic(node, "right/image_rect"), kPairQueueSize,
      [this](const sensor_msgs::ImageConstPtr& image) { pairing_.Add<2>(image); }, {}, hints);
  frames_ = node.subscribe<Frame>(
      "features", kPairQueueSize, [this](const auto& frame) { pairing_.Add<0>(frame); }, {},
      no_delay);
}

std::string PoseNode::Impl::Save() {
  std::string saved;
  worker_.RunAndWait([&] { saved = pipeline_->SaveTrajectory(); });
  return saved;
}

}  // namespace arfm_vo
