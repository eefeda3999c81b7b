#include "arfm_vo/ros/odometry/map_shift.h"

#include "arfm_vo/base/check.h"
#include "arfm_vo/driving/route.h"
#include "arfm_vo/driving/rover_pose.h"
#include "arfm_vo/ros/messages/pose_message.h"

namespace arfm_vo {

Rigid3 FindMapShift(const geometry_msgs::PoseWithCovarianceStamped& stated,
                    const std::string& map_frame, const Rigid3& map_from_base) {
  Require(stated.header.frame_id == map_frame, "initialpose: must be in the frame " + map_frame +
                                                   ", is in '" + stated.header.frame_id + "'");
  Rigid3 stated_pose = ToRigid3(stated.pose.pose);
  const std::string flaw = FindGoalFlaw(stated_pose);
  Require(flaw.empty(), "initialpose: " + flaw);
  stated_pose.rotation.normalize();
  const RoverPose from = ProjectToPlane(map_from_base), to = ProjectToPlane(stated_pose);
  Rigid3 shift(ExpSO3({0, 0, to.heading_rad - from.heading_rad}), Eigen::Vector3d::Zero());
  shift.translation =
      Eigen::Vector3d(to.x_m, to.y_m, 0) - shift.rotation * Eigen::Vector3d(from.x_m, from.y_m, 0);
  return shift;
}

}  // namespace arfm_vo
