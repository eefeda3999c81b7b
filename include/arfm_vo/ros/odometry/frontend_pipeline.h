#pragma once

#include <arfm_vo/StereoFrameStamped.h>

#include <memory>

#include "arfm_vo/ros/input/stereo_input.h"

namespace arfm_vo {

/// What arfm_node does with a pair. Of the worker's thread. An interface, so that what subscribes
/// is compiled without the odometry.
class FrontendPipeline {
 public:
  virtual ~FrontendPipeline() = default;

  /// The features and stereo points of the pair, with its header and the time of each stage.
  /// Throws std::invalid_argument where the pair is malformed.
  virtual StereoFrameStampedPtr Process(const StereoMessagePair& pair) = 0;
  /// After a jump of time.
  virtual void Reset() = 0;

  virtual int max_waiting_pairs() const = 0;  ///< of any thread
};

/// Reads ArfmNodeOptions; throws std::invalid_argument naming a wrong parameter.
std::unique_ptr<FrontendPipeline> MakeFrontendPipeline(const ros::NodeHandle& private_node,
                                                       const StereoTopics& topics);

}  // namespace arfm_vo
