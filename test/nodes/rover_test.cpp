#include <gmock/gmock.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <tf2_ros/transform_listener.h>

#include <atomic>
#include <filesystem>
#include <map>
#include <set>
#include <thread>

#include "arfm_vo/hardware/clock_offset.h"
#include "arfm_vo/hardware/simulated_ptu_port.h"
#include "arfm_vo/simulation/simulated_chassis.h"
#include "nodes/inbox.h"
#include "nodes/node_process.h"

// rover.launch without cameras, with a simulated pan-tilt unit and a simulated chassis.

namespace arfm_vo {
namespace {

using diagnostic_msgs::DiagnosticStatus;

/// A topic's way from one node to another, "NODE TOPIC NODE".
std::set<std::string> ReadWays() {
  XmlRpc::XmlRpcValue request, response, state;
  request[0] = ros::this_node::getName();
  std::set<std::string> ways;
  if (!ros::master::execute("getSystemState", request, response, state, false)) return ways;
  for (int i = 0; i < state[0].size(); ++i)
    for (int k = 0; k < state[1].size(); ++k) {
      XmlRpc::XmlRpcValue &from = state[0][i], &to = state[1][k];
      if (std::string(from[0]) != std::string(to[0])) continue;
      for (int a = 0; a < from[1].size(); ++a)
        for (int b = 0; b < to[1].size(); ++b)
          ways.insert(std::string(from[1][a]) + " " + std::string(from[0]) + " " +
                      std::string(to[1][b]));
    }
  return ways;
}

const std::set<std::string> kWays = {
    "/stereo/stereo_camera_node /stereo/left/image_raw /stereo/stereo_image_proc",
    "/stereo/stereo_camera_node /stereo/right/image_raw /stereo/stereo_image_proc",
    "/stereo/stereo_camera_node /stereo/left/camera_info /stereo/stereo_image_proc",
    "/stereo/stereo_camera_node /stereo/right/camera_info /stereo/stereo_image_proc",
    "/stereo/stereo_image_proc /stereo/left/image_rect /arfm_node",
    "/stereo/stereo_image_proc /stereo/right/image_rect /arfm_node",
    "/stereo/stereo_camera_node /stereo/left/camera_info /arfm_node",
    "/stereo/stereo_camera_node /stereo/right/camera_info /arfm_node",
    "/arfm_node /features /pose_node",
    "/stereo/stereo_image_proc /stereo/left/image_rect /pose_node",
    "/pose_node /keyframe /ba_node",
    "/ba_node /map_update /pose_node",
    "/pose_node /odom /chassis_node",
    "/pose_node /status /chassis_node",
    "/chassis_node /drive_status /drive_panel",
    "/head/pan_tilt_node /joint_states /robot_state_publisher",
    "/robot_state_publisher /tf /pose_node",
    "/robot_state_publisher /tf_static /pose_node",
    "/pose_node /tf /chassis_node",
    "/ba_node /tf /chassis_node",
    "/chassis_node /drive_status /black_box/recorder",
    "/pose_node /odom /black_box/recorder",
    "/pose_node /status /black_box/recorder",
    "/stereo/stereo_camera_node /stereo/left/image_raw /black_box/pairs",
    "/black_box/pairs /black_box/right/image_raw /black_box/recorder"};

/// The chassis at the other end of the bus while it lives.
class ChassisThread {
 public:
  explicit ChassisThread(const std::string& can)
      : chassis_(OpenCanBus(can), TrackedPlant(TrackedPlantOptions{}, RoverPose{})),
        thread_([this] {
          while (!is_stopping_) {
            chassis_.Tick(MonotonicNow());
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
          }
        }) {}
  ~ChassisThread() {
    is_stopping_ = true;
    thread_.join();
  }

