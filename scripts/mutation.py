#!/usr/bin/python3
"""Removes protections of the driving layer one at a time and tells which the tests notice.

Usage: mutation.py [TEXT]     only the protections whose name holds TEXT; run it in a checkout without changes

Builds into BUILD_DIR (default _b). Exit status 0 where all are noticed.
"""
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
BUILD = pathlib.Path(os.environ.get("BUILD_DIR", ROOT / "_b"))
# What ends well in a minute and includes the driving layer.
TESTS = (("test_driving", "*"), ("test_hardware", "Chassis*:ToChassis*:BusLock*:*Pseudo*"),
         ("test_simulation", "FaultTable*:WrongPose*:SimulatedChassis*"))

# Name, file, what stands there, what takes its place.
MUTANTS = (
    ("a sighting is compared with the tracks", "src/driving/pose_watch.cpp",
     "if (jump.IsExcessive())", "if (false)"),
    ("a slide is looked for", "src/driving/pose_watch.cpp", "if (slide.IsExcessive())", "if (false)"),
    ("steps of the map are bounded", "src/driving/pose_watch.cpp",
     "if (!step.IsExcessive()) return std::nullopt;", "return std::nullopt;"),
    ("a new epoch is noticed", "src/driving/pose_watch.cpp", "if (!is_new) return false;", "return false;"),
    ("a pose without covariance waits", "src/driving/pose_watch.cpp",
     "if (!options_.requires_covariance) return true;", "return true;"),
    ("a pose without epoch is not driven by", "src/driving/pose_watch.cpp",
     "if (options_.requires_epoch && !epoch_)", "if (false)"),
    ("covariances from the future are refused", "src/driving/pose_watch.cpp",
     "if (!(uncertainty.taken_s <= now_s + kMaxFromFuture_s)) return false;", ""),
    ("poses from the future are refused", "src/driving/pose_watch.cpp",
     "pose.taken_s > now_s + kMaxFromFuture_s", "false"),
    ("a stale pose pauses", "src/driving/pose_watch.cpp",
     "now_s - told_->taken_s > options_.max_pose_age_s", "false"),
    ("an uncertain pose pauses", "src/driving/pose_watch.cpp",
     "if (IsUncertain(now_s)) return StopReason::kPoseUncertain;", ""),
    ("the heading's sigma counts", "src/driving/pose_watch.cpp",
     "uncertainty_->heading_sigma_rad) <=\n               options_.max_heading_sigma_rad", "0) <= 1"),
    ("a wrong pose drops the goal", "src/driving/pilot_faults.cpp",
     "if (!keeps_route) EndRoute(GoalOutcome::kCancelled, fault);", ""),
    ("a wrong pose blocks", "src/driving/pilot_faults.cpp",
     "if (state_ != DriveState::kStandby && state_ != DriveState::kBlocked) Block(fault);", ""),
    ("a long pause blocks", "src/driving/pilot_faults.cpp",
     "if (now_s - pause_start_s_ > options_.max_pause_s)", "if (false)"),
    ("a motion is warned of", "src/driving/pilot_faults.cpp", "now_s - warned_since_s_ >= options_.warning_s", "true"),
    ("a pause lasts until the pose is good", "src/driving/pilot_faults.cpp",
     "now_s - flawed_s_ < options_.resume_after_s", "false"),
    ("the operator is needed", "src/driving/pilot_faults.cpp",
     "if (operator_.IsMissing(now_s)) return Fault{StopReason::kOperatorLost, \"\"};", ""),
    ("the emergency stop stops", "src/driving/pilot_faults.cpp", "if (!emergency_sources_.empty())", "if (false)"),
    ("the emergency stop belongs to its source", "src/driving/pilot.cpp",
     "emergency_sources_.erase(source);", "emergency_sources_.clear();"),
    ("tilt stops", "src/driving/pilot_faults.cpp", "if (pose_.IsTilted())", "if (false)"),
    ("motion is compared with the command", "src/driving/pilot_faults.cpp",
     "if (const auto fault = motion_watch_.FindFault(now_s)) return fault;", ";"),
    ("goals have limits", "src/driving/pilot.cpp", "if (!flaw.empty())", "if (false)"),
    ("no goals while blocked", "src/driving/pilot.cpp", "if (state_ == DriveState::kBlocked)\n    return {false, \"goal",
     "if (false)\n    return {false, \"goal"),
    ("a late tick is no leap of the speed", "src/driving/pilot.cpp",
     "std::clamp(now_s - last_tick_s_, 0.0, kMaxTick_s)", "now_s - last_tick_s_"),
    ("a pilot that was held up blocks", "src/driving/pilot.cpp", "if (was_held_up)", "if (false)"),
    ("the velocity is forgotten at a stop", "src/driving/pilot.cpp",
     "  detail_.clear();\n  velocity_s_ = kNeverCommanded_s;", "  detail_.clear();"),
    ("a velocity command is forgotten in time", "src/driving/pilot_faults.cpp",
     "return now_s - velocity_s_ <= options_.velocity_timeout_s;", "return true;"),
    ("a lost remote control is a fault", "src/driving/chassis_watch.cpp",
     "status_->is_remote_lost && !options_.allows_remote_lost", "false"),
    ("other drivers are noticed", "src/driving/chassis_watch.cpp",
     "now_s - *foreign_s_ <= options_.foreign_command_s", "false"),
    ("the speed is clamped on the bus", "src/hardware/chassis_link.cpp",
     "std::clamp(motion.forward_mps, -kMaxSpeed_mps, kMaxSpeed_mps)", "motion.forward_mps"),
    ("the turn rate is clamped on the bus", "src/hardware/chassis_link.cpp",
     "std::clamp(motion.turn_radps, -kMaxChassisTurnRate_radps, kMaxChassisTurnRate_radps)", "motion.turn_radps"),
    ("the driver says farewell", "src/hardware/chassis_driver.cpp", "link_.SendFarewell();", ""),
)


def build():
    command = ["ninja", "-C", str(BUILD)] + [test for test, _ in TESTS]
    return subprocess.run(command, capture_output=True).returncode == 0


def notice():
    """The first test program that fails; nothing where none does."""
    for test, cases in TESTS:
        command = [str(BUILD / "devel/lib/arfm_vo" / test), "--gtest_filter=" + cases, "--gtest_brief=1"]
        try:
            if subprocess.run(command, capture_output=True, timeout=120).returncode != 0:
                return test
        except subprocess.TimeoutExpired:
            return test + " (time-out)"
    return None


def try_mutant(path, old, new):
    original = path.read_text()
    if original.count(old) != 1:
        return "does not apply"
    path.write_text(original.replace(old, new))
    try:
        if not build():
            return "does not build"
        return notice() or "NOT NOTICED"
    finally:
        path.write_text(original)


def main():
    chosen = [mutant for mutant in MUTANTS if len(sys.argv) < 2 or sys.argv[1] in mutant[0]]
    noticed = 0
    for name, file, old, new in chosen:
        said = try_mutant(ROOT / file, old, new)
        noticed += said.startswith("test_")
        print("%-45s %s" % (name, said), flush=True)
    build()
    print("%d of %d noticed" % (noticed, len(chosen)))
    return 0 if noticed == len(chosen) else 1


if __name__ == "__main__":
    sys.exit(main())
