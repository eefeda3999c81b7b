#pragma once

#include <std_msgs/Header.h>

#include "arfm_vo/odometry/session.h"
#include "arfm_vo/ros/messages/transforms.h"
#include "arfm_vo/ros/odometry/mount_log.h"

namespace arfm_vo {

/// Takes a pair, whose left image has `header`, with the camera where tf says it was at that stamp.
/// Skipped where tf cannot tell or the head was slewing. Where the camera sat goes to `mounts`, if
/// not null.
SessionUpdate ProcessMounted(Session& session, const CameraMount& mount, const StereoFrame& frame,
                             const StereoCamera& camera, const StereoImages& images,
                             const std_msgs::Header& header, MountLog* mounts = nullptr);

}  // namespace arfm_vo
