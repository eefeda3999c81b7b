#pragma once

#include <arfm_vo/KeyframeStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/Transform.h>
#include <nav_msgs/Odometry.h>

#include <exception>
#include <functional>
#include <memory>
#include <string>

#include "arfm_vo/base/check.h"

namespace diagnostic_updater {
class DiagnosticStatusWrapper;
}
namespace ros {
class NodeHandle;
}

namespace arfm_vo {

struct MapTransformOptions {
  std::string map_frame = "map";    ///< adjusted; its newest pose may jump
  std::string odom_frame = "odom";  ///< that of pose_node, continuous
  bool publish_tf = true;           ///< map_frame -> odom_frame
  double tf_rate_hz = 20;           ///< of the transform
  double tf_tolerance_s = 0.1;      ///< how far into the future a transform is said to hold

  void Check() const {
    Require(!map_frame.empty(), "map_frame must not be empty");
    Require(!odom_frame.empty(), "odom_frame must not be empty");
    Require(tf_rate_hz > 0, "tf_rate_hz must be positive");
    Require(tf_tolerance_s >= 0, "tf_tolerance_s must not be negative");
  }
  template <class Visitor>
  void VisitFields(Visitor&& visit) {
    visit("map_frame", map_frame);
    visit("odom_frame", odom_frame);
    visit("publish_tf", publish_tf);
    visit("tf_rate_hz", tf_rate_hz);
    visit("tf_tolerance_s", tf_tolerance_s);
  }
};

/// What ba_node does with keyframes: the map, its adjustments, and what is published of it. Of the
/// worker's thread. An interface, so that what subscribes is compiled without the odometry.
class MapPipeline {
 public:
  virtual ~MapPipeline() = default;

  virtual void Add(const KeyframeStamped& message) = 0;
  /// Where no keyframe comes any more, the newest ones are adjusted too.
  virtual void AdjustIfSettled() = 0;
  /// Where a person states that the rover stands; `odometry` is the newest, null where there is
  /// none.
  virtual void PlaceRover(const geometry_msgs::PoseWithCovarianceStamped& stated,
                          const nav_msgs::OdometryConstPtr& odometry) = 0;
  virtual void CountRefused(const std::exception& error) = 0;

  // Of any thread, also while adjusting:
  virtual void Report(diagnostic_updater::DiagnosticStatusWrapper& status) const = 0;
  virtual geometry_msgs::Transform MapFromOdom() const = 0;
  /// Saves the keyframes. Returns what was written, in words.
  virtual std::string SaveTrajectory() const = 0;
  virtual bool saves_at_end() const = 0;
  virtual const MapTransformOptions& transform() const = 0;
};

/// Reads BaNodeOptions; throws std::invalid_argument naming a wrong parameter. Adjusting ends early
/// where `is_stopping`.
std::unique_ptr<MapPipeline> MakeMapPipeline(ros::NodeHandle node,
                                             const ros::NodeHandle& private_node,
                                             std::function<bool()> is_stopping);

}  // namespace arfm_vo
