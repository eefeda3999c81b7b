#include <pluginlib/class_list_macros.hpp>

#include "arfm_vo/ros/node/node_main.h"
#include "arfm_vo/ros/odometry/arfm_node.h"
#include "arfm_vo/ros/odometry/ba_node.h"
#include "arfm_vo/ros/odometry/pose_node.h"

namespace arfm_vo {

class ArfmNodelet : public NodeletOf<ArfmNode> {};
class PoseNodelet : public NodeletOf<PoseNode> {};
class BaNodelet : public NodeletOf<BaNode> {};

}  // namespace arfm_vo

PLUGINLIB_EXPORT_CLASS(arfm_vo::ArfmNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(arfm_vo::PoseNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(arfm_vo::BaNodelet, nodelet::Nodelet)
