#pragma once

#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <sensor_msgs/Imu.h>
#include <tf2/buffer_core.h>

#include <deque>
#include <functional>
#include <string>

#include "arfm_vo/base/worker.h"
#include "arfm_vo/odometry/senses/senses.h"
#include "arfm_vo/ros/node/health.h"

namespace arfm_vo {

/// Gives the odometry's senses what comes on `imu` and `track_odom`, where its options ask for
/// them.
class SenseInputs {
 public:
  /// `buffer` and `worker`, in whose jobs `senses` is called, must outlive this object.
  SenseInputs(ros::NodeHandle& node, const SensesOptions& options, std::string base_frame,
              const tf2::BufferCore& buffer, Worker& worker, std::function<Senses&()> senses);

  /// Within a job: WARN where a sense is silent, refused or left out.
  void Report(Diagnostics& status);

 private:
  struct Input {
    std::string topic;
    Refusals refusals;
    int num_since_report = 0;
    ros::Subscriber subscriber;
  };
  template <class Message>
  void Subscribe(ros::NodeHandle& node, const std::string& topic, Worker& worker);
  /// Throws std::invalid_argument naming topic and field.
  void Take(const sensor_msgs::Imu& imu);
  void Take(const nav_msgs::Odometry& tracks);

  std::string base_frame_;
  const tf2::BufferCore& buffer_;
  std::function<Senses&()> senses_;
  ConsoleWatch watch_;
  std::deque<Input> inputs_;
};

}  // namespace arfm_vo
