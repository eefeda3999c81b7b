#pragma once

#include <arfm_vo/OdometryStatus.h>
#include <ros/message_event.h>

#include <cstdint>

namespace arfm_vo {

/// Numbers the epochs of the odometry, in each of which its pose is continuous. A new one begins
/// where the number in `status` changes, and where the messages come from another process.
class EpochReader {
 public:
  /// Counts from 1.
  uint32_t Read(const ros::MessageEvent<const OdometryStatus>& event);

 private:
  static uint32_t NumberIn(const OdometryStatus& status) { return status.epoch; }

  uint32_t epoch_ = 0, number_ = 0;
  boost::shared_ptr<ros::M_string> connection_;
};

}  // namespace arfm_vo
