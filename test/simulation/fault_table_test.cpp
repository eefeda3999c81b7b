#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <limits>
#include <set>
#include <sstream>

#include "simulation/simulated_drive.h"

// Injects every fault into a rover that drives at 0.1 m/s, measures how long it goes on, and makes
// the table docs/faults.md of it (ARFM_VO_FAULT_TABLE names the file to write).

namespace arfm_vo {
namespace {

using Action = std::function<void(SimulatedDrive&)>;
using Condition = std::function<bool(const SimulatedDrive&, double injected_s)>;

enum class Stopper { kDriver, kChassisTimeout };  ///< who brings the rover to a stand

struct Fault {
  std::string name;
  Action inject;
  std::string remedy;  ///< what must be done before the rover may go on
  Action mend;
  std::string limit = "";  ///< what the fault must exceed before it counts as one
  Condition is_beyond_limit = [](const SimulatedDrive&, double) { return true; };
  Stopper stopper = Stopper::kDriver;
  bool by_velocity = false;   ///< drives by velocity commands, not to a goal
  bool keeps_moving = false;  ///< nothing on the bus can bring the tracks to a stand
};

struct Row {
  Fault fault;
  double injected_s = 0, limit_s = 0, stop_s = 0, standing_s = 0;
  StopReason reason = StopReason::kNone;
  std::string go_on = "";
  bool has_stopped = false;
};

const double kNaN = std::numeric_limits<double>::quiet_NaN();

Condition PoseOlderThan(double age_s) {
  return [age_s](const SimulatedDrive& drive, double) {
    return drive.Now() - drive.LastPoseTaken() > age_s;
  };
}

Condition TimeSince(double duration_s) {
  return [duration_s](const SimulatedDrive& drive, double injected_s) {
    return drive.Now() - injected_s > duration_s;
  };
}

bool IsSlipBeyondLimit(const SimulatedDrive& drive, double) {
  const auto slip = drive.pilot().Status().slip;
  return slip && slip->forward_ratio.value_or(0) > SlipOptions().max_slip_ratio;
}

void SendVelocity(SimulatedDrive& drive) { drive.pilot().SetVelocity(drive.Now(), {0.1, 0}); }

const Action kNothing = [](SimulatedDrive&) {};

std::vector<Fault> OperatorFaults() {
  return {
      {"stop service called", [](auto& d) { d.pilot().Stop(); }, "", kNothing},
      {"software emergency stop set", [](auto& d) { d.pilot().SetEmergencyStop("joystick", true); },
       "its source clears the emergency stop",
       [](auto& d) { d.pilot().SetEmergencyStop("joystick", false); }},
      {"operator does not answer", [](auto& d) { d.has_operator_ = false; }, "the operator is back",
       [](auto& d) { d.has_operator_ = true; }, "no answer for 0.9 s",
       [](const auto& d, double) { return d.Now() - d.LastAnswer() > 0.9; }},
      {"goal cancelled", [](auto& d) { d.pilot().CancelRoute(); }, "", kNothing},
      {"velocity commands cease", [](auto& d) { d.each_tick_ = [] {}; }, "", kNothing, "0.15 s",
       TimeSince(0.15), Stopper::kDriver, true},
      {"velocity command is not a number",
       [](auto& d) { d.each_tick_ = [&d] {
                       d.pilot().SetVelocity(d.Now(), {kNaN, 0});
                     }; }, "",
       [](auto& d) { d.each_tick_ = [] {}; }, "", TimeSince(0), Stopper::kDriver, true},
      {"velocity commands of two nodes",
       [](auto& d) {
         d.each_tick_ = [&d] {
           SendVelocity(d);
           d.pilot().SetVelocity(d.Now(), {-0.1, 0}, "/another");
         };
       },
       "both are let go", [](auto& d) { d.each_tick_ = [] {}; }, "", TimeSince(0), Stopper::kDriver,
       true},
  };
}

std::vector<Fault> PoseFaults() {
  const auto mend_pose = [](auto& d) {
    d.has_pose_ = d.has_covariance_ = true;
    d.is_tf_missing_ = false;
    d.sigma_m_ = 0.01;
    d.stamp_offset_s_ = 0;
    d.false_pose_.reset();
  };
  const auto covariance_old = [](const auto& d, double) {
    return d.Now() - d.LastCovarianceTaken() > 1.0;
  };
  return {
      {"odometry falls silent (pose stale)", [](auto& d) { d.has_pose_ = false; }, "", mend_pose,
       "pose older than 1 s", PoseOlderThan(1.0)},
      {"odometry is lost (covariance 9999)", [](auto& d) { d.sigma_m_ = 99.99; }, "", mend_pose},
      {"covariance too large", [](auto& d) { d.sigma_m_ = 2.1; }, "", mend_pose, "sigma above 2 m"},
      {"covariance is not a number", [](auto& d) { d.sigma_m_ = kNaN; }, "", mend_pose},
      {"covariance ceases", [](auto& d) { d.has_covariance_ = false; }, "", mend_pose,
       "older than 1 s", covariance_old},
      {"tf from map to base is missing", [](auto& d) { d.is_tf_missing_ = true; }, "", mend_pose},
      {"pose is not a number",
       [](auto& d) {
         d.false_pose_ = Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(kNaN, 0, 0));
       },
       "", mend_pose},
      {"pose's quaternion is all zeros",
       [](auto& d) {
         d.false_pose_.emplace();
         d.false_pose_->rotation.coeffs().setZero();
       },
       "", mend_pose},
      {"clock leaps back (poses from the future)", [](auto& d) { d.stamp_offset_s_ = 30; }, "",
       mend_pose},
      {"clock leaps ahead (poses of long ago)", [](auto& d) { d.stamp_offset_s_ = -30; }, "",
       mend_pose, "pose older than 1 s", PoseOlderThan(1.0)},
      {"tracks run and the rover is stuck", [](auto& d) { d.plant().SetForwardSlip(1); },
       "free the rover", [](auto& d) { d.plant().SetForwardSlip(0.1); },
       "slip ratio above 0.5 over 0.3 m", IsSlipBeyondLimit},
  };
}

Rigid3 PlaceAt(double x_m, double y_m) { return LiftFromPlane({x_m, y_m, 0}); }

void CreepSideways(SimulatedDrive& d) {
  d.each_tick_ = [&d] { d.told_from_true_ = PlaceAt(0, 0.002) * d.told_from_true_; };
}

std::vector<Fault> WrongPoseFaults() {
  const auto mend = [](auto& d) {
    d.told_from_true_ = d.map_from_odom_ = d.base_from_told_ = Rigid3();
    d.each_tick_ = [] {};
  };
  const Rigid3 aside = LiftFromPlane({0, 0, M_PI / 12});
  const auto tilt = [](auto& d) {
    d.told_from_true_ = Rigid3(ExpSO3({26 * M_PI / 180, 0, 0}), Eigen::Vector3d::Zero());
  };
  return {
      {"odometry restarts elsewhere, unannounced",
       [](auto& d) { d.told_from_true_ = PlaceAt(9, 0); }, "", kNothing},
      {"odometry announces a new epoch", [](auto& d) { ++d.epoch_; }, "", kNothing},
      {"odometry restarts elsewhere with a new epoch",
       [](auto& d) {
         ++d.epoch_;
         d.told_from_true_ = PlaceAt(9, 0);
       },
       "", kNothing},
      {"map -> odom jumps by 0.5 m", [](auto& d) { d.map_from_odom_ = PlaceAt(0, 0.5); }, "",
       kNothing},
      {"map -> odom is no longer told (ba_node is gone)",
       [](auto& d) {
         d.is_tf_missing_ = true;
         d.no_pose_reason_ = StopReason::kMapStale;
       },
       "", [](auto& d) { d.is_tf_missing_ = false; }},
      {"rover slides sideways at 0.1 m/s", CreepSideways, "", mend,
       "0.1 m and 30 % of the way, in 3 s", TimeSince(1.85)},
      {"head's belt slips by 15 degrees", [aside](auto& d) { d.base_from_told_ = aside; }, "",
       mend},
      {"rover is tilted by 26 degrees", tilt, "level it", mend, "25 degrees"},
  };
}

std::vector<Fault> MotionFaults() {
  return {
      {"remote control is lost (0x211)", [](auto& d) { d.chassis().SetRemoteLost(true); },
       "switch it on", [](auto& d) { d.chassis().SetRemoteLost(false); }},
      {"motor driver reports a fault (0x261)", [](auto& d) { d.chassis().SetMotorStatus(0x44); },
       "mend it", [](auto& d) { d.chassis().SetMotorStatus(0x40); }},
      {"tracks run away at 0.2 m/s",
       [](auto& d) {
         d.chassis().SetRunaway(PlanarMotion{0.2, 0});
       },
       "mend it", [](auto& d) { d.chassis().SetRunaway({}); },
       "0.05 m/s over the command for 0.2 s", TimeSince(0.27), Stopper::kDriver, false, true},
      {"left track is jammed", [](auto& d) { d.chassis().JamLeftTrack(true); }, "free it",
       [](auto& d) { d.chassis().JamLeftTrack(false); }, "below 10 % of the command for 2 s",
       TimeSince(1.9), Stopper::kDriver, false, true},
      {"feedback repeats itself", [](auto& d) { d.chassis().SetFrozenFeedback(true); }, "mend it",
       [](auto& d) { d.chassis().SetFrozenFeedback(false); }, "counter stands for 1 s",
       TimeSince(1)},
  };
}

std::vector<Fault> ChassisFaults() {
  const auto power_on = [](auto& d) { d.chassis().SetPower(true); };
  const auto clear = [](auto& d) { d.driver().link().SendClearErrors(); };
  const auto silence = [](std::optional<FeedbackKind> kind) {
    return [kind](auto& d) { d.chassis().Silence(kind); };
  };
  return {
      {"emergency stop button (0x211)", [](auto& d) { d.chassis().PressEmergencyStop(true); },
       "release the button", [](auto& d) { d.chassis().PressEmergencyStop(false); }},
      {"battery fault (0x211)", [](auto& d) { d.chassis().SetFault(0x0001); },
       "charge, clear_errors", clear},
      {"remote control takes over (0x211)",
       [](auto& d) {
         d.chassis().TakeRemoteControl({0.05, 0});
       },
       "hand back (CAN mode is asked for again)", [](auto& d) { d.chassis().HandBack(); }},
      {"chassis restarts into standby (0x211)",
       [power_on](auto& d) {
         d.chassis().SetPower(false);
         power_on(d);
       },
       "", kNothing},
      {"chassis loses power (silent)", [](auto& d) { d.chassis().SetPower(false); }, "switch it on",
       power_on, "silent for 0.5 s", TimeSince(0.5)},
      {"track odometer falls silent", silence(FeedbackKind::kOdometer), "mend it", silence({}),
       "silent for 0.5 s", TimeSince(0.5)},
      {"motion feedback falls silent (0x221)", silence(FeedbackKind::kMotion), "mend it",
       silence({}), "silent for 0.5 s", TimeSince(0.5)},
  };
}

/// As many frames as 500 kbit/s can carry, and the button pressed at the same time.
void FloodAndPress(SimulatedDrive& d) {
  d.chassis().PressEmergencyStop(true);
  const std::shared_ptr<CanBus> end = d.bus_.OpenEnd();
  d.each_tick_ = [end] {
    for (int i = 0; i < 160; ++i) end->Send(MakeCanFrame(0x3FF, {1, 2, 3}));
  };
}

std::vector<Fault> BusFaults() {
  const auto set_state = [](CanBusState state) {
    return [state](auto& d) { d.bus_.SetState(state); };
  };
  return {
      {"CAN controller goes bus-off", set_state(CanBusState::kBusOff), "controller restarts",
       set_state(CanBusState::kUp), "", TimeSince(0), Stopper::kChassisTimeout},
      {"CAN interface goes down", set_state(CanBusState::kDown), "interface up",
       set_state(CanBusState::kUp), "", TimeSince(0), Stopper::kChassisTimeout},
      {"send queue stays full (ENOBUFS)", [](auto& d) { d.bus_.SetBusy(true); }, "queue runs again",
       [](auto& d) { d.bus_.SetBusy(false); }, "", TimeSince(0), Stopper::kChassisTimeout},
      {"flood of foreign frames, and the button is pressed", FloodAndPress,
       "end the flood, release the button",
       [](auto& d) {
         d.each_tick_ = [] {};
         d.chassis().PressEmergencyStop(false);
       }},
  };
}

std::vector<Fault> NodeFaults() {
  return {
      {"node ends (SIGINT, SIGTERM)", [](auto& d) { d.EndDriver(); }, "new node", kNothing},
      {"computer's clock is set by 30 s", [](auto& d) { d.pilot().ObserveClockSet(d.Now(), 30); },
       "", kNothing},
      {"node hangs or is killed", [](auto& d) { d.is_driver_hung_ = true; }, "new node", kNothing,
       "", TimeSince(0), Stopper::kChassisTimeout},
  };
}

/// A rover at full speed, at a moment between two ticks.
void BringToSpeed(SimulatedDrive& drive, bool by_velocity) {
  drive.Run(0.5);
  ASSERT_TRUE(drive.pilot().Start(drive.Now()).is_accepted);
  if (by_velocity) drive.each_tick_ = [&drive] { SendVelocity(drive); };
  if (!by_velocity) drive.pilot().SetRoute({{500, 0, {}}});
  drive.Run(4.011);
  ASSERT_GT(drive.Commanded().forward_mps, 0.099);
  ASSERT_GT(drive.FastestTrack(), 0.099);
}

bool Moves(SimulatedDrive& drive, double within_s) {
  return drive.RunUntil(within_s, [&] { return drive.Commanded().forward_mps > 0.05; });
}

/// What it takes, beyond the remedy, until the rover drives again.
std::string FindWhatItTakes(SimulatedDrive& drive, const Fault& fault) {
  if (Moves(drive, 5)) return "by itself, after 1 s of good poses and 2 s of warning";
  const bool was_ready = drive.pilot().Status().state == DriveState::kReady;
  if (!was_ready && !drive.pilot().Start(drive.Now()).is_accepted) return "cannot be started";
  const std::string start = was_ready ? "" : "start";
  if (Moves(drive, 5)) return start;
  if (fault.by_velocity) {
    drive.each_tick_ = [&drive] { SendVelocity(drive); };
    return Moves(drive, 5) ? "a new velocity command" : "does not go on";
  }
  drive.pilot().SetRoute({{500, 0, {}}});
  if (!Moves(drive, 5)) return "does not go on";
  return start.empty() ? "a new goal" : start + " and a new goal";
}

Row Measure(const Fault& fault) {
  Row row{fault};
  SimulatedDrive drive;
  BringToSpeed(drive, fault.by_velocity);
  row.injected_s = drive.Now();
  fault.inject(drive);
  row.limit_s = row.standing_s = std::numeric_limits<double>::infinity();
  const bool is_node_gone = fault.remedy == "new node";
  drive.RunUntil(30, [&] {
    if (std::isinf(row.limit_s) && (is_node_gone || fault.is_beyond_limit(drive, row.injected_s)))
      row.limit_s = drive.Now();
    if (std::isinf(row.standing_s) && drive.FastestTrack() < 0.001) row.standing_s = drive.Now();
    const bool is_quiet = drive.Now() - drive.LastMovingCommandTime() > 1;
    const bool is_driven_on =
        fault.keeps_moving || fault.name.find("remote control takes over") == 0;
    return is_quiet && (std::isfinite(row.standing_s) || is_driven_on);
  });
  row.has_stopped = drive.Now() - drive.LastMovingCommandTime() > 1;
  const bool has_stop_frame = drive.FirstStopCommandTime() > drive.LastMovingCommandTime();
  row.stop_s = has_stop_frame ? drive.FirstStopCommandTime() : drive.LastMovingCommandTime();
  if (is_node_gone) {
    row.go_on = "new node, start and a new goal";
    return row;
  }
  row.reason = drive.pilot().Status().reason;
  fault.mend(drive);
  drive.Run(0.3);
  const std::string needed = FindWhatItTakes(drive, fault);
  row.go_on = fault.remedy.empty() ? needed : fault.remedy + "; " + needed;
  return row;
}

const std::vector<Row>& Rows() {
  static std::vector<Row> rows;
  if (!rows.empty()) return rows;
  for (const auto& faults : {OperatorFaults(), PoseFaults(), WrongPoseFaults(), ChassisFaults(),
                             MotionFaults(), BusFaults(), NodeFaults()})
    for (const Fault& fault : faults) rows.push_back(Measure(fault));
  return rows;
}

std::string Milliseconds(double duration_s) {
  if (!std::isfinite(duration_s)) return "-";
  return std::to_string(std::max(0L, std::lround(1000 * duration_s)));
}

std::string Table() {
  std::ostringstream text;
  text << R"(# Faults, and how the rover stops

Made by `scripts/measure.sh fault_table` (the test `FaultTable`): each fault is injected into a simulated rover that
drives at 0.1 m/s, over the CAN frames of the real chassis, on a simulated clock of 1 ms. *Stop* is the time
from the fault, and from the moment it exceeds its limit, to the stop frame on the bus (where nothing gets
through: to the last frame that moves); *tracks stand* is when both tracks run below 1 mm/s, their own inertia
(time constant 0.1 s) included. Where no stop frame gets through, the chassis' own command timeout of
500 ms stops it. Every fault is then mended, to see what it takes to go on. No
process and no ROS clock takes part: what the nodes do in the running graph is not measured here.

| fault | limit | stop after the fault, ms | after the limit, ms | tracks stand, ms | status says | to go on |
|---|---|---|---|---|---|---|
)";
  for (const Row& row : Rows()) {
    const bool by_timeout = row.fault.stopper == Stopper::kChassisTimeout;
    text << "| " << row.fault.name << " | " << row.fault.limit << " | "
         << Milliseconds(row.stop_s - row.injected_s) << (by_timeout ? " (no frame)" : "") << " | "
         << Milliseconds(row.stop_s - row.limit_s) << " | "
         << Milliseconds(row.standing_s - row.injected_s) << " | "
         << (row.fault.remedy == "new node" ? "-" : ToString(row.reason)) << " | " << row.go_on
         << " |\n";
  }
  return text.str();
}

