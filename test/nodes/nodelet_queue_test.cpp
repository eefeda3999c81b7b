#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>

#include "arfm_vo/StereoFrameStamped.h"
#include "arfm_vo/ros/odometry/arfm_node.h"
#include "nodes/inbox.h"

namespace arfm_vo {
namespace {

// nodelet::Loader disables the queue while it makes the node: what is added to it then is lost.
TEST(NodeletQueueTest, ArfmNodeServesASubscriberThatWasThereBeforeIt) {
  ros::CallbackQueue queue;
  ros::NodeHandle node("late"), private_node("~late");
  node.setCallbackQueue(&queue);
  private_node.setCallbackQueue(&queue);
  const Inbox<StereoFrameStamped> features("late/features");
  const ros::Publisher left = node.advertise<sensor_msgs::Image>("stereo/left/image_rect", 1);
  queue.disable();
  const ArfmNode arfm(node, private_node);
  queue.enable();
  const auto is_subscribed = [&] {
    queue.callAvailable();
    return left.getNumSubscribers() > 0;
  };
  WaitUntil(is_subscribed, "arfm_node to subscribe to the images");
}

}  // namespace
}  // namespace arfm_vo
