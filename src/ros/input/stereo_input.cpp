#include "arfm_vo/ros/input/stereo_input.h"

#include <ros/names.h>

#include <memory>

#include "arfm_vo/datasets/exact_pairing.h"

namespace arfm_vo {
namespace {

constexpr int kImageQueueSize = 8;

}  // namespace

std::string StereoTopic(const ros::NodeHandle& node, const std::string& name) {
  return node.resolveName(ros::names::clean(node.resolveName("stereo") + "/" + name));
}

StereoTopics ResolveStereoTopics(const ros::NodeHandle& node) {
  return {StereoTopic(node, "left/image_rect"), StereoTopic(node, "right/image_rect"),
          StereoTopic(node, "left/camera_info"), StereoTopic(node, "right/camera_info"),
          StereoTopic(node, "ground_truth")};
}

void AwaitCameraFrame(ros::NodeHandle& node, ros::Subscriber& subscriber,
                      std::function<void(const std::string&)> take) {
  subscriber = node.subscribe<sensor_msgs::CameraInfo>(
      StereoTopic(node, "left/camera_info"), 1,
      [&subscriber, take](const sensor_msgs::CameraInfoConstPtr& info) {
        if (info->header.frame_id.empty()) {
          ROS_WARN_THROTTLE(10, "%s: header.frame_id is empty: waiting for one with a frame",
                            subscriber.getTopic().c_str());
          return;
        }
        take(info->header.frame_id);
        subscriber.shutdown();
      });
}

StereoCallbacks PairExactly(std::function<void(const StereoMessagePair&)> take) {
  using Image = sensor_msgs::Image;
  using Info = sensor_msgs::CameraInfo;
  const auto pairing = std::make_shared<ExactPairing<Image, Image, Info, Info>>(
      kImageQueueSize, [take](const auto&... messages) { take({messages...}); });
  return {[pairing](const auto& left) { pairing->template Add<0>(left); },
          [pairing](const auto& right) { pairing->template Add<1>(right); },
          [pairing](const auto& left_info) { pairing->template Add<2>(left_info); },
          [pairing](const auto& right_info) { pairing->template Add<3>(right_info); }};
}

StereoInput::StereoInput(ros::NodeHandle node, const ros::NodeHandle& private_node,
                         const StereoCallbacks& take) {
  const StereoTopics topics = ResolveStereoTopics(node);
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  const image_transport::TransportHints hints("raw", no_delay, private_node);
  image_transport::ImageTransport transport(node);
  const auto subscribe_image = [&](const std::string& topic, uint32_t& count, ros::Time& stamp,
                                   const auto& take_image) {
    const auto take_counted = [this, &count, &stamp,
                               take_image](const sensor_msgs::ImageConstPtr& image) {
      ++count;
      stamp = image->header.stamp;
      counts.stamp_difference_s = left_stamp_.toSec() - right_stamp_.toSec();
      take_image(image);
    };
    return transport.subscribe(topic, kImageQueueSize, take_counted, {}, hints);
  };
  const auto subscribe_info = [&](const std::string& topic, uint32_t& count,
                                  const auto& take_info) {
    const auto take_counted = [&count, take_info](const sensor_msgs::CameraInfoConstPtr& info) {
      ++count;
      take_info(info);
    };
    return node.subscribe<sensor_msgs::CameraInfo>(topic, kImageQueueSize, take_counted, {},
                                                   no_delay);
  };
  left_ = subscribe_image(topics.left_image, counts.left, left_stamp_, take.left);
  right_ = subscribe_image(topics.right_image, counts.right, right_stamp_, take.right);
  left_info_ = subscribe_info(topics.left_info, counts.left_info, take.left_info);
  right_info_ = subscribe_info(topics.right_info, counts.right_info, take.right_info);
}

}  // namespace arfm_vo
