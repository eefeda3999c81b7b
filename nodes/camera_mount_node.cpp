// Publishes the camera's place on the rover as a static tf, where no robot description tells it: in
// the frame of the left camera_info of the namespace `stereo`, or in ~camera_frame.
#include <tf2_ros/static_transform_broadcaster.h>

#include <sstream>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/ros/input/stereo_input.h"
#include "arfm_vo/ros/input/transform_input.h"
#include "arfm_vo/ros/messages/transforms.h"
#include "arfm_vo/ros/node/node_main.h"
#include "arfm_vo/ros/node/parameters.h"

namespace arfm_vo {
namespace {

/// Wall time from the first camera_info that tf gets to tell the mount, where is_default.
constexpr double kWait_s = 0.3;

struct CameraMountNodeOptions {
  std::string base_frame = "base_link";  ///< of the rover
  std::string camera_frame;      ///< left optical frame; empty: that of the left camera_info
  std::string base_from_camera;  ///< "x y z yaw pitch roll", m and rad
  bool is_default = false;  ///< nobody asked for this mount: warn, and let tf tell another first

  void Check() const {
    Require(!base_frame.empty(), "base_frame must not be empty");
    ParseMount();
  }
  /// Throws std::invalid_argument where base_from_camera is not six numbers.
  Rigid3 ParseMount() const {
    std::istringstream text(base_from_camera);
    double x = 0, y = 0, z = 0, yaw = 0, pitch = 0, roll = 0;
    std::string rest;
    const bool is_read =
        static_cast<bool>(text >> x >> y >> z >> yaw >> pitch >> roll) && !(text >> rest);
    Require(is_read,
            "base_from_camera must be six numbers \"x y z yaw pitch roll\" in m and rad, is \"" +
                base_from_camera + "\"");
    const Eigen::Quaterniond rotation = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                        Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                                        Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
    return {rotation, {x, y, z}};
  }
  ARFM_FIELDS(base_frame, camera_frame, base_from_camera, is_default)
};

class CameraMountNode {
 public:
  CameraMountNode(ros::NodeHandle node, ros::NodeHandle private_node)
      : options_(ReadParameters<CameraMountNodeOptions>(private_node)),
        transforms_(node, buffer_),
        camera_frame_(options_.camera_frame) {
    if (!camera_frame_.empty() && !options_.is_default) {
      Publish();
      return;
    }
    timer_ = node.createWallTimer(
        ros::WallDuration(options_.is_default ? kWait_s : 0),
        [this](const ros::WallTimerEvent&) { PublishUnlessKnown(); }, true, false);
    AwaitCameraFrame(node, info_, [this](const std::string& frame) {
      if (camera_frame_.empty()) camera_frame_ = frame;
      timer_.start();
    });
  }

 private:
  void PublishUnlessKnown() {
    const bool is_known = buffer_.canTransform(options_.base_frame, camera_frame_, ros::Time(0));
    if (!(options_.is_default && is_known)) Publish();
  }

  void Publish() {
    broadcaster_.sendTransform(
        MakeTransform(ros::Time::now(), options_.base_frame, camera_frame_, options_.ParseMount()));
    const std::string what = "tf " + options_.base_frame + " <- " + camera_frame_ +
                             ", x y z yaw pitch roll: " + options_.base_from_camera;
    if (options_.is_default)
      ROS_WARN(
          "tf does not tell where the camera is on the rover; assumed is %s. Where that is wrong, "
          "give base_from_camera:=",
          what.c_str());
    else
      ROS_INFO("%s, as given", what.c_str());
  }

  const CameraMountNodeOptions options_;
  tf2::BufferCore buffer_;
  TransformInput transforms_;
  tf2_ros::StaticTransformBroadcaster broadcaster_;
  std::string camera_frame_;
  ros::Subscriber info_;
  ros::WallTimer timer_;
};

}  // namespace
}  // namespace arfm_vo

int main(int argc, char** argv) {
  return arfm_vo::RunNode<arfm_vo::CameraMountNode, arfm_vo::CameraMountNodeOptions>(
      argc, argv, "camera_mount_node", R"(Publishes the camera's place on the rover as a static tf.

in    stereo/left/camera_info: its frame, where camera_frame is empty
tf    out base_frame -> camera_frame)");
}
