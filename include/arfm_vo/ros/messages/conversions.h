#pragma once

#include <arfm_vo/KeyframeStamped.h>
#include <arfm_vo/MapUpdateStamped.h>
#include <arfm_vo/RectifiedStereo.h>
#include <arfm_vo/StereoFrameStamped.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Transform.h>

#include <boost/array.hpp>
#include <string>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/mapping/map_update.h"
#include "arfm_vo/mapping/placed_keyframe.h"
#include "arfm_vo/reconstruction/stereo_frame.h"

namespace arfm_vo {

// The core's nouns as messages and back. A message carries its noun to the last bit, but for the
// stamp, which ROS keeps in nanoseconds. What comes from a message is checked: arrays of unequal
// length, an index that points nowhere, a value that is not finite, a quaternion that is not of
// unit length or a wrong camera throw std::invalid_argument naming message and field.

geometry_msgs::Transform ToTransformMessage(const Rigid3& b_from_a);
geometry_msgs::Pose ToPoseMessage(const Rigid3& b_from_a);
/// `name` is what the error calls it, such as "KeyframeStamped: base_from_camera".
Rigid3 FromMessage(const geometry_msgs::Transform& message, const std::string& name);
Rigid3 FromMessage(const geometry_msgs::Pose& message, const std::string& name);
/// The pose as the message has it: whether it is finite and its quaternion of unit length is not
/// checked.
Rigid3 ToRigid3(const geometry_msgs::Pose& pose);
/// The pose that somebody states, its quaternion normalised. Throws std::invalid_argument, `prefix`
/// and the flaw, where it can be no pose of a rover (FindGoalFlaw).
Rigid3 ReadPose(const geometry_msgs::Pose& pose, const std::string& prefix);
/// A pose's or twist's covariance row by row.
boost::array<double, 36> ToCovarianceMessage(const Eigen::Matrix<double, 6, 6>& covariance);

RectifiedStereo ToMessage(const StereoCamera& camera);
StereoCamera FromMessage(const RectifiedStereo& message);

/// Fills header.stamp and the fields of the frame; frame_id, counts of pairs and stages are the
/// caller's.
StereoFrameStamped ToMessage(const StereoFrame& frame, const StereoCamera& camera);
StereoFrame FromMessage(const StereoFrameStamped& message);

/// Fills header.stamp, not frame_id.
KeyframeStamped ToMessage(const PlacedKeyframe& keyframe);
PlacedKeyframe FromMessage(const KeyframeStamped& message);

/// Fills the fields of the update; header and epoch are the caller's.
MapUpdateStamped ToMessage(const MapUpdate& update);
MapUpdate FromMessage(const MapUpdateStamped& message);

}  // namespace arfm_vo
