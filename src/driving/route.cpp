#include "arfm_vo/driving/route.h"

#include <cmath>

#include "arfm_vo/driving/rover_pose.h"

namespace arfm_vo {
namespace {

constexpr double kMaxQuaternionError = 1e-2;
constexpr double kMaxCoordinate_m = 1e5;
constexpr double kMinLevelPart = 0.2;  // of the x axis: 78 degrees of pitch

}  // namespace

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