 private:
  SimulatedChassis chassis_;
  std::atomic<bool> is_stopping_{false};
  std::thread thread_;
};

std::string Parameter(const std::string& name) {
  std::string value;
  EXPECT_TRUE(ros::param::get("~" + name, value)) << name;
  return value;
}

class RoverTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    SimulatedPtuOptions options;
    options.reset_time_s = 0.5;
    // The folder must be there before the recorder, which is started again until it is.
    std::filesystem::create_directories(Parameter("bags"));
    ptu_ = std::make_unique<SimulatedPtuPort>(Parameter("port"), options);
    chassis_ = std::make_unique<ChassisThread>(Parameter("can"));
  }
  static void TearDownTestSuite() {
    ptu_.reset();
    chassis_.reset();
    std::filesystem::remove_all(Parameter("bags"));
  }

  static inline std::unique_ptr<SimulatedPtuPort> ptu_;
  static inline std::unique_ptr<ChassisThread> chassis_;
  Diagnoses diagnoses_;
};

TEST_F(RoverTest, AllNodesAreUpAndTheirTopicsConnected) {
  const auto missing = [] {
    const std::set<std::string> ways = ReadWays();
    std::string text;
    for (const std::string& way : kWays)
      if (!ways.count(way)) text += way + "\n";
    return text;
  };
  WaitUntil([&] { return missing().empty(); }, "all topics");
  EXPECT_EQ(missing(), "");
}

TEST_F(RoverTest, DiagnosticsSayWhatIsMissing) {
  diagnoses_.Await("stereo_camera_node: camera", DiagnosticStatus::ERROR, "/dev/no_left_camera");
  diagnoses_.Await("stereo_camera_node: calibration", DiagnosticStatus::WARN, "calibrat");
  diagnoses_.Await("arfm_node", DiagnosticStatus::WARN, "no pairs");
  diagnoses_.Await("pose_node: odometry", DiagnosticStatus::WARN, "no pairs");
  diagnoses_.Await("pan_tilt_node: pan-tilt", DiagnosticStatus::OK, "settled");
  diagnoses_.Await("chassis_node: driving", DiagnosticStatus::WARN, "standby");
}

TEST_F(RoverTest, TheHeadAndTheTracksAreThere) {
  tf2_ros::Buffer buffer;
  tf2_ros::TransformListener listener(buffer);
  WaitUntil([&] { return buffer.canTransform("base_link", "left_camera_optical", ros::Time(0)); },
            "tf to the camera");
  const Inbox<nav_msgs::Odometry> tracks("/track_odom");
  EXPECT_EQ(tracks.last().twist.twist.linear.x, 0);
}

TEST_F(RoverTest, WithoutCamerasNoNodeIsBusy) {
  const std::string nodes[] = {"/stereo/stereo_camera_node",
                               "/stereo/stereo_image_proc",
                               "/head/pan_tilt_node",
                               "/robot_state_publisher",
                               "/arfm_node",
                               "/pose_node",
                               "/ba_node",
                               "/chassis_node"};
  std::map<std::string, double> cpu_s;
  for (const std::string& node : nodes) cpu_s[node] = CpuSeconds(PidOf(node));
  const double start_s = MonotonicNow();
  const int num_before = diagnoses_.size();
  // Some seconds: each node says how it is once in one.
  WaitUntil([&] { return diagnoses_.size() > num_before + 25; }, "diagnostics");
  const double passed_s = MonotonicNow() - start_s;
  for (const std::string& node : nodes)
    EXPECT_LT(CpuSeconds(PidOf(node)) - cpu_s[node], 0.3 * passed_s) << node;
}

TEST_F(RoverTest, TheBlackBoxRecordsTheDrive) {
  const auto has_bag = [] {
    for (const auto& file : std::filesystem::directory_iterator(Parameter("bags")))
      if (file.path().filename().string().rfind("drive_", 0) == 0 && file.file_size() > 0)
        return true;
    return false;
  };
  WaitUntil(has_bag, "a bag that grows");
}

}  // namespace
}  // namespace arfm_vo
