#include "arfm_vo/ros/stereo_input.h"

#include <ros/names.h>

#include <boost/bind/bind.hpp>

namespace arfm_vo {
namespace {

constexpr int kQueueSize = 8;

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
        take(info->header.frame_id);
        subscriber.shutdown();
      });
}

StereoInput::StereoInput(ros::NodeHandle node, const ros::NodeHandle& private_node,
                         Callback callback)
    : callback_(std::move(callback)),
      topics_(ResolveStereoTopics(node)),
      transport_(node),
      synchronizer_(Policy(kQueueSize)) {
  synchronizer_.connectInput(left_, right_, left_info_, right_info_);
  using namespace boost::placeholders;
  synchronizer_.registerCallback(boost::bind<void>(
      [this](const auto& left, const auto& right, const auto& left_info, const auto& right_info) {
        ++counts_.pairs;
        callback_({left, right, left_info, right_info});
      },
      _1, _2, _3, _4));
  const auto count_image = [this](uint32_t& count, ros::Time& stamp) {
    return [this, &count, &stamp](const sensor_msgs::ImageConstPtr& image) {
      ++count;
      stamp = image->header.stamp;
      counts_.stamp_difference_s = (left_stamp_ - right_stamp_).toSec();
    };
  };
  using ImageCallback = boost::function<void(const sensor_msgs::ImageConstPtr&)>;
  using InfoCallback = boost::function<void(const sensor_msgs::CameraInfoConstPtr&)>;
  left_.registerCallback(ImageCallback(count_image(counts_.left, left_stamp_)));
  right_.registerCallback(ImageCallback(count_image(counts_.right, right_stamp_)));
  left_info_.registerCallback(InfoCallback([this](const auto&) { ++counts_.left_info; }));
  right_info_.registerCallback(InfoCallback([this](const auto&) { ++counts_.right_info; }));

  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  const image_transport::TransportHints hints("raw", no_delay, private_node);
  left_.subscribe(transport_, topics_.left_image, kQueueSize, hints);
  right_.subscribe(transport_, topics_.right_image, kQueueSize, hints);
  left_info_.subscribe(node, topics_.left_info, kQueueSize, no_delay);
  right_info_.subscribe(node, topics_.right_info, kQueueSize, no_delay);
}

}  // namespace arfm_vo