/// Where no frame gets through, the chassis stops itself.
TEST(FaultTable, EveryFaultStopsTheRoverWithin200Milliseconds) {
  for (const Row& row : Rows()) {
    EXPECT_TRUE(row.has_stopped) << row.fault.name;
    EXPECT_LE(row.stop_s - row.limit_s, 0.2) << row.fault.name;
    EXPECT_GE(row.stop_s, row.injected_s - 0.02) << row.fault.name;
    if (row.fault.stopper == Stopper::kChassisTimeout) {
      EXPECT_LE(row.standing_s - row.injected_s, 0.5 + 0.5) << row.fault.name;
    }
  }
}

const std::set<StopReason> kPauseReasons = {StopReason::kPoseMissing, StopReason::kPoseInvalid,
                                            StopReason::kPoseStale, StopReason::kPoseUncertain,
                                            StopReason::kMapStale};

TEST(FaultTable, OnlyAPoseThatWasAwayIsLeftWithoutAHand) {
  for (const Row& row : Rows()) {
    const bool by_itself = row.go_on.find("by itself") != std::string::npos;
    EXPECT_EQ(by_itself, kPauseReasons.count(row.reason) > 0)
        << row.fault.name << ": " << row.go_on;
    EXPECT_EQ(row.go_on.find("not"), std::string::npos) << row.fault.name << ": " << row.go_on;
  }
}

TEST(FaultTable, TheDocumentIsWhatTheTestMeasured) {
  if (const char* path = std::getenv("ARFM_VO_FAULT_TABLE")) {
    const std::string temporary = std::string(path) + ".new";
    std::ofstream(temporary) << Table();
    ASSERT_EQ(std::rename(temporary.c_str(), path), 0) << path;
    return;
  }
  std::ifstream file(ARFM_VO_SOURCE_DIR "/docs/faults.md");
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_EQ(text.str(), Table())
      << "docs/faults.md is out of date: run scripts/measure.sh fault_table";
}

}  // namespace
}  // namespace arfm_vo
