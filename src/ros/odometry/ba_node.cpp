#include "arfm_vo/ros/odometry/ba_node.h"

#include "arfm_vo/ros/messages/transforms.h"
#include "arfm_vo/ros/node/parameters.h"
#include "arfm_vo/ros/node/services.h"

namespace arfm_vo {

BaNode::BaNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : options_(ReadParameters<BaNodeOptions>(private_node)),
      map_(node, options_, [this] { return worker_.is_stopping(); }),
      diagnostics_(node, private_node, private_node.getNamespace()),
      worker_(1, [this](const std::exception& error) {
        map_.CountRefused(error);
        ROS_ERROR_THROTTLE(5, "keyframe refused: %s", error.what());
      }) {
  diagnostics_.setHardwareID("arfm_vo");
  diagnostics_.add("global adjustment", [this](Diagnostics& status) { map_.Report(status); });
  keyframes_ = node.subscribe<KeyframeStamped>(
      "keyframe", 100, [this](const KeyframeStampedConstPtr& keyframe) {
        worker_.Post([this, keyframe] { map_.Add(*keyframe); });
      });
  odometry_ = node.subscribe<nav_msgs::Odometry>(
      "odom", 1, [this](const auto& odometry) { newest_odometry_ = odometry; });
  stated_ = node.subscribe<geometry_msgs::PoseWithCovarianceStamped>(
      "initialpose", 1, [this](const auto& stated) {
        worker_.Post(
            [this, stated, odometry = newest_odometry_] { map_.PlaceRover(*stated, odometry); });
      });
  save_ = OfferTrigger(private_node, "save_trajectory", [this] { return map_.SaveTrajectory(); });
  timer_ = node.createWallTimer(ros::WallDuration(1), [this](const ros::WallTimerEvent&) {
    diagnostics_.force_update();
    worker_.PostLossy([this] { map_.AdjustIfSettled(); });
  });
  if (options_.publish_tf)
    tf_timer_ = node.createTimer(ros::Duration(1 / options_.tf_rate_hz),
                                 [this](const ros::TimerEvent&) { SendTransform(); });
}

BaNode::~BaNode() {
  if (map_.saves_at_end())
    TellSavedAtEnd("the keyframes are", [this] { return map_.SaveTrajectory(); });
}

void BaNode::SendTransform() {
  const ros::Time stamp = ros::Time::now() + ros::Duration(options_.tf_tolerance_s);
  if (stamp == sent_) return;  // simulated time jumped, and the timer catches up
  sent_ = stamp;
  broadcaster_.sendTransform(
      MakeTransform(stamp, options_.map_frame, options_.odom_frame, map_.MapFromOdom()));
}

}  // namespace arfm_vo
