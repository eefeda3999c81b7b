#pragma once

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>
#include <tf2/buffer_core.h>

#include <optional>
#include <string>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// `parent_from_child` as tf's message.
geometry_msgs::TransformStamped MakeTransform(const ros::Time& stamp, const std::string& parent,
                                              const std::string& child,
                                              const Rigid3& parent_from_child);

/// What tf tells, at most at the stamp that was asked for.
struct StampedTransform {
  ros::Time stamp;
  Rigid3 target_from_source;
};

/// Looks a transform up, the newest one where `stamp` is zero. Throws std::invalid_argument naming
/// the frames where tf has none, or one that is no rigid motion.
StampedTransform LookUpTransform(const tf2::BufferCore& buffer, const std::string& target,
                                 const std::string& source, const ros::Time& stamp);

/// Puts a transform that `source` has published into `buffer`. Returns false where its stamp is too
/// far ahead of `now`: it would hold back all later ones, and the largest stamp makes tf2 throw. A
/// static one holds at all times, whatever its stamp.
bool AddTransform(geometry_msgs::TransformStamped transform, bool is_static, const ros::Time& now,
                  const std::string& source, tf2::BufferCore& buffer);

/// How the map frame moves, within its x-y plane, where a person states that the rover stands at
/// `stated` and not at `map_from_base`; new_map_from_map. Height, roll and pitch stay. Throws
/// std::invalid_argument where `stated` is no pose in the frame `map_frame`.
Rigid3 FindMapShift(const geometry_msgs::PoseWithCovarianceStamped& stated,
                    const std::string& map_frame, const Rigid3& map_from_base);

/// Covariance of x, y (m) and the heading (rad) as stated; zero where what is stated is none.
Eigen::Matrix3d PlanarCovariance(const geometry_msgs::PoseWithCovarianceStamped& stated);

/// Lays recorded truth, the camera's pose in a world of its own, over the odometry: the first true
/// pose is where the odometry says that the camera is at that stamp.
struct TruthAlignment {
  const tf2::BufferCore& buffer;  ///< must outlive this
  std::string reference_frame, base_frame, camera_frame;
  std::optional<Rigid3> reference_from_truth = {};  ///< not before the first pose; reset: anew

  /// The true pose of the base in the reference frame; nothing where tf cannot tell yet.
  std::optional<Rigid3> Align(const ros::Time& stamp, const Rigid3& truth_from_camera);
};

}  // namespace arfm_vo
