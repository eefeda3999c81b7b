#include "arfm_vo/ros/rover/rover_sight.h"

#include <tf2/exceptions.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <utility>

#include "arfm_vo/ros/messages/conversions.h"

namespace arfm_vo {

RoverSight::RoverSight(const tf2::BufferCore& buffer, std::string map_frame, std::string odom_frame,
                       std::string base_frame)
    : buffer_(buffer),
      map_frame_(std::move(map_frame)),
      odom_frame_(std::move(odom_frame)),
      base_frame_(std::move(base_frame)) {}

std::optional<Sighting> RoverSight::Look() const {
  const auto look_up = [this](const std::string& target, const std::string& source) {
    return buffer_.lookupTransform(target, source, ros::Time(0));
  };
  try {
    const auto base = look_up(odom_frame_, base_frame_);
    Sighting sighting;
    sighting.stamp = base.header.stamp;
    sighting.odom_from_base = FromMessage(base.transform, "tf to " + base_frame_);
    if (map_frame_ != odom_frame_) {
      const auto odom = look_up(map_frame_, odom_frame_);
      sighting.map_from_odom = FromMessage(odom.transform, "tf to " + odom_frame_);
      sighting.map_stamp = odom.header.stamp;
    }
    return sighting;
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  } catch (const std::invalid_argument&) {  // a transform that is not one
    return std::nullopt;
  }
}

PoseUncertainty ToUncertainty(const nav_msgs::Odometry& odometry, double taken_s) {
  const auto& covariance = odometry.pose.covariance;
  PoseUncertainty uncertainty{taken_s, std::numeric_limits<double>::quiet_NaN(),
                              std::sqrt(covariance[35])};
  Eigen::Matrix2d position;
  position << covariance[0], covariance[1], covariance[6], covariance[7];
  if (!position.allFinite()) return uncertainty;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(position, Eigen::EigenvaluesOnly);
  if (solver.eigenvalues().x() >= 0)
    uncertainty.position_sigma_m = std::sqrt(solver.eigenvalues().y());
  return uncertainty;
}

}  // namespace arfm_vo
