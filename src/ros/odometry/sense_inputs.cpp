#include "arfm_vo/ros/odometry/sense_inputs.h"

#include <tf2_eigen/tf2_eigen.h>

#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/ros/messages/conversions.h"
#include "arfm_vo/ros/messages/transforms.h"

namespace arfm_vo {
namespace {

constexpr int kReadingQueueSize = 200;

}  // namespace

SenseInputs::SenseInputs(ros::NodeHandle& node, const SensesOptions& options,
                         std::string base_frame, const tf2::BufferCore& buffer, Worker& worker,
                         std::function<Senses&()> senses)
    : base_frame_(std::move(base_frame)), buffer_(buffer), senses_(std::move(senses)) {
  if (options.use_imu) Subscribe<sensor_msgs::Imu>(node, "imu", worker);
  if (options.use_tracks) Subscribe<nav_msgs::Odometry>(node, "track_odom", worker);
}

template <class Message>
void SenseInputs::Subscribe(ros::NodeHandle& node, const std::string& topic, Worker& worker) {
  const std::string name = node.resolveName(topic);
  inputs_.push_back({name, Refusals("reading of " + name), 0, {}});
  Input& input = inputs_.back();
  const auto take = [this, &worker, &input](const boost::shared_ptr<const Message>& message) {
    worker.Post([this, &input, message] {
      ++input.num_since_report;
      try {
        Take(*message);
        input.refusals.Clear();
      } catch (const std::invalid_argument& error) {
        input.refusals.Add(error.what());
      }
    });
  };
  input.subscriber = node.subscribe<Message>(topic, kReadingQueueSize, take, {},
                                             ros::TransportHints().tcpNoDelay());
}

void SenseInputs::Take(const sensor_msgs::Imu& imu) {
  Eigen::Vector3d rate, force;
  tf2::fromMsg(imu.angular_velocity, rate);
  tf2::fromMsg(imu.linear_acceleration, force);
  Require(rate.norm() <= 100, "imu: angular_velocity is not one of a rover");
  Require(imu.angular_velocity_covariance[0] >= 0,
          "imu: angular_velocity_covariance[0] is negative: it has no gyro");
  Require(force.norm() <= 1000, "imu: linear_acceleration is not one of a rover");
  const Rigid3 base_from_imu =
      LookUpTransform(buffer_, base_frame_, imu.header.frame_id, ros::Time()).target_from_source;
  senses_().gyro().Add(imu.header.stamp.toSec(), base_from_imu.rotation * rate);
  const bool has_accelerometer = imu.linear_acceleration_covariance[0] >= 0;
  if (!has_accelerometer) return;
  senses_().gravity().Add(imu.header.stamp.toSec(), base_from_imu.rotation * force);
}

void SenseInputs::Take(const nav_msgs::Odometry& tracks) {
  Require(tracks.child_frame_id == base_frame_,
          "track_odom: child_frame_id is '" + tracks.child_frame_id + "', not " + base_frame_);
  senses_().tracks().Add(tracks.header.stamp.toSec(), ReadPose(tracks.pose.pose, "track_odom: "));
}

void SenseInputs::Report(Diagnostics& status) {
  std::string problem = senses_().FindFaults();
  for (Input& input : inputs_) {
    if (std::exchange(input.num_since_report, 0) > 0) continue;
    problem += (problem.empty() ? "" : "; ") + ("nothing comes on " + input.topic);
  }
  for (const SenseState* state :
       {&senses_().gyro().state(), &senses_().gravity().state(), &senses_().tracks().state()}) {
    for (const auto& [name, text] : state->Describe()) status.add(name, text);
  }
  if (watch_.IsDue(problem)) ROS_WARN("%s", problem.c_str());
  for (const Input& input : inputs_) {
    if (input.refusals.IsTold(status)) return;
  }
  if (!problem.empty()) return status.summary(Diagnostics::WARN, problem);
  status.summary(Diagnostics::OK, "they agree with the cameras");
}

}  // namespace arfm_vo
