#pragma once

#include <gtest/gtest.h>
#include <ros/ros.h>

#include <functional>
#include <string>
#include <vector>

namespace arfm_vo {

/// Spins until `condition` holds; a failure that names what was waited for after 60 s.
inline void WaitUntil(const std::function<bool()>& condition, const std::string& what) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(60);
  while (!condition()) {
    if (!ros::ok() || ros::WallTime::now() > end) {
      GTEST_FAIL() << "waited in vain for " << what;
    }
    ros::spinOnce();
    ros::WallDuration(0.002).sleep();
  }
}

/// All messages that came on a topic.
template <class Message>
class Inbox {
 public:
  explicit Inbox(const std::string& topic)
      : subscriber_(ros::NodeHandle().subscribe<Message>(
            topic, 100, [this](const boost::shared_ptr<const Message>& message) {
              all_.push_back(*message);
            })) {}
  int size() const { return static_cast<int>(all_.size()); }
  bool has_publisher() const { return subscriber_.getNumPublishers() > 0; }
  const std::vector<Message>& all() const { return all_; }
  /// Waits for the first.
  const Message& last() const {
    WaitUntil([this] { return !all_.empty(); }, "a message on " + subscriber_.getTopic());
    if (all_.empty()) throw std::runtime_error("no message on " + subscriber_.getTopic());
    return all_.back();
  }

 private:
  std::vector<Message> all_;
  ros::Subscriber subscriber_;
};

}  // namespace arfm_vo
