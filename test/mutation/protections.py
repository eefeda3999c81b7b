"""The protections of the rover's driving, each with what removes it."""
import dataclasses

BASIC = ("driving", "simulation", "hardware")
NODE = ("chassis_node",)


@dataclasses.dataclass
class Protection:
    name: str
    file: str
    old: str  # stands there once; a statement where it ends with a semicolon, else an expression
    new: str
    suites: tuple = BASIC


def pose_watch():
    file = "src/driving/pose_watch.cpp"
    return [Protection(name, file, old, new) for name, old, new in (
        ("a sighting is compared with the tracks", "jump.IsExcessive()", "false"),
        ("a slide is looked for", "slide.IsExcessive()", "false"),
        ("steps of the map are bounded", "!step.IsExcessive()", "true"),
        ("a new epoch is noticed", "if (!is_new) return false;", "return false;"),
        ("sightings from before an epoch do not count", "epoch_start_s_ && pose.taken_s < *epoch_start_s_ - kClockNoise_s", "false"),
        ("a pose waits for its covariance", "if (!options_.requires_covariance) return true;", "return true;"),
        ("a pose without epoch is not driven by", "options_.requires_epoch && !epoch_", "false"),
        ("covariances from the future are refused", "if (!(uncertainty.taken_s <= now_s + kMaxFromFuture_s)) return false;", ""),
        ("poses from the future are refused", "pose.taken_s > now_s + kMaxFromFuture_s", "false"),
        ("a stale pose pauses", "now_s - told_->taken_s > options_.max_pose_age_s", "false"),
        ("a stale covariance pauses", "!(now_s - uncertainty_->taken_s <= options_.max_pose_age_s)", "false"),
        ("an uncertain pose pauses", "if (IsUncertain(now_s)) return StopReason::kPoseUncertain;", ""),
        ("the heading's sigma counts", "Since(datum.heading_sigma_rad, uncertainty_->heading_sigma_rad) <=\n"
         "               options_.max_heading_sigma_rad", "true"),
    )]


def pilot_faults():
    file = "src/driving/pilot_faults.cpp"
    return [Protection(name, file, old, new) for name, old, new in (
        ("a wrong pose drops the goal", "if (!keeps_route) EndRoute(GoalOutcome::kCancelled, fault);", ""),
        ("a wrong pose blocks", "is_explained || (state_ != DriveState::kStandby && state_ != DriveState::kBlocked)", "false"),
        ("a long pause blocks", "now_s - pause_start_s_ > options_.max_pause_s", "false"),
        ("a motion is warned of", "now_s - warned_since_s_ >= options_.warning_s", "true"),
        ("a pause lasts until the pose is good", "now_s - flawed_s_ < options_.resume_after_s", "false"),
        ("the operator is needed", 'if (operator_.IsMissing()) return Fault{StopReason::kOperatorLost, operator_.DescribeRefused()};', ""),
        ("the emergency stop stops", "!emergency_sources_.empty()", "false"),
        ("tilt stops", 'if (pose_.IsTilted()) return Fault{StopReason::kTilt, ""};', ""),
        ("a velocity is forgotten in time", "now_s - velocity_s_ <= options_.velocity_timeout_s", "true"),
        ("a goal that waited long is dropped", "last_tick_s_ - *waiting_since_s_ <= options_.goal_limits.max_standby_s", "true"),
        ("slip stops", 'if (slip_.IsExcessive()) return Fault{StopReason::kSlip, ""};', ""),
        ("no progress stops", 'if (progress_.IsStalled()) return Fault{StopReason::kNoProgress, ""};', ""),
        ("outside the fence stops", "predicted_ && !goal_limits_.IsInsideFence(predicted_->x_m, predicted_->y_m)", "false"),
        ("a chassis that takes no commands stops",
         "!chassis_.IsOurs() && !(is_arming && now_s - armed_s_ <= options_.arming_timeout_s)", "false"),
        ("a velocity is forgotten when blocked", "detail_ = fault.detail;\n  velocity_s_ = kNeverCommanded_s;",
         "detail_ = fault.detail;"),
    )]


