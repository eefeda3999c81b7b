#include <pluginlib/class_list_macros.hpp>

#include "arfm_vo/ros/node/node_main.h"
#include "arfm_vo/ros/odometry/arfm_node.h"
#include "arfm_vo/ros/odometry/ba_node.h"
#include "arfm_vo/ros/odometry/pose_node.h"
#include "arfm_vo/ros/rover/pan_tilt_node.h"
#include "arfm_vo/ros/rover/stereo_camera_node.h"

namespace arfm_vo {

class ArfmNodelet : public NodeletOf<ArfmNode> {};
class PoseNodelet : public NodeletOf<PoseNode> {};
class BaNodelet : public NodeletOf<BaNode> {};
class StereoCameraNodelet : public NodeletOf<StereoCameraNode> {};
class PanTiltNodelet : public NodeletOf<PanTiltNode> {};

}  // namespace arfm_vo

PLUGINLIB_EXPORT_CLASS(arfm_vo::ArfmNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(arfm_vo::PoseNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(arfm_vo::BaNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(arfm_vo::StereoCameraNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(arfm_vo::PanTiltNodelet, nodelet::Nodelet)
