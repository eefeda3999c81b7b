#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/ros.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace arfm_vo {

/// Calls a service over a connection that stays until the answer is read; that of
/// ros::service::call may end before (ros_comm #1976).
template <typename Service>
bool CallService(const std::string& name, Service& call) {
  return ros::NodeHandle().serviceClient<Service>(name, /*persistent=*/true).call(call);
}

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

/// The same, doing `repeat` before, and again each period.
inline void RepeatUntil(const std::function<bool()>& condition, const std::function<void()>& repeat,
                        double period_s, const std::string& what) {
  ros::WallTime due;
  WaitUntil(
      [&] {
        if (condition()) return true;
        if (ros::WallTime::now() < due) return false;
        due = ros::WallTime::now() + ros::WallDuration(period_s);
        repeat();
        return false;
      },
      what);
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

/// What nodes say of themselves on /diagnostics.
class Diagnoses {
 public:
  using Status = diagnostic_msgs::DiagnosticStatus;

  /// Waits for one that matches, of those that came after the one waited for before.
  void Await(const std::string& what, const std::function<bool(const Status&)>& matches) {
    const auto has_come = [&] {
      while (next_ < inbox_.size()) {
        const auto& all = inbox_.all()[next_++].status;
        if (std::any_of(all.begin(), all.end(), matches)) return true;
      }
      return false;
    };
    WaitUntil(has_come, "a diagnosis: " + what);
  }
  /// Waits for a level and a text of what has `part` in its name.
  void Await(const std::string& part, int level, const std::string& text) {
    Await(part + ": " + text, [&](const Status& status) {
      return status.name.find(part) != std::string::npos && status.level == level &&
             status.message.find(text) != std::string::npos;
    });
  }
  int size() const { return inbox_.size(); }

 private:
  Inbox<diagnostic_msgs::DiagnosticArray> inbox_{"/diagnostics"};
  int next_ = 0;
};

}  // namespace arfm_vo