def pilot():
    file = "src/driving/pilot.cpp"
    return [Protection(name, file, old, new) for name, old, new in (
        ("an emergency stop belongs to its source", "emergency_sources_.erase(source);", "emergency_sources_.clear();"),
        ("the 65th emergency stop counts", 'emergency_sources_.insert(is_room ? source : "further nodes");',
         "if (is_room) emergency_sources_.insert(source);"),
        ("no start with a fault", 'if (const auto fault = FindStartFault(now_s)) return {false, "not started: " + InWords(*fault)};', ""),
        ("goals have limits", "!flaw.empty()", "false"),
        ("no goals while blocked", 'if (state_ == DriveState::kBlocked)\n'
         '    return {false, "goal refused: the rover is blocked: " + InWords({reason_, detail_})};', ""),
        ("no goals in a long standby",
         'if (DropOldRoute()) return {false, "goal refused: the rover is in standby; start it first"};', ""),
        ("a late tick is no leap of the speed", "std::clamp(now_s - last_tick_s_, 0.0, kMaxTick_s)", "now_s - last_tick_s_"),
        ("a pilot that was held up blocks", 'if (was_held_up) Distrust({StopReason::kHeldUp, ""});', ""),
        ("the velocity is forgotten at a stop", "reason_ = StopReason::kStopped;\n  detail_.clear();\n"
         "  velocity_s_ = kNeverCommanded_s;", "reason_ = StopReason::kStopped;\n  detail_.clear();"),
        ("a velocity that is not finite is refused", "!motion.IsFinite()", "false"),
        ("two nodes do not command velocities", "IsMovedByAnother(now_s, source)", "false"),
        ("a velocity that streams on is no new command",
         "if (state_ != DriveState::kPaused && state_ != DriveState::kWarning) commanded_s_ = now_s;", "commanded_s_ = now_s;"),
        ("no velocity beside a goal", 'if (route_) return {false, "velocity refused: a goal is being driven to"};', ""),
        ("no datum while driving", "state_ == DriveState::kDriving || state_ == DriveState::kWarning", "false"),
        ("a stop forgets the speed", "limiter_.Halt();", ""),
        ("an arrival is seen at rest",
         "pose_.HasPose() && pose_.LastSighting().taken_s >= at_rest_since_s_ + options_.settle_s", "pose_.HasPose()"),
    )]


def chassis():
    watch, motion, limits = ("src/driving/%s.cpp" % name for name in ("chassis_watch", "motion_watch", "goal_limits"))
    return [
        Protection("a lost remote control is a fault", watch, "status_->is_remote_lost && !options_.allows_remote_lost", "false"),
        Protection("other drivers are noticed", watch, "foreign_s_ && now_s - *foreign_s_ <= options_.foreign_command_s", "false"),
        Protection("the emergency stop button stops", watch, "if (status_->is_emergency_stop) return Fault{StopReason::kChassisEmergency, \"\"};", ""),
        Protection("a motor's fault stops", watch, "if (status_->has_motor_fault) return Fault{StopReason::kMotorFault, status_->detail};", ""),
        Protection("the remote control takes over", watch, "if (IsRemote()) return Fault{StopReason::kRemoteControl, \"\"};", ""),
        Protection("a bus that is down stops", watch, "if (!is_bus_up_) return Fault{StopReason::kBusDown, \"\"};", ""),
        Protection("each kind of feedback that falls silent stops", watch, "heard_s && now_s - *heard_s > options_.max_feedback_age_s", "false"),
        Protection("no start before the chassis has told all", watch, "!heard_s && kind < kNumRequired", "false"),
        Protection("a runaway stops", motion, "excess_since_s_ && now_s - *excess_since_s_ >= options_.max_excess_s", "false"),
        Protection("frozen feedback stops", motion, "counted_s_ && now_s - *counted_s_ > options_.max_frozen_s", "false"),
        Protection("a motor's current is limited", motion,
                   "current_since_s_ && now_s - *current_since_s_ >= options_.max_current_s", "false"),
        Protection("motion at rest is told", motion, "!away_since_s_ || now_s - *away_since_s_ < options_.max_excess_s", "true"),
        Protection("a jammed track stops", motion, "return FindJam();", "return std::nullopt;"),
        Protection("a goal's distance is limited", limits, "!(distance_m <= options_.max_distance_m)", "false"),
        Protection("a goal lies inside the fence", limits,
                   'if (!IsInsideFence(to.x_m, to.y_m)) return NameOf(i, route.size()) + " is outside the fence";', ""),
        Protection("the way stays inside the fence", limits, "if (CrossesFence(from, to))\n"
                   '      return "the way to " + NameOf(i, route.size()) + " leaves the fence";', ""),
        Protection("a path's length is limited", limits, "route.size() > static_cast<size_t>(options_.max_waypoints)", "false"),
        Protection("only finite speeds are driven", "src/driving/speed_limiter.cpp",
                   "wanted.IsFinite() ? Shrink(wanted) : PlanarMotion{}", "Shrink(wanted)"),
    ]


