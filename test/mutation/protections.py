"""The protections of the rover's driving, each with what removes it."""
import collections

BASIC, NODE, ROS = ("driving", "simulation", "hardware"), ("chassis_node",), ("ros",)
# `old` stands in the file once; it is a statement where it ends with a semicolon, else an expression.
Protection = collections.namedtuple("Protection", "name file old new suites")
TABLE = (
    ("src/driving/operator_watch.cpp", BASIC, (
        ("a late answer does not count", "sent == sent_.end() || steady_s - sent->sent_s > options_.max_round_trip_s", "sent == sent_.end()"),
        ("a repeated answer does not count", "if (sent->is_answered) return ++answers_.num_repeated, false;", ""),
        ("a foreign answer does not count", "if (!is_ours) return ++answers_.num_foreign, false;", ""),
        ("an answer is as old as its challenge", "std::max(answered_s_, sent->sent_s)", "steady_s"))),
    ("src/driving/pose_watch.cpp", BASIC, (
        ("a sighting is compared with the tracks", "jump.IsExcessive()", "false"),
        ("a slide is looked for", "slide.IsExcessive()", "false"),
        ("steps of the map are bounded", "!step.IsExcessive()", "true"),
        ("a new epoch is noticed", "if (!is_new) return false;", "return false;"),
        ("sightings from before an epoch do not count", "epoch_start_s_ && pose.taken_s < *epoch_start_s_ - kClockNoise_s", "false"),
        ("a pose waits for its covariance", "uncertainty_->taken_s < told_->taken_s - kClockNoise_s", "false"),
        ("a pose without epoch is not driven by", "!epoch_", "false"),
        ("covariances from the future are refused", "if (!(uncertainty.taken_s <= now_s + kMaxFromFuture_s)) return false;", ""),
        ("poses from the future are refused", "pose.taken_s > now_s + kMaxFromFuture_s", "false"),
        ("a stale pose pauses", "now_s - told_->taken_s > options_.max_pose_age_s", "false"),
        ("a stale covariance pauses", "!(now_s - uncertainty_->taken_s <= options_.max_pose_age_s)", "false"),
        ("an uncertain pose pauses", "if (IsUncertain(now_s)) return StopReason::kPoseUncertain;", ""),
        ("the heading's sigma counts",
         "Since(datum.heading_sigma_rad, uncertainty_->heading_sigma_rad) <=\n               options_.max_heading_sigma_rad", "true"))),
    ("src/driving/pilot_faults.cpp", BASIC, (
        ("a wrong pose drops the goal", "if (!keeps_route) EndRoute(GoalOutcome::kCancelled, fault);", ""),
        ("a wrong pose blocks", "is_explained || (state_ != DriveState::kStandby && state_ != DriveState::kBlocked)", "false"),
        ("a long pause blocks", "now_s - pause_start_s_ > options_.max_pause_s", "false"),
        ("a motion is warned of", "now_s - warned_since_s_ >= options_.warning_s", "true"),
        ("a pause lasts until the pose is good", "now_s - flawed_s_ < options_.resume_after_s", "false"),
        ("the operator is needed", "if (operator_.IsMissing()) return Fault{StopReason::kOperatorLost, operator_.DescribeRefused()};", ""),
        ("the emergency stop stops", "!emergency_sources_.empty()", "false"),
        ("tilt stops", 'if (pose_.IsTilted()) return Fault{StopReason::kTilt, ""};', ""),
        ("a velocity is forgotten in time", "now_s - velocity_s_ <= options_.velocity_timeout_s", "true"),
        ("a goal that waited long is dropped", "last_tick_s_ - *waiting_since_s_ <= options_.goal_limits.max_standby_s", "true"),
        ("slip stops", "if (const auto excess = slip_.FindExcess()) return Fault{StopReason::kSlip, *excess};", ""),
        ("no progress stops", 'if (progress_.IsStalled()) return Fault{StopReason::kNoProgress, ""};', ""),
        ("outside the fence stops", "predicted_ && !goal_limits_.IsInsideFence(predicted_->x_m, predicted_->y_m)", "false"),
        ("a chassis that takes no commands stops", "!chassis_.IsOurs() && !(is_arming && now_s - armed_s_ <= options_.arming_timeout_s)", "false"),
        ("a velocity is forgotten when blocked", "why_ = fault;\n  velocity_s_ = kNeverCommanded_s;", "why_ = fault;"),
        ("a clock that is set blocks", 'Distrust({StopReason::kClockSet, Format("by %+.2f s", step_s)});', ""),
        ("an exposure that has not settled pauses", "!pictures_.HasSettled()", "false"))),
    ("src/driving/pilot.cpp", BASIC, (
        ("an emergency stop belongs to its source", "emergency_sources_.erase(source);", "emergency_sources_.clear();"),
        ("the 65th emergency stop counts", 'emergency_sources_.insert(is_room ? source : "further nodes");',
         "if (is_room) emergency_sources_.insert(source);"),
        ("no start with a fault", 'if (const auto fault = FindStartFault(now_s)) return {false, "not started: " + ToString(*fault)};', ""),
        ("goals have limits", "!flaw.empty()", "false"),
        ("no goals while blocked",
         'if (state_ == DriveState::kBlocked)\n    return {false, "goal refused: the rover is blocked: " + ToString(why_)};', ""),
        ("no goals in a long standby", 'if (DropOldRoute()) return {false, "goal refused: the rover is in standby; start it first"};', ""),
        ("a late tick is no leap of the speed", "std::clamp(now_s - last_tick_s_, 0.0, kMaxTick_s)", "now_s - last_tick_s_"),
        ("a pilot that was held up blocks", 'if (was_held_up) Distrust({StopReason::kHeldUp, ""});', ""),
        ("the velocity is forgotten at a stop", 'why_ = {StopReason::kStopped, ""};\n  velocity_s_ = kNeverCommanded_s;',
         'why_ = {StopReason::kStopped, ""};'),
        ("a velocity that is not finite is refused", "!motion.IsFinite()", "false"),
        ("two nodes do not command velocities", "source != velocity_source_ && IsVelocityFresh(now_s) && !velocity_.IsZero()", "false"),
        ("a velocity that streams on is no new command", "if (state_ != DriveState::kPaused && state_ != DriveState::kWarning) commanded_s_ = now_s;",
         "commanded_s_ = now_s;"),
        ("no velocity beside a goal", 'if (route_) return {false, "velocity refused: a goal is being driven to"};', ""),
        ("no datum while driving", "state_ == DriveState::kDriving || state_ == DriveState::kWarning", "false"),
        ("a stop forgets the speed", "limiter_.Halt();", ""),
        ("an arrival is seen at rest", "pose_.HasPose() && pose_.LastSighting().taken_s >= at_rest_since_s_ + options_.settle_s", "pose_.HasPose()"),
        ("no start while a velocity is commanded",
         'if (IsVelocityFresh(now_s) && !velocity_.IsZero())\n    return {false, "not started: " + velocity_source_ + " commands a velocity already"};',
         ""))),
    ("src/driving/chassis_watch.cpp", BASIC, (
        ("a lost remote control is a fault", "if (status_->is_remote_lost) return Fault{StopReason::kRemoteLost, \"\"};", ""),
        ("other drivers are noticed", "foreign_s_ && now_s - *foreign_s_ <= kForeignCommand_s", "false"),
        ("the emergency stop button stops", 'if (status_->is_emergency_stop) return Fault{StopReason::kChassisEmergency, ""};', ""),
        ("a motor's fault stops", "if (status_->has_motor_fault) return Fault{StopReason::kMotorFault, status_->detail};", ""),
        ("the remote control takes over", 'if (IsRemote()) return Fault{StopReason::kRemoteControl, ""};', ""),
        ("a bus that is down stops", 'if (!is_bus_up_) return Fault{StopReason::kBusDown, bus_detail_};', ""),
        ("each kind of feedback that falls silent stops", "heard_s && now_s - *heard_s > options_.max_feedback_age_s", "false"),
        ("no start before the chassis has told all", "!heard_s && kind < kNumRequired", "false"))),
    ("src/driving/motion_watch.cpp", BASIC, (
        ("a runaway stops", "excess_since_s_ && now_s - *excess_since_s_ >= options_.max_excess_s", "false"),
        ("frozen feedback stops", "counted_s_ && now_s - *counted_s_ > options_.max_frozen_s", "false"),
        ("a motor's current is limited", "current_since_s_ && now_s - *current_since_s_ >= kMaxCurrent_s", "false"),
        ("motion at rest is told", "!away_since_s_ || now_s - *away_since_s_ < options_.max_excess_s", "true"),
        ("a jammed track stops", "return FindJam();", "return std::nullopt;"))),
    ("src/driving/goal_limits.cpp", BASIC, (
        ("a goal's distance is limited", "!(distance_m <= options_.max_distance_m)", "false"),
        ("a goal lies inside the fence", 'if (!bg::covered_by(to, fence)) return NameOf(i, route.size()) + " is outside the fence";', ""),
        ("the way stays inside the fence", "!bg::covered_by(bg::model::linestring<Place>{from, to}, fence)", "false"),
        ("a path's length is limited", "route.size() > static_cast<size_t>(options_.max_waypoints)", "false"))),
    ("src/driving/speed_limiter.cpp", BASIC, (
        ("only finite speeds are driven", "wanted.IsFinite() ? Shrink(wanted) : PlanarMotion{}", "Shrink(wanted)"),)),
    ("src/hardware/chassis_link.cpp", BASIC, (
        ("the speed is clamped on the bus", "std::clamp(motion.forward_mps, -kMaxSpeed_mps, kMaxSpeed_mps)", "motion.forward_mps"),
        ("the turn rate is clamped on the bus", "std::clamp(motion.turn_radps, -kMaxChassisTurnRate_radps, kMaxChassisTurnRate_radps)",
         "motion.turn_radps"),
        ("a bus-off is remembered until the next tick", "if (frame->kind == CanFrameKind::kBusOff) was_bus_lost_ = true;", ""),
        ("a send queue that is stuck is a bus that is down", "num_busy_in_a_row_ < kMaxBusyInARow", "true"),
        ("no frame before start", "if (!command.may_speak) return;", ""),
        ("each command of another driver counts", "std::count(kCommandIds.begin(), kCommandIds.end(), frame.id) > 0", "frame.id == 0x111"))),
    ("src/hardware/chassis_driver.cpp", BASIC, (
        ("a halt by the guard pauses", "pilot_.ObserveHalt(now_s);", ""),
        ("the driver says farewell", "link_.SendFarewell();", ""),
        ("error bits are faults", "(state.error_bits & ~kErrorBitsNoFault) != 0", "false"))),
    ("src/hardware/bus_lock.cpp", BASIC, (
        ("one driver a bus", "!UseName(::bind, socket_, bus) || ::listen(socket_.Get(), 1) != 0", "false"),)),
    ("src/ros/rover/chassis_node.cpp", ("simulated_graph",), (
        ("simulated time is refused on a real bus", "!ros::Time::isSimTime() || IsSimulatedBus(options.can)", "true"),)),
    ("src/ros/rover/chassis_node.cpp", ("clock_stall",), (
        ("a clock that stands stops the rover", "!sighting || is_clock_stalled", "!sighting"),
        ("an operator's time is the wall's", "ChallengeOperator(ros::SteadyTime::now().toSec());", "ChallengeOperator(now_s);"))),
    ("src/ros/rover/chassis_node.cpp", NODE, (
        ("a map frame that is no longer told stops", "sighting->MapAge(ros::Time::now()) > options_.max_map_age_s", "false"),
        ("velocities are told by their nodes", "driver_.pilot().SetVelocity(clock_.Now(), motion, event.getPublisherName())",
         "driver_.pilot().SetVelocity(clock_.Now(), motion)"),
        ("errors are cleared at rest only", 'if (!is_at_rest) return {false, "not sent: the rover moves"};', ""),
        ("a node asks how old a goal is", "goal_reader_.RequireFresh(goal.header, ros::Time::now());", ""),
        ("the start-up check keeps the rover from starting", 'begins ? Check(true) : ""', '""'))),
    ("src/ros/rover/chassis_inputs.cpp", ROS, (
        ("an old goal, as a latched one, is refused", "age_s <= max_age_s", "true"),
        ("a goal from the future is refused", "age_s >= -kMaxFromFuture_s", "true"),
        ("a covariance that is none is not taken for a good one", "if (!position.allFinite()) return uncertainty;",
         "if (!position.allFinite()) { uncertainty.position_sigma_m = 0; return uncertainty; }"),
        ("a clock that is set is noticed", "offset_.num_jumps() == num_before", "true"))),
    ("src/ros/messages/transforms.cpp", ROS + NODE, (
        ("a tf from the future is refused", "transform.header.stamp.toSec() > now.toSec() + kMaxFromFuture_s", "false"),)),
    ("src/ros/rover/chassis_inputs.cpp", ("ros", "clock_stall"), (
        ("driving time never runs back", "(step_s > 0 ? simulated_s_ : back_s_) += step_s;", "simulated_s_ += step_s;"),)),
    ("src/ros/rover/chassis_inputs.cpp", NODE, (
        ("another odometry process is another epoch", "connection != connection_", "false"),)),
    ("nodes/chassis_node.cpp", NODE, (
        ("SIGHUP leaves a standing rover", "::signal(signal, [](int) { ros::requestShutdown(); });",
         "if (signal != SIGHUP) ::signal(signal, [](int) { ros::requestShutdown(); });"),)),
    ("src/ros/rover/pan_tilt_node.cpp", ("pan_tilt",), (
        ("the head does not home while the rover drives", 'Require(!drive_.IsDriving(), "the rover drives: stop it first");', ""),)),
    ("src/ros/rover/published_camera.cpp", ("stereo_camera",), (
        ("no calibration is set while the rover drives", "drive_.IsDriving()", "false"),)),
    ("src/driving/picture_watch.cpp", BASIC, (
        ("an exposure has settled when its grey goes on evenly", "has_settled_ || IsSteady()", "true"),)),
    ("src/driving/slip_estimator.cpp", BASIC, (
        ("sight that goes aside of the tracks stops", "straight->sideways_ratio.value_or(0) > options_.max_level_ratio", "false"),)),
)
PROTECTIONS = [Protection(name, file, old, new, suites) for file, suites, rows in TABLE for name, old, new in rows]
