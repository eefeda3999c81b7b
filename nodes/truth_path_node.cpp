// Shows the recorded truth, stereo/ground_truth, as a path beside the odometry's: path_truth.
#include <geometry_msgs/PoseStamped.h>

#include <deque>
#include <optional>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/ros/input/stereo_input.h"
#include "arfm_vo/ros/input/transform_input.h"
#include "arfm_vo/ros/messages/conversions.h"
#include "arfm_vo/ros/messages/display_messages.h"
#include "arfm_vo/ros/messages/transforms.h"
#include "arfm_vo/ros/node/node_main.h"
#include "arfm_vo/ros/node/parameters.h"

namespace arfm_vo {
namespace {

/// Truth waits this long for the odometry of its stamp.
constexpr size_t kMaxWaiting = 100;

struct TruthPathOptions {
  std::string reference_frame = "odom";  ///< that the truth is aligned to at its first pose
  std::string base_frame = "base_link";  ///< of the rover
  std::string camera_frame;  ///< left optical frame; empty: that of the left camera_info

  void Check() const {}
  ARFM_FIELDS(reference_frame, base_frame, camera_frame)
};

class TruthPathNode {
 public:
  TruthPathNode(ros::NodeHandle node, ros::NodeHandle private_node)
      : options_(ReadParameters<TruthPathOptions>(private_node)),
        transforms_(node, buffer_),
        publisher_(node.advertise<nav_msgs::Path>("path_truth", 1, true)),
        truth_(node.subscribe(StereoTopic(node, "ground_truth"), 100, &TruthPathNode::Take, this)),
        timer_(node.createWallTimer(ros::WallDuration(0.1),
                                    [this](const ros::WallTimerEvent&) { AddWaiting(); })) {
    if (!options_.camera_frame.empty()) {
      SetCameraFrame(options_.camera_frame);
      return;
    }
    AwaitCameraFrame(node, info_, [this](const std::string& frame) { SetCameraFrame(frame); });
  }

 private:
  void SetCameraFrame(const std::string& frame) {
    alignment_.emplace(
        TruthAlignment{buffer_, options_.reference_frame, options_.base_frame, frame});
  }

  void Take(const geometry_msgs::PoseStamped& truth) {
    if (truth.header.stamp < newest_) {  // time jumped back
      waiting_.clear();
      path_.Clear();
      if (alignment_) alignment_->reference_from_truth.reset();
    }
    newest_ = truth.header.stamp;
    waiting_.push_back(truth);
    if (waiting_.size() > kMaxWaiting) waiting_.pop_front();
  }

  /// Adds what tf reaches by now; what lies before that was before the odometry's start.
  void AddWaiting() {
    if (!alignment_) return;
    bool is_longer = false;
    size_t num_done = 0;
    for (size_t i = 0; i < waiting_.size(); ++i) {
      const auto base = Align(waiting_[i]);
      if (!base) continue;
      std_msgs::Header header = waiting_[i].header;
      header.frame_id = options_.reference_frame;
      is_longer |= path_.Add(header, ToPoseMessage(*base));
      num_done = i + 1;
    }
    waiting_.erase(waiting_.begin(), waiting_.begin() + num_done);
    if (is_longer) publisher_.publish(path_.path());
  }

  std::optional<Rigid3> Align(const geometry_msgs::PoseStamped& truth) {
    Rigid3 truth_from_camera = ToRigid3(truth.pose);
    truth_from_camera.rotation.normalize();
    return alignment_->Align(truth.header.stamp, truth_from_camera);
  }

  const TruthPathOptions options_;
  tf2::BufferCore buffer_;
  TransformInput transforms_;
  std::optional<TruthAlignment> alignment_;
  BoundedPath path_;
  std::deque<geometry_msgs::PoseStamped> waiting_;
  ros::Time newest_;
  ros::Publisher publisher_;
  ros::Subscriber truth_, info_;
  ros::WallTimer timer_;
};

}  // namespace
}  // namespace arfm_vo

int main(int argc, char** argv) {
  return arfm_vo::RunNode<arfm_vo::TruthPathNode, arfm_vo::TruthPathOptions>(
      argc, argv, "truth_path_node", R"(Shows the recorded truth as a path beside the odometry's.

in    stereo/ground_truth (geometry_msgs/PoseStamped), stereo/left/camera_info
out   path_truth (nav_msgs/Path)
tf    in reference_frame and base_frame <- camera)");
}
