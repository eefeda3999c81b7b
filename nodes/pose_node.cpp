#include "arfm_vo/ros/odometry/pose_node.h"

#include "arfm_vo/ros/node/node_main.h"

int main(int argc, char** argv) {
  return arfm_vo::RunNode<arfm_vo::PoseNode, arfm_vo::PoseNodeOptions>(
      argc, argv, "pose_node", R"(Features and the images they are from in, the rover's pose out.

in    features, stereo/left|right/image_rect, map_update; imu (sensor_msgs/Imu) and track_odom
      (nav_msgs/Odometry) where senses/use_imu and senses/use_tracks ask for them
out   odom (nav_msgs/Odometry), path, status (arfm_vo/OdometryStatus), keyframe, matches_image, features_request,
      /diagnostics
tf    in base_frame <- camera at each image's stamp, base_frame <- imu; out odom_frame -> base_frame
srv   ~reset, ~save_trajectory (std_srvs/Trigger))");
}
