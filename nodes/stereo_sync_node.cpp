// Makes exact pairs of images whose stamps differ: what comes on left|right/image_rect and
// camera_info of the namespace `stereo` goes out below `synchronized`, all with the stamp of the
// left image.
#include <algorithm>
#include <array>
#include <boost/make_shared.hpp>
#include <memory>
#include <string>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/datasets/stamp_pairing.h"
#include "arfm_vo/ros/input/stereo_input.h"
#include "arfm_vo/ros/node/node_main.h"
#include "arfm_vo/ros/node/parameters.h"

namespace arfm_vo {
namespace {

constexpr int kQueueSize = 8;

struct StereoSyncOptions {
  double max_skew_s = 0.01;  ///< at most between left and right; less than half of their period
  int every_nth_pair = 1;    ///< goes out, the others do not

  void Check() const {
    Require(max_skew_s > 0, "max_skew_s must be positive");
    Require(every_nth_pair >= 1, "every_nth_pair must be positive");
  }
  ARFM_FIELDS(max_skew_s, every_nth_pair)
};

class StereoSyncNode {
 public:
  using Image = sensor_msgs::ImageConstPtr;
  using Info = sensor_msgs::CameraInfoConstPtr;

  StereoSyncNode(ros::NodeHandle node, ros::NodeHandle private_node)
      : options_(ReadParameters<StereoSyncOptions>(private_node)),
        node_(node),
        private_node_(private_node),
        pairing_(options_.max_skew_s) {
    left_out_ = Advertise<sensor_msgs::Image>("left/image_rect");
    right_out_ = Advertise<sensor_msgs::Image>("right/image_rect");
    left_info_out_ = Advertise<sensor_msgs::CameraInfo>("left/camera_info");
    right_info_out_ = Advertise<sensor_msgs::CameraInfo>("right/camera_info");
    timer_ = node.createWallTimer(ros::WallDuration(1), [this](const ros::WallTimerEvent&) {
      if (input_) input_->TellObstacle();
    });
  }
  ~StereoSyncNode() {
    TellAtEnd("stereo_sync_node: " + std::to_string(num_pairs_) + " pairs, " +
              std::to_string(pairing_.CountUnpaired()) + " images without partner");
  }

 private:
  template <class Message>
  ros::Publisher Advertise(const std::string& name) {
    const auto listen = [this](const ros::SingleSubscriberPublisher&) { ListenOnDemand(); };
    return node_.advertise<Message>(
        ros::names::clean(node_.resolveName("synchronized") + "/" + name), kQueueSize, listen,
        listen);
  }

  /// Listens once all outputs are subscribed to, so that a recording whose player waits for
  /// subscribers loses no pair; and until none is.
  void ListenOnDemand() {
    const auto has_subscribers = [](const ros::Publisher* out) {
      return out->getNumSubscribers() > 0;
    };
    const std::array outputs{&left_out_, &right_out_, &left_info_out_, &right_info_out_};
    if (!input_ && std::all_of(outputs.begin(), outputs.end(), has_subscribers)) Listen();
    if (input_ && std::none_of(outputs.begin(), outputs.end(), has_subscribers)) Stop();
  }
  void Listen() {
    StereoCallbacks take;
    take.left_info = [this](const Info& info) { TakeInfo(info, newest_left_info_); };
    take.right_info = [this](const Info& info) { TakeInfo(info, newest_right_info_); };
    take.left = [this](const Image& image) {
      StartAnewAfterJump(image->header.stamp, left_stamp_);
      pairing_.AddLeft(image->header.stamp.toSec(), image);
      PublishPairs();
    };
    take.right = [this](const Image& image) {
      StartAnewAfterJump(image->header.stamp, right_stamp_);
      pairing_.AddRight(image->header.stamp.toSec(), image);
      PublishPairs();
    };
    input_ = std::make_unique<StereoInput>(node_, private_node_, take);
  }
  void Stop() {
    input_.reset();
    pairing_ = StampPairing<Image>(options_.max_skew_s);
    left_stamp_ = right_stamp_ = {};
  }

  void TakeInfo(const Info& info, Info& newest) {
    newest = info;
    PublishPairs();
  }
  void StartAnewAfterJump(const ros::Time& stamp, ros::Time& stamp_before) {
    if (stamp < stamp_before) pairing_ = StampPairing<Image>(options_.max_skew_s);
    stamp_before = stamp;
  }

  void PublishPairs() {
    if (!newest_left_info_ || !newest_right_info_) return;
    while (const auto pair = pairing_.Take()) {
      ++input_->counts.pairs;
      if (num_pairs_++ % options_.every_nth_pair != 0) continue;
      const ros::Time stamp = pair->first->header.stamp;
      left_info_out_.publish(WithStamp(*newest_left_info_, stamp));
      right_info_out_.publish(WithStamp(*newest_right_info_, stamp));
      left_out_.publish(pair->first);
      right_out_.publish(WithStamp(*pair->second, stamp));
    }
  }

  template <class Message>
  static boost::shared_ptr<Message> WithStamp(const Message& message, const ros::Time& stamp) {
    const auto copy = boost::make_shared<Message>(message);
    copy->header.stamp = stamp;
    return copy;
  }

  const StereoSyncOptions options_;
  ros::NodeHandle node_, private_node_;
  StampPairing<Image> pairing_;
  uint32_t num_pairs_ = 0;
  ros::Time left_stamp_, right_stamp_;
  Info newest_left_info_, newest_right_info_;
  ros::Publisher left_out_, right_out_, left_info_out_, right_info_out_;
  std::unique_ptr<StereoInput> input_;
  ros::WallTimer timer_;
};

}  // namespace
}  // namespace arfm_vo

int main(int argc, char** argv) {
  return arfm_vo::RunNode<arfm_vo::StereoSyncNode, arfm_vo::StereoSyncOptions>(
      argc, argv, "stereo_sync_node", R"(Makes exact pairs of images whose stamps differ.

in    stereo/left|right/image_rect, stereo/left|right/camera_info
out   synchronized/left|right/image_rect, synchronized/left|right/camera_info: with the left image's stamp)");
}
