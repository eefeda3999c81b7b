#pragma once

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>

#include <boost/make_shared.hpp>
#include <string>
#include <type_traits>
#include <utility>

#include "nodes/inbox.h"
#include "ros/random_message.h"

namespace arfm_vo {

/// Of the i-th message's fields.
inline double ShareToSpoil(int i) { return i % 4 == 0 ? 1 : i % 2 == 0 ? 0.2 : 0.02; }

/// A topic with its node in this process, and copies of a valid message spoilt for it.
template <class Message>
class SpoiltTopic {
 public:
  SpoiltTopic(ros::NodeHandle node, const std::string& name, Message valid)
      : publisher_(node.advertise<Message>(name, 1)),
        valid_(std::move(valid)),
        spoiler_(static_cast<int>(name.size())) {
    WaitUntil([&] { return publisher_.getNumSubscribers() > 0; },
              "a subscriber of " + publisher_.getTopic());
  }
  std::string name() const { return publisher_.getTopic(); }

  /// Every third one keeps the stamp that the nodes pair messages by.
  void Send(int i, const ros::Time& stamp) {
    const auto message = boost::make_shared<Message>(valid_);
    SetStamp(*message, stamp);
    spoiler_.Spoil(*message, ShareToSpoil(i));
    if (i % 3 != 0) SetStamp(*message, stamp);
    publisher_.publish(message);
  }
  void SendValid(const ros::Time& stamp) {
    const auto message = boost::make_shared<Message>(valid_);
    SetStamp(*message, stamp);
    publisher_.publish(message);
  }

 private:
  static void SetStamp(Message& message, const ros::Time& stamp) {
    if constexpr (ros::message_traits::HasHeader<Message>::value) message.header.stamp = stamp;
    if constexpr (std::is_same_v<Message, tf2_msgs::TFMessage>)
      for (auto& transform : message.transforms) transform.header.stamp = stamp;
  }

  ros::Publisher publisher_;
  const Message valid_;
  MessageSpoiler spoiler_;
};

/// What a node says to valid messages.
template <class Message>
class Answers {
 public:
  explicit Answers(const std::string& topic)
      : subscriber_(ros::NodeHandle().subscribe<Message>(
            topic, 100, [this](const boost::shared_ptr<const Message>& message) {
              stamp_ = message->header.stamp;
            })) {}

  /// Sends valid messages of one stamp until a message with it comes: what was sent before is
  /// worked on by then. After a stamp far ahead it takes more than one.
  template <class... Topics>
  void Await(Topics&... topics) const {
    ros::Time stamp;
    const auto send = [&] {
      stamp = ros::Time::now();
      (topics.SendValid(stamp), ...);
    };
    RepeatUntil([&] { return !stamp.isZero() && stamp_ == stamp; }, send, 0.2,
                "a message on " + subscriber_.getTopic());
  }

 private:
  ros::Time stamp_;
  const ros::Subscriber subscriber_;
};

}  // namespace arfm_vo
