#pragma once

#include <gtest/gtest.h>
#include <ros/ros.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "arfm_vo/hardware/can_bus.h"
#include "arfm_vo/hardware/chassis_protocol.h"
#include "nodes/spoilt_topic.h"
#include "ros/valid_messages.h"

namespace arfm_vo {

/// How many malformed messages a topic gets.
inline int NumMessages() {
  const char* number = std::getenv("ARFM_VO_MALFORMED_MESSAGES");
  return number ? std::atoi(number) : 500;
}

class MalformedNodes : public testing::Test {
 protected:
  static ros::NodeHandle Private(const std::string& name) { return ros::NodeHandle("~" + name); }

  /// Sends each topic's messages side by side, so that those belong together that nodes pair.
  /// `settle` waits until what was sent so far is worked on.
  template <class... Topics>
  void Flood(const std::function<void()>& settle, Topics&&... topics) {
    constexpr int kBurst = 100;
    const long commands_before = num_commands_;
    double before_mb = 0;
    for (int i = 0; i < NumMessages(); ++i) {
      const ros::Time now = ros::Time::now();
      (topics.Send(i, now), ...);
      ros::spinOnce();
      Listen();
      if (i % kBurst == kBurst - 1) settle();
      if (i == NumMessages() / 5) before_mb = HeldMemoryMb();
    }
    settle();
    const double growth_mb = HeldMemoryMb() - before_mb;
    (Judge(topics.name(), num_commands_ - commands_before, growth_mb), ...);
  }
  template <class... Topics>
  void FloodEach(Topics&&... topics) {
    (Flood([] {}, topics), ...);
  }

  /// Calls a service with each request; how many of them were taken.
  template <class Service>
  int Call(const std::string& name, const typename Service::Request& valid) {
    // The service is of this process: somebody must spin while it is called.
    ros::AsyncSpinner spinner(1);
    spinner.start();
    ros::ServiceClient client = ros::NodeHandle().serviceClient<Service>(name, true);
    MessageSpoiler spoiler(static_cast<int>(name.size()));
    int num_answers = 0, num_taken = 0;
    double before_mb = 0;
    for (int i = 0; i < NumMessages(); ++i) {
      Service call;
      call.request = valid;
      spoiler.Spoil(call.request, ShareToSpoil(i));
      num_answers += client.call(call);
      num_taken += call.response.success;
      Listen();
      if (i == NumMessages() / 5) before_mb = HeldMemoryMb();
    }
    EXPECT_EQ(num_answers, NumMessages());
    Judge(name, num_commands_, HeldMemoryMb() - before_mb);
    return num_taken;
  }

  virtual void Listen() {}
  long num_commands_ = 0;

 private:
  void Judge(const std::string& name, long num_commands, double growth_mb) {
    char figures[80];
    std::snprintf(figures, sizeof(figures), " | %d | %ld | %+.1f |", NumMessages(), num_commands,
                  growth_mb);
    TellRow("| " + name + figures);
    EXPECT_EQ(num_commands_, 0);
    EXPECT_LT(growth_mb, kMaxGrowth_mb);
  }
};

/// The bus with the chassis' other end.
class MalformedDriving : public MalformedNodes {
 protected:
  void Listen() override {
    while (const auto frame = bus_->Receive()) num_commands_ += DecodeCommand(*frame).index() != 0;
  }
  static std::string BusAddress() {
    std::string address;
    if (!ros::param::get("~bus", address)) throw std::runtime_error("no parameter ~bus");
    return address;
  }

 private:
  const std::unique_ptr<CanBus> bus_ = OpenCanBus(BusAddress());
};

}  // namespace arfm_vo
