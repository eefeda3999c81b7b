#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>

#include <limits>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/datasets/kitti_sequence.h"
#include "arfm_vo/ros/node/node_main.h"
#include "arfm_vo/ros/node/parameters.h"
#include "arfm_vo/ros/replay/stereo_outputs.h"

namespace arfm_vo {
namespace {

const ros::WallDuration kClockPeriod(0.01);
/// Nodes that start together have all subscribed once no further one has for so long.
const ros::WallDuration kSettling(1);

struct PlayerOptions {
  std::string sequence;                          ///< KITTI folder
  int stride = 1;                                ///< play each so manyth pair
  int pairs = std::numeric_limits<int>::max();   ///< at most
  double rate_hz = 0;                            ///< pairs a second; 0: as recorded
  double end_delay_s = 1;                        ///< between the last pair and the node's end
  std::string frame_id = "left_camera_optical";  ///< of images and camera_info

  void Check() const {
    Require(!sequence.empty(), "sequence must name a KITTI folder");
    Require(rate_hz >= 0, "rate_hz must not be negative");
  }
  ARFM_FIELDS(sequence, stride, pairs, rate_hz, end_delay_s, frame_id)
};

/// Publishes a KITTI folder below its namespace, with the recording's time on /clock.
class KittiPlayer {
 public:
  KittiPlayer(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
      : options_(ReadParameters<PlayerOptions>(private_node)),
        sequence_(options_.sequence, {options_.stride, options_.pairs}),
        node_(node) {}

  void Play() {
    auto pair = sequence_.Next();
    Wait(pair->images.stamp_s);
    ros::WallTime due = ros::WallTime::now();
    int num_late = 0;
    while (pair && ros::ok()) {
      const double stamp_s = pair->images.stamp_s;
      PublishClock(stamp_s);
      publisher_.Publish(ToMessages(*pair, sequence_.camera(), options_.frame_id));
      pair = sequence_.Next();
      // After the last one the clock stands, which tells the nodes that no more pairs are due.
      const double next_s = pair ? pair->images.stamp_s : stamp_s;
      const double period_s = options_.rate_hz > 0 ? 1 / options_.rate_hz : next_s - stamp_s;
      due += ros::WallDuration(pair ? period_s : options_.end_delay_s);
      if (ros::WallTime::now() > due) {  // too slow: go on from here instead of a burst
        ++num_late;
        due = ros::WallTime::now();
      }
      RunClock(stamp_s, next_s, due);
    }
    ROS_INFO("played %d pairs, %d of them late", sequence_.size(), num_late);
  }

 private:
  void Wait(double stamp_s) {
    ROS_INFO("waiting for subscribers of all four topics");
    // arfm_node is not the last one: pose_node takes the images as well, and what it begins without
    // is lost.
    uint32_t num_before = 0;
    ros::WallTime changed = ros::WallTime::now();
    while (ros::ok()) {
      const uint32_t num = publisher_.CountSubscribers();
      if (num != num_before) changed = ros::WallTime::now();
      num_before = num;
      if (publisher_.HasSubscribers() && ros::WallTime::now() - changed > kSettling) break;
      PublishClock(stamp_s);
      kClockPeriod.sleep();
    }
  }
  void PublishClock(double stamp_s) {
    rosgraph_msgs::Clock clock;
    clock.clock.fromSec(stamp_s + kStampOffset_s);
    clock_.publish(clock);
  }
  /// Lets the clock go from one stamp to the next until `due`.
  void RunClock(double stamp_s, double next_s, ros::WallTime due) {
    const ros::WallTime start = ros::WallTime::now();
    for (ros::WallTime now = start; now < due && ros::ok(); now = ros::WallTime::now()) {
      PublishClock(stamp_s + (next_s - stamp_s) * ((now - start).toSec() / (due - start).toSec()));
      std::min(kClockPeriod, due - now).sleep();
    }
  }

  PlayerOptions options_;
  KittiSequence sequence_;
  ros::NodeHandle node_;
  ros::Publisher clock_ = node_.advertise<rosgraph_msgs::Clock>("/clock", 10);
  StereoPublisher publisher_{node_};
};

}  // namespace
}  // namespace arfm_vo

int main(int argc, char** argv) {
  using namespace arfm_vo;
  return RunNode<KittiPlayer, PlayerOptions>(
      argc, argv, "kitti_player_node",
      R"(Publishes a KITTI folder in its namespace, with the recording's time.

out   /clock, left|right/image_rect, left|right/camera_info, ground_truth (geometry_msgs/PoseStamped))",
      [](KittiPlayer& player) { player.Play(); });
}
