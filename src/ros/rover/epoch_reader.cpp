#include "arfm_vo/ros/rover/epoch_reader.h"

namespace arfm_vo {

uint32_t EpochReader::Read(const ros::MessageEvent<const OdometryStatus>& event) {
  // roscpp hands out the same header with all messages of a connection.
  const uint32_t number = NumberIn(*event.getConstMessage());
  const auto& connection = event.getConnectionHeaderPtr();
  if (epoch_ == 0 || number != number_ || connection != connection_) ++epoch_;
  number_ = number;
  connection_ = connection;
  return epoch_;
}

}  // namespace arfm_vo
