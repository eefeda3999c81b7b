#include "arfm_vo/ros/input/stereo_input.h"

#include <ros/master.h>
#include <ros/names.h>

#include <boost/algorithm/string/join.hpp>
#include <cmath>
#include <memory>
#include <vector>

#include "arfm_vo/base/format.h"
#include "arfm_vo/datasets/exact_pairing.h"

namespace arfm_vo {
namespace {

constexpr int kImageQueueSize = 8;
constexpr size_t kMaxListed = 6;

/// The topics on which nothing came between two counts.
std::vector<std::string> FindSilent(const StereoInputCounts& now, const StereoInputCounts& before,
                                    const StereoTopics& topics) {
  std::vector<std::string> silent;
  if (now.left == before.left) silent.push_back(topics.left_image);
  if (now.right == before.right) silent.push_back(topics.right_image);
  if (now.left_info == before.left_info) silent.push_back(topics.left_info);
  if (now.right_info == before.right_info) silent.push_back(topics.right_info);
  return silent;
}

/// The published topics that look as if they were meant.
std::vector<std::string> FindSimilar(bool is_image, const std::set<std::string>& published) {
  std::vector<std::string> similar;
  for (const std::string& topic : published) {
    const std::string name = topic.substr(topic.rfind('/') + 1);
    const bool is_similar =
        is_image ? name.rfind("image", 0) == 0 && topic.find("matches_image") == std::string::npos
                 : name == "camera_info";
    if (is_similar && similar.size() < kMaxListed) similar.push_back(topic);
  }
  return similar;
}

/// What to do about a topic that nobody publishes.
std::string FindWayTo(const std::string& topic, bool is_image,
                      const std::set<std::string>& published) {
  const std::string raw = topic.substr(0, topic.rfind('/') + 1) + "image_raw";
  const std::string missing = "nobody publishes " + topic;
  if (is_image && raw != topic && published.count(raw))
    return missing + ", but " + raw +
           " is there: run stereo_image_proc, or give odometry.launch rectify:=true";
  if (is_image && published.count(topic + "/compressed"))
    return missing + ", but " + topic +
           "/compressed is there: run image_transport republish compressed raw (this needs the "
           "plugin compressed_image_transport)";
  const std::string kind = is_image ? "image" : "camera_info", name = is_image ? "image" : "info";
  const std::vector<std::string> similar = FindSimilar(is_image, published);
  if (similar.empty())
    return missing + "; no " + kind + " is published at all: start the camera or the bag";
  return missing + "; published are " + boost::join(similar, ", ") +
         ": give odometry.launch stereo:=, left_" + name + ":=, right_" + name + ":= as they are";
}

/// The names of all topics that somebody publishes, by the master; empty where it does not answer.
std::set<std::string> ListPublishedTopics() {
  ros::master::V_TopicInfo topics;
  ros::master::getTopics(topics);
  std::set<std::string> names;
  for (const ros::master::TopicInfo& topic : topics) names.insert(topic.name);
  return names;
}

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
                         const StereoCallbacks& take)
    : topics_(ResolveStereoTopics(node)) {
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  const image_transport::TransportHints hints("raw", no_delay, private_node);
  image_transport::ImageTransport transport(node);
  const auto counted = [this](uint32_t& count, ros::Time& stamp, const auto& take_message) {
    return [this, &count, &stamp, take_message](const auto& message) {
      ++count;
      stamp = message->header.stamp;
      counts.stamp_difference_s = left_stamp_.toSec() - right_stamp_.toSec();
      take_message(message);
    };
  };
  left_ = transport.subscribe(topics_.left_image, kImageQueueSize,
                              counted(counts.left, left_stamp_, take.left), {}, hints);
  right_ = transport.subscribe(topics_.right_image, kImageQueueSize,
                               counted(counts.right, right_stamp_, take.right), {}, hints);
  left_info_ = node.subscribe<sensor_msgs::CameraInfo>(
      topics_.left_info, kImageQueueSize, counted(counts.left_info, info_stamp_, take.left_info),
      {}, no_delay);
  right_info_ = node.subscribe<sensor_msgs::CameraInfo>(
      topics_.right_info, kImageQueueSize, counted(counts.right_info, info_stamp_, take.right_info),
      {}, no_delay);
}

std::string StereoInputCounts::Explain(const StereoInputCounts& before,
                                       const StereoTopics& topics) const {
  if (pairs > before.pairs) return "";
  const std::vector<std::string> silent = FindSilent(*this, before, topics);
  if (!silent.empty()) return "no messages on " + boost::join(silent, ", ");
  if (stamp_difference_s == 0) return "images and camera_info have different stamps";
  return topics.left_image + " and " + topics.right_image +
         Format(" have different stamps (%.3f ms apart)", std::abs(stamp_difference_s) * 1e3);
}

std::string StereoInputCounts::Remedy(const StereoInputCounts& before, const StereoTopics& topics,
                                      const std::set<std::string>& published) const {
  if (pairs > before.pairs) return "";
  const std::vector<std::string> silent = FindSilent(*this, before, topics);
  for (const std::string& topic : silent) {
    const bool is_image = topic == topics.left_image || topic == topics.right_image;
    if (!published.count(topic)) return FindWayTo(topic, is_image, published);
  }
  if (!silent.empty())
    return silent.front() + " has a publisher that sends nothing (or a bag that is paused)";
  return "both cameras must be triggered together; where that cannot be, give odometry.launch "
         "approx_sync:=true and max_skew_s:=, at least that difference";
}

std::string StereoInput::TellObstacle() {
  const ros::Time time = ros::Time::now();
  // At the end of a recording the clock stands still, and that nothing comes is no problem.
  const bool has_ended = ros::Time::isSimTime() && counts.pairs > 0 && time == time_before_;
  const std::string problem = counts.Explain(before_, topics_);
  if (watch_.IsDue(has_ended ? "" : problem))
    ROS_WARN("no stereo pairs: %s. %s", problem.c_str(),
             counts.Remedy(before_, topics_, ListPublishedTopics()).c_str());
  before_ = counts;
  time_before_ = time;
  return problem;
}

}  // namespace arfm_vo
