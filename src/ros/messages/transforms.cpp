#include "arfm_vo/ros/messages/transforms.h"

#include <tf2/exceptions.h>


#include "arfm_vo/base/check.h"
#include "arfm_vo/driving/route.h"
#include "arfm_vo/geometry/linear_algebra.h"
#include "arfm_vo/ros/messages/conversions.h"

namespace arfm_vo {

geometry_msgs::TransformStamped MakeTransform(const ros::Time& stamp, const std::string& parent,
                                              const std::string& child,
                                              const Rigid3& parent_from_child) {
  geometry_msgs::TransformStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = parent;
  message.child_frame_id = child;
  message.transform = ToTransformMessage(parent_from_child);
  return message;
}

StampedTransform LookUpTransform(const tf2::BufferCore& buffer, const std::string& target,
                                 const std::string& source, const ros::Time& stamp) {
  const std::string name = "tf " + target + " <- " + source;
  try {
    const auto message = buffer.lookupTransform(target, source, stamp);
    return {message.header.stamp, FromMessage(message.transform, name)};
  } catch (const tf2::TransformException& error) {
    throw std::invalid_argument(name + ": " + error.what());
  }
}

bool AddTransform(geometry_msgs::TransformStamped transform, bool is_static, const ros::Time& now,
                  const std::string& source, tf2::BufferCore& buffer) {
  constexpr double kMaxFromFuture_s = 1;
  // Where the frame was told as moving before, tf2 keeps it so and does reckon with the stamp.
  if (is_static) transform.header.stamp = now;
  if (transform.header.stamp.toSec() > now.toSec() + kMaxFromFuture_s) return false;
  buffer.setTransform(transform, source, is_static);
  return true;
}

std::optional<Rigid3> TruthAlignment::Align(const ros::Time& stamp,
                                            const Rigid3& truth_from_camera) {
  const auto target_from_camera = [&](const std::string& target) {
    return LookUpTransform(buffer, target, camera_frame, stamp).target_from_source;
  };
  try {
    const Rigid3 base_from_camera = target_from_camera(base_frame);
    if (!reference_from_truth)
      reference_from_truth = target_from_camera(reference_frame) * truth_from_camera.Inverse();
    return *reference_from_truth * truth_from_camera * base_from_camera.Inverse();
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

Rigid3 FindMapShift(const geometry_msgs::PoseWithCovarianceStamped& stated,
                    const std::string& map_frame, const Rigid3& map_from_base) {
  Require(stated.header.frame_id == map_frame, "initialpose: must be in the frame " + map_frame +
                                                   ", is in '" + stated.header.frame_id + "'");
  const RoverPose from = ProjectToPlane(map_from_base);
  const RoverPose to = ProjectToPlane(ReadPose(stated.pose.pose, "initialpose: "));
  Rigid3 shift(ExpSO3({0, 0, to.heading_rad - from.heading_rad}), Eigen::Vector3d::Zero());
  shift.translation =
      Eigen::Vector3d(to.x_m, to.y_m, 0) - shift.rotation * Eigen::Vector3d(from.x_m, from.y_m, 0);
  return shift;
}

Eigen::Matrix3d PlanarCovariance(const geometry_msgs::PoseWithCovarianceStamped& stated) {
  constexpr int kRows[] = {0, 1, 5};
  Eigen::Matrix3d covariance;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) covariance(i, k) = stated.pose.covariance[6 * kRows[i] + kRows[k]];
  return IsPositiveDefinite(covariance) ? covariance : Eigen::Matrix3d::Zero();
}

}  // namespace arfm_vo
