// The panel's node, and chassis_node's services in the test's place.
#include <arfm_vo/DriveStatus.h>
#include <gmock/gmock.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>
#include <visualization_msgs/InteractiveMarkerFeedback.h>
#include <visualization_msgs/InteractiveMarkerInit.h>

#include "nodes/inbox.h"

namespace arfm_vo {
namespace {

using visualization_msgs::InteractiveMarkerFeedback;

class DrivePanelTest : public testing::Test {
 protected:
  DrivePanelTest() {
    const auto serve = [this](const std::string& name) {
      using Request = std_srvs::Trigger::Request;
      using Response = std_srvs::Trigger::Response;
      return node_.advertiseService<Request, Response>("chassis_node/" + name,
                                                       [this, name](Request&, Response& response) {
                                                         called_.push_back(name);
                                                         response.message = name + " it is";
                                                         return true;
                                                       });
    };
    services_ = {serve("start"), serve("stop"), serve("drive_home")};
    WaitUntil([this] { return clicks_.getNumSubscribers() > 0 && panel_.size() > 0; }, "the panel");
  }

  void Tell(const DriveStatus& status) { told_.publish(status); }
  void Click(const std::string& control, uint8_t event) {
    InteractiveMarkerFeedback feedback;
    feedback.marker_name = "drive_panel";
    feedback.control_name = control;
    feedback.event_type = event;
    clicks_.publish(feedback);
  }
  std::string Words() const {
    return panel_.all().back().markers.at(0).controls.back().markers.at(0).text;
  }
  void AwaitWords(const std::string& words) {
    WaitUntil([&] { return Words().find(words) != std::string::npos; }, "\"" + words + "\"");
  }

  ros::NodeHandle node_;
  ros::Publisher told_ = node_.advertise<DriveStatus>("drive_status", 1, true);
  ros::Publisher clicks_ = node_.advertise<InteractiveMarkerFeedback>("drive_panel/feedback", 10);
  Inbox<visualization_msgs::InteractiveMarkerInit> panel_{"drive_panel/update_full"};
  std::vector<std::string> called_;
  std::vector<ros::ServiceServer> services_;
};

TEST_F(DrivePanelTest, SaysWhatTheRoverDoesAndThatNobodyTellsItAnyMore) {
  DriveStatus status;
  status.state_text = "paused";
  status.reason = "pose is stale";
  status.has_goal = true;
  status.phase = "driving";
  status.distance_to_goal_m = 2.34;
  Tell(status);
  AwaitWords("paused: pose is stale\ndriving, 2.3 m to go");
  AwaitWords("chassis_node is silent");
  EXPECT_EQ(panel_.all().back().markers[0].header.frame_id, "base_link");
  for (const auto& control : panel_.all().back().markers[0].controls) {
    for (const auto& marker : control.markers) {
      EXPECT_EQ(marker.color.a, 1) << control.name << " cannot be seen";
      EXPECT_GT(marker.scale.z, 0) << control.name;
    }
  }
}

TEST_F(DrivePanelTest, TheButtonsStartAndStopAndTheAnswerIsShown) {
  Click("start", InteractiveMarkerFeedback::MOUSE_DOWN);
  Click("words", InteractiveMarkerFeedback::BUTTON_CLICK);
  Click("start", InteractiveMarkerFeedback::BUTTON_CLICK);
  AwaitWords("start: start it is");
  Click("stop", InteractiveMarkerFeedback::BUTTON_CLICK);
  AwaitWords("stop: stop it is");
  Click("home", InteractiveMarkerFeedback::BUTTON_CLICK);
  AwaitWords("home: drive_home it is");
  EXPECT_THAT(called_, testing::ElementsAre("start", "stop", "drive_home"));
}

}  // namespace
}  // namespace arfm_vo
