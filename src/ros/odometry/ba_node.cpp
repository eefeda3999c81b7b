#include "arfm_vo/ros/odometry/ba_node.h"

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>

#include "arfm_vo/ros/node/console_watch.h"
#include "arfm_vo/ros/node/trigger_service.h"
#include "arfm_vo/ros/node/worker.h"
#include "arfm_vo/ros/odometry/map_pipeline.h"

namespace arfm_vo {

class BaNode::Impl {
 public:
  Impl(ros::NodeHandle node, ros::NodeHandle private_node);
  ~Impl();

 private:
  void SendTransform();

  const std::unique_ptr<MapPipeline> pipeline_;
  tf2_ros::TransformBroadcaster broadcaster_;
  diagnostic_updater::Updater diagnostics_;
  Worker worker_;
  nav_msgs::OdometryConstPtr newest_odometry_;
  ros::Subscriber keyframes_, odometry_, stated_;
  ros::ServiceServer save_;
  ros::Time sent_;  // the newest transform's stamp
  ros::WallTimer timer_;
  ros::Timer tf_timer_;
};

BaNode::BaNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : impl_(std::make_unique<Impl>(node, private_node)) {}

BaNode::~BaNode() = default;

BaNode::Impl::Impl(ros::NodeHandle node, ros::NodeHandle private_node)
    : pipeline_(MakeMapPipeline(node, private_node, [this] { return worker_.is_stopping(); })),
      diagnostics_(node, private_node, private_node.getNamespace()),
      worker_(1, [this](const std::exception& error) {
        pipeline_->CountRefused(error);
        ROS_ERROR_THROTTLE(5, "keyframe refused: %s", error.what());
      }) {
  diagnostics_.setHardwareID("arfm_vo");
  diagnostics_.add("global adjustment", [this](auto& status) { pipeline_->Report(status); });
  keyframes_ = node.subscribe<KeyframeStamped>(
      "keyframe", 100, [this](const KeyframeStampedConstPtr& keyframe) {
        worker_.Post([this, keyframe] { pipeline_->Add(*keyframe); });
      });
  odometry_ = node.subscribe<nav_msgs::Odometry>(
      "odom", 1, [this](const auto& odometry) { newest_odometry_ = odometry; });
  stated_ = node.subscribe<geometry_msgs::PoseWithCovarianceStamped>(
      "initialpose", 1, [this](const auto& stated) {
        worker_.Post([this, stated, odometry = newest_odometry_] {
          pipeline_->PlaceRover(*stated, odometry);
        });
      });
  save_ =
      OfferTrigger(private_node, "save_trajectory", [this] { return pipeline_->SaveTrajectory(); });
  timer_ = node.createWallTimer(ros::WallDuration(1), [this](const ros::WallTimerEvent&) {
    diagnostics_.force_update();
    worker_.PostLossy([this] { pipeline_->AdjustIfSettled(); });
  });
  if (pipeline_->transform().publish_tf)
    tf_timer_ = node.createTimer(ros::Duration(1 / pipeline_->transform().tf_rate_hz),
                                 [this](const ros::TimerEvent&) { SendTransform(); });
}

BaNode::Impl::~Impl() {
  if (pipeline_->saves_at_end())
    TellSavedAtEnd("the keyframes are", [this] { return pipeline_->SaveTrajectory(); });
}

void BaNode::Impl::SendTransform() {
  const MapTransformOptions& options = pipeline_->transform();
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = ros::Time::now() + ros::Duration(options.tf_tolerance_s);
  if (transform.header.stamp == sent_) return;  // simulated time jumped, and the timer catches up
  sent_ = transform.header.stamp;
  transform.header.frame_id = options.map_frame;
  transform.child_frame_id = options.odom_frame;
  transform.transform = pipeline_->MapFromOdom();
  broadcaster_.sendTransform(transform);
}

}  // namespace arfm_vo
