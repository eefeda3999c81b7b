#include "arfm_vo/ros/rover/chassis_inputs.h"

#include <cmath>
#include <limits>
#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/geometry/linear_algebra.h"
#include "arfm_vo/ros/messages/conversions.h"
#include "arfm_vo/ros/messages/transforms.h"

namespace arfm_vo {

void GoalReader::RequireFresh(const std_msgs::Header& header, const ros::Time& now) const {
  constexpr double kMaxFromFuture_s = 1;
  Require(!header.stamp.isZero(), "goal refused: it has no stamp");
  const double age_s = now.toSec() - header.stamp.toSec();
  Require(age_s >= -kMaxFromFuture_s, "goal refused: its stamp is in the future");
  Require(age_s <= max_age_s, "goal refused: it is " + std::to_string(std::lround(age_s)) +
                                  " s old, older than " + std::to_string(max_age_s) + " s");
}

Waypoint GoalReader::Read(const geometry_msgs::PoseStamped& goal) const {
  const std::string& frame = goal.header.frame_id;
  Require(!frame.empty(), "goal refused: it has no frame_id");
  const Rigid3 frame_from_goal = ReadPose(goal.pose, "goal refused: ");
  if (frame == map_frame) return ToWaypoint(frame_from_goal);
  const Rigid3 map_from_frame = Within("goal refused: frame '" + frame + "'", [&] {
    return LookUpTransform(buffer, map_frame, frame, ros::Time(0)).target_from_source;
  });
  const std::string flaw = FindGoalFlaw(map_from_frame * frame_from_goal);
  Require(flaw.empty(), "goal refused: in " + map_frame + " " + flaw);
  return ToWaypoint(map_from_frame * frame_from_goal);
}

Route GoalReader::Read(const nav_msgs::Path& path) const {
  Require(!path.poses.empty(), "path refused: it has no poses");
  Route route;
  for (geometry_msgs::PoseStamped pose : path.poses) {
    if (pose.header.frame_id.empty()) pose.header.frame_id = path.header.frame_id;
    Within("pose " + std::to_string(route.size()) + " of the path",
           [&] { route.push_back(Read(pose)); });
  }
  return route;
}

PlanarMotion ReadVelocity(const geometry_msgs::Twist& twist) {
  const PlanarMotion motion{twist.linear.x, twist.angular.z};
  Require(motion.IsFinite(), "velocity refused: it is not finite");
  const bool is_planar =
      twist.linear.y == 0 && twist.linear.z == 0 && twist.angular.x == 0 && twist.angular.y == 0;
  Require(is_planar, "velocity refused: a tracked rover moves along x and turns about z only");
  return motion;
}

std::optional<Sighting> RoverSight::Look() const {
  try {
    const auto base = LookUpTransform(buffer, odom_frame, base_frame, ros::Time(0));
    Sighting sighting{base.stamp, base.target_from_source, {}, {}};
    if (map_frame != odom_frame) {
      const auto odom = LookUpTransform(buffer, map_frame, odom_frame, ros::Time(0));
      sighting.map_from_odom = odom.target_from_source;
      sighting.map_stamp = odom.stamp;
    }
    return sighting;
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

geometry_msgs::PoseStamped RoverSight::BaseInMap(const Sighting& sighting) const {
  geometry_msgs::PoseStamped base;
  base.header.stamp = sighting.stamp;
  base.header.frame_id = map_frame;
  base.pose = ToPoseMessage(sighting.map_from_odom * sighting.odom_from_base);
  return base;
}

PoseUncertainty ToUncertainty(const nav_msgs::Odometry& odometry, double taken_s) {
  const auto& covariance = odometry.pose.covariance;
  PoseUncertainty uncertainty{taken_s, std::numeric_limits<double>::quiet_NaN(),
                              std::sqrt(covariance[35])};
  Eigen::Matrix2d position;
  position << covariance[0], covariance[1], covariance[6], covariance[7];
  if (!position.allFinite()) return uncertainty;
  const SymmetricEigen axes(position);
  if (axes.values[0] >= 0) uncertainty.position_sigma_m = std::sqrt(axes.values[1]);
  return uncertainty;
}

Picture ToPicture(const OdometryStatus& status, double taken_s) {
  return {taken_s, status.grey_mean, status.num_inliers, status.num_seen_by_both};
}

uint32_t EpochReader::Read(const ros::MessageEvent<const OdometryStatus>& event) {
  // roscpp hands out the same header with all messages of a connection.
  const uint32_t number = event.getConstMessage()->epoch;
  const auto& connection = event.getConnectionHeaderPtr();
  if (epoch_ == 0 || number != number_ || connection != connection_) ++epoch_;
  number_ = number;
  connection_ = connection;
  return epoch_;
}

double DrivingClock::Now() {
  if (!ros::Time::isSimTime()) return ros::SteadyTime::now().toSec();
  const ros::Time now = ros::Time::now();
  const double step_s = last_.isZero() ? 0 : now.toSec() - last_.toSec();
  (step_s > 0 ? simulated_s_ : back_s_) += step_s;
  last_ = now;
  return simulated_s_;
}

double DrivingClock::TakeStep() {
  if (ros::Time::isSimTime()) return std::exchange(back_s_, 0);
  const double before_s = offset_.offset_s();
  const int num_before = offset_.num_jumps();
  offset_.ToWall(0);
  return offset_.num_jumps() == num_before ? 0 : offset_.offset_s() - before_s;
}

}  // namespace arfm_vo
