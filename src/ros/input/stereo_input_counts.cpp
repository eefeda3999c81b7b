#include <ros/master.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "arfm_vo/ros/input/stereo_input.h"

namespace arfm_vo {
namespace {

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

std::string JoinNames(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

bool IsImage(const std::string& topic, const StereoTopics& topics) {
  return topic == topics.left_image || topic == topics.right_image;
}

/// `topic` with another last name.
std::string Sibling(const std::string& topic, const std::string& name) {
  return topic.substr(0, topic.rfind('/') + 1) + name;
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
  const std::string raw = Sibling(topic, "image_raw");
  if (is_image && raw != topic && published.count(raw))
    return "nobody publishes " + topic + ", but " + raw +
           " is there: run stereo_image_proc, or give odometry.launch rectify:=true";
  if (is_image && published.count(topic + "/compressed"))
    return "nobody publishes " + topic + ", but " + topic +
           "/compressed is there: run image_transport republish compressed raw (this needs the "
           "plugin compressed_image_transport)";
  const std::vector<std::string> similar = FindSimilar(is_image, published);
  const std::string names = is_image ? "left_image:=, right_image:=" : "left_info:=, right_info:=";
  return "nobody publishes " + topic + "; " +
         (similar.empty() ? std::string(is_image ? "no image" : "no camera_info") +
                                " is published at all: start the camera or the bag"
                          : "published are " + JoinNames(similar) +
                                ": give odometry.launch stereo:=, " + names + " as they are");
}

}  // namespace

std::set<std::string> ListPublishedTopics() {
  ros::master::V_TopicInfo topics;
  ros::master::getTopics(topics);
  std::set<std::string> names;
  for (const ros::master::TopicInfo& topic : topics) names.insert(topic.name);
  return names;
}

std::string StereoInputCounts::Explain(const StereoInputCounts& before,
                                       const StereoTopics& topics) const {
  if (pairs > before.pairs) return "";
  const std::vector<std::string> silent = FindSilent(*this, before, topics);
  if (!silent.empty()) return "no messages on " + JoinNames(silent);
  if (stamp_difference_s == 0) return "images and camera_info have different stamps";
  char difference[64];
  std::snprintf(difference, sizeof difference, "%.3f ms", std::abs(stamp_difference_s) * 1e3);
  return topics.left_image + " and " + topics.right_image + " have different stamps (" +
         difference + " apart)";
}

std::string StereoInputCounts::Remedy(const StereoInputCounts& before, const StereoTopics& topics,
                                      const std::set<std::string>& published) const {
  if (pairs > before.pairs) return "";
  const std::vector<std::string> silent = FindSilent(*this, before, topics);
  for (const std::string& topic : silent)
    if (!published.count(topic)) return FindWayTo(topic, IsImage(topic, topics), published);
  if (!silent.empty())
    return silent.front() + " has a publisher that sends nothing (or a bag that is paused)";
  return "both cameras must be triggered together; where that cannot be, give odometry.launch "
         "approx_sync:=true and max_skew_s:=, at least that difference";
}

void StereoInputWatch::Tell(const StereoInputCounts& counts, const StereoTopics& topics) {
  const ros::Time time = ros::Time::now();
  // At the end of a recording the clock stands still, and that nothing comes is no problem.
  const bool has_ended = ros::Time::isSimTime() && counts.pairs > 0 && time == time_before_;
  const std::string problem = has_ended ? "" : counts.Explain(before_, topics);
  if (watch_.IsDue(problem, ros::WallTime::now().toSec()))
    ROS_WARN("no stereo pairs: %s. %s", problem.c_str(),
             counts.Remedy(before_, topics, ListPublishedTopics()).c_str());
  before_ = counts;
  time_before_ = time;
}

}  // namespace arfm_vo
