#include "arfm_vo/driving/route.h"

#include <algorithm>
#include <cmath>

namespace arfm_vo {
namespace {

constexpr double kMaxQuaternionError = 1e-2;
constexpr double kMaxCoordinate_m = 1e5;
constexpr double kMinLevelPart = 0.2;  // of the x axis: 78 degrees of pitch

}  // namespace

RoverPose ProjectToPlane(const Rigid3& map_from_base) {
  const Eigen::Vector3d forward = map_from_base.rotation * Eigen::Vector3d::UnitX();
  return {map_from_base.translation.x(), map_from_base.translation.y(),
          std::atan2(forward.y(), forward.x())};
}

Rigid3 LiftFromPlane(const RoverPose& pose) {
  return {ExpSO3({0, 0, pose.heading_rad}), Eigen::Vector3d(pose.x_m, pose.y_m, 0)};
}

double TiltOf(const Rigid3& map_from_base) {
  const Eigen::Vector3d up = map_from_base.rotation.normalized() * Eigen::Vector3d::UnitZ();
  return std::acos(std::clamp(up.z(), -1.0, 1.0));
}

RoverPose Advance(const RoverPose& pose, double forward_m, double turn_rad) {
  const double half = turn_rad / 2;
  const double chord_m = forward_m * (std::abs(half) < 1e-6 ? 1 : std::sin(half) / half);
  const double direction_rad = pose.heading_rad + half;
  return {pose.x_m + chord_m * std::cos(direction_rad),
          pose.y_m + chord_m * std::sin(direction_rad), WrapAngle(pose.heading_rad + turn_rad)};
}

std::string FindGoalFlaw(const Rigid3& map_from_goal) {
  if (!map_from_goal.translation.allFinite()) return "its position is not finite";
  if (!map_from_goal.rotation.coeffs().allFinite()) return "its orientation is not finite";
  if (map_from_goal.translation.norm() > kMaxCoordinate_m) return "it is more than 100 km away";
  if (std::abs(map_from_goal.rotation.norm() - 1) > kMaxQuaternionError)
    return "its quaternion is not of unit length";
  const Eigen::Vector3d forward = map_from_goal.rotation.normalized() * Eigen::Vector3d::UnitX();
  if (forward.head<2>().norm() < kMinLevelPart) return "its x axis stands on end";
  return "";
}

Waypoint ToWaypoint(const Rigid3& map_from_goal) {
  const RoverPose pose = ProjectToPlane(map_from_goal);
  return {pose.x_m, pose.y_m, pose.heading_rad};
}

}  // namespace arfm_vo
