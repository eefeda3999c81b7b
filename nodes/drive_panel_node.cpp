#include "arfm_vo/ros/node/node_main.h"
#include "arfm_vo/ros/rover/drive_panel.h"

int main(int argc, char** argv) {
  return arfm_vo::RunNode<arfm_vo::DrivePanel, arfm_vo::DrivePanelOptions>(
      argc, argv, "drive_panel_node",
      R"(A panel above the rover in rviz (display InteractiveMarkers): its state in words, start, stop and home.

in    drive_status, drive_panel/feedback (visualization_msgs/InteractiveMarkerFeedback)
out   drive_panel/update, drive_panel/update_full
calls chassis_node/start, stop, drive_home (std_srvs/Trigger))");
}