def bus():
    link, driver = "src/hardware/chassis_link.cpp", "src/hardware/chassis_driver.cpp"
    return [
        Protection("the speed is clamped on the bus", link,
                   "std::clamp(motion.forward_mps, -kMaxSpeed_mps, kMaxSpeed_mps)", "motion.forward_mps"),
        Protection("the turn rate is clamped on the bus", link,
                   "std::clamp(motion.turn_radps, -kMaxChassisTurnRate_radps, kMaxChassisTurnRate_radps)", "motion.turn_radps"),
        Protection("a bus-off is remembered until the next tick", link,
                   "if (frame->kind == CanFrameKind::kBusOff) was_bus_lost_ = true;", ""),
        Protection("a send queue that is stuck is a bus that is down", link, "num_busy_in_a_row_ < kMaxBusyInARow", "true"),
        Protection("no frame before start", link, "if (!command.may_speak) return;", ""),
        Protection("the driver says farewell", driver, "link_.SendFarewell();", ""),
        Protection("error bits are faults", driver, "(state.error_bits & ~kErrorBitsNoFault) != 0", "false"),
        Protection("each command of another driver counts", link,
                   "std::count(kCommandIds.begin(), kCommandIds.end(), frame.id) > 0", "frame.id == 0x111"),
        Protection("one driver a bus", "src/hardware/bus_lock.cpp",
                   "::bind(socket_.Get(), reinterpret_cast<const sockaddr*>(&address), size) != 0", "false"),
    ]


def nodes():
    node = "src/ros/rover/chassis_node.cpp"
    ros = ("ros",)
    return [
        Protection("simulated time is refused on a real bus", node, "!ros::Time::isSimTime() || IsSimulatedBus(options.can)",
                   "true", ("simulated_graph",)),
        Protection("a clock that stands stops the rover", node, "!sighting || is_clock_stalled", "!sighting", ("clock_stall",)),
        Protection("a map frame that is no longer told stops", node,
                   "sighting->MapAge(ros::Time::now()) > options_.max_map_age_s", "false", NODE),
        Protection("velocities are told by their nodes", node,
                   "driver_.pilot().SetVelocity(clock_.Now(), motion, event.getPublisherName())",
                   "driver_.pilot().SetVelocity(clock_.Now(), motion)", NODE),
        Protection("an operator's time is the wall's", node, "ChallengeOperator(ros::SteadyTime::now().toSec());", "ChallengeOperator(now_s);",
                   ("clock_stall",)),
        Protection("errors are cleared at rest only", node, 'if (!is_at_rest) return {false, "not sent: the rover moves"};', "", NODE),
        Protection("a node asks how old a goal is", node, "goal_reader_.RequireFresh(goal.header, ros::Time::now());", "", NODE),
        Protection("an old goal, as a latched one, is refused", "src/ros/rover/chassis_inputs.cpp", "age_s <= max_age_s", "true", ros),
        Protection("a goal from the future is refused", "src/ros/rover/chassis_inputs.cpp", "age_s >= -kMaxFromFuture_s", "true", ros),
        Protection("a tf from the future is refused", "src/ros/messages/transforms.cpp",
                   "transform.header.stamp.toSec() > now.toSec() + kMaxFromFuture_s", "false", ("ros",) + NODE),
        Protection("driving time never runs back", "src/ros/rover/chassis_inputs.cpp",
                   "std::max(0.0, now.toSec() - last_.toSec())", "now.toSec() - last_.toSec()", ("ros", "clock_stall")),
        Protection("another odometry process is another epoch", "src/ros/rover/chassis_inputs.cpp", "connection != connection_", "false", NODE),
        Protection("SIGHUP leaves a standing rover", "nodes/chassis_node.cpp",
                   "::signal(signal, [](int) { ros::requestShutdown(); });",
                   "if (signal != SIGHUP) ::signal(signal, [](int) { ros::requestShutdown(); });", NODE),
        Protection("a covariance that is none is not taken for a good one", "src/ros/rover/chassis_inputs.cpp",
                   "if (!position.allFinite()) return uncertainty;",
                   "if (!position.allFinite()) { uncertainty.position_sigma_m = 0; return uncertainty; }", ros),
        Protection("the head does not home while the rover drives", "src/ros/rover/pan_tilt_node.cpp",
                   'Require(!drive_.IsDriving(), "the rover drives: stop it first");', "", ("pan_tilt",)),
        Protection("no calibration is set while the rover drives", "src/ros/rover/camera_eye.cpp",
                   "drive_.IsDriving()", "false", ("stereo_camera",)),
    ]


def operator_watch():
    return [Protection(name, "src/driving/operator_watch.cpp", old, new) for name, old, new in (
        ("a late answer does not count", "sent == sent_.end() || steady_s - sent->sent_s > options_.max_round_trip_s", "sent == sent_.end()"),
        ("a repeated answer does not count", "if (sent->is_answered) return ++answers_.num_repeated, false;", ""),
        ("a foreign answer does not count", "if (!is_ours) return ++answers_.num_foreign, false;", ""),
        ("an answer is as old as its challenge", "std::max(answered_s_, sent->sent_s)", "steady_s"))]


PROTECTIONS = operator_watch() + pose_watch() + pilot_faults() + pilot() + chassis() + bus() + nodes()
