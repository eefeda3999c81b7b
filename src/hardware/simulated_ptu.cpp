#include "arfm_vo/hardware/simulated_ptu.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

namespace arfm_vo {
namespace {

constexpr char kEnd[] = "\r\n";
constexpr char kIllegal[] = "! Illegal command entered\r\n";

std::string FormatResolution(double arcsec) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(4) << arcsec;
  return out.str();
}

/// The number at the end of "pp-2500"; nothing where there is none.
std::optional<int> ParseArgument(const std::string& command) {
  const auto number = command.size() > 2
                          ? ParsePtuNumber(command.substr(2), PtuAxis::kPan, PtuFeedback::kTerse)
                          : std::nullopt;
  if (!number || std::abs(*number) > 999999) return std::nullopt;
  return static_cast<int>(*number);
}

}  // namespace

SimulatedPtuOptions SimulatedPtuOptions::Instant() {
  SimulatedPtuOptions options;
  options.baud = std::numeric_limits<double>::infinity();
  options.command_time_s = options.reset_time_s = 0;
  return options;
}

SimulatedPtu::SimulatedPtu(const SimulatedPtuOptions& options)
    : options_(options), pan_(options.pan), tilt_(options.tilt) {
  options.Check();
}

void SimulatedPtu::Receive(const std::string& bytes, double now_s) {
  Advance(now_s);
  for (const char c : bytes) {
    input_free_s_ = std::max(input_free_s_, now_s) + 10 / options_.baud;
    input_.emplace_back(input_free_s_, c);
  }
}

std::string SimulatedPtu::Transmit(double now_s) {
  Advance(now_s);
  std::string bytes;
  for (; !output_.empty() && output_.front().first <= now_s; output_.pop_front())
    bytes += output_.front().second;
  return bytes;
}

double SimulatedPtu::Position(PtuAxis axis, double now_s) {
  Advance(now_s);
  return Motion(axis).Position();
}

void SimulatedPtu::HitLimit(PtuAxis axis, double slip_counts, double now_s) {
  Advance(now_s);
  Motion(axis).Slip(slip_counts);
  Send(axis == PtuAxis::kPan ? "!P" : "!T", now_s);
}

void SimulatedPtu::Advance(double now_s) {
  while (!input_.empty() && input_.front().first <= now_s) {
    const auto [time, c] = input_.front();
    input_.pop_front();
    now_s_ = std::max(now_s_, time);
    pan_.Advance(now_s_);
    tilt_.Advance(now_s_);
    if (has_echo_) Send(std::string(1, c), now_s_);
    if (c == ' ' || c == '\r') {
      if (!command_.empty()) Execute(command_);
      command_.clear();
    } else if (c > ' ' && command_.size() < 32) {
      command_ += static_cast<char>(std::tolower(c));
    }
  }
  while (now_s_ < now_s) {
    now_s_ = awaits_ ? std::min(now_s_ + PtuAxisMotion::kStep_s, now_s) : now_s;
    pan_.Advance(now_s_);
    tilt_.Advance(now_s_);
    if (!awaits_ || !pan_.IsAtRest() || !tilt_.IsAtRest()) continue;
    awaits_ = false;
    Send(std::string("*") + kEnd, now_s_);
  }
}

void SimulatedPtu::Execute(const std::string& command) {
  const std::string reply = Answer(command);
  if (!reply.empty()) Send(reply, std::max(now_s_, busy_until_s_) + options_.command_time_s);
}

std::string SimulatedPtu::Answer(const std::string& command) {
  const std::string done = std::string("*") + kEnd;
  if (command == "a") {
    awaits_ = true;
    return {};
  }
  if (command[0] == 'r' && command.size() <= 2) {
    Reset();
    return "!T!T!P!P*\r\n";
  }
  if (command == "ee" || command == "ed") {
    has_echo_ = command == "ee";
    return done;
  }
  if (command == "ft" || command == "fv") {
    is_verbose_ = command == "fv";
    return done;
  }
  if (command == "le" || command == "ld") {
    is_limited_ = command == "le";
    return done;
  }
  if (command == "ci" || command == "i") return done;
  if (command == "ds") ++num_eeprom_writes_;
  if (command == "h") {
    pan_.target = static_cast<int>(std::lround(pan_.Position()));
    tilt_.target = static_cast<int>(std::lround(tilt_.Position()));
    return done;
  }
  if (command == "v") return "* Pan-Tilt Controller v2.14.0(D46), (C)2006 Directed Perception\r\n";
  if (command == "o") return "* 24.0,86,81\r\n";
  if (command.size() >= 2 && command[0] == 'p') return AnswerAxis(PtuAxis::kPan, command);
  if (command.size() >= 2 && command[0] == 't') return AnswerAxis(PtuAxis::kTilt, command);
  return kIllegal;
}

std::string SimulatedPtu::AnswerAxis(PtuAxis axis, const std::string& command) {
  const PtuAxisMotion& motion = Motion(axis);
  const SimulatedPtuAxisOptions& axis_options = motion.options;
  const std::string name = axis == PtuAxis::kPan ? "Pan" : "Tilt";
  const auto argument = ParseArgument(command);
  if (command.size() > 2 && !argument) return kIllegal;
  if (argument) {
    if (command[1] == 'p') return MoveTo(axis, *argument);
    if (command[1] == 'o')
      return MoveTo(axis, static_cast<int>(std::lround(motion.Position())) + *argument);
    if (command[1] == 's') return SetSpeed(axis, *argument);
    return kIllegal;
  }
  const std::string position = std::to_string(std::lround(motion.Position()));
  switch (command[1]) {
    case 'p':
      return AnswerValue("Current " + name + " position is ", position);
    case 'o':
      return AnswerValue("Target " + name + " position is ", std::to_string(motion.target));
    case 'r':
      return AnswerValue("", FormatResolution(axis_options.resolution_arcsec),
                         " seconds arc per " + name + " position");
    case 'n':
      return AnswerValue("Minimum " + name + " position is ",
                         std::to_string(axis_options.min_position));
    case 'x':
      return AnswerValue("Maximum " + name + " position is ",
                         std::to_string(axis_options.max_position));
    case 's':
      return AnswerValue("Target " + name + " speed is ", std::to_string(motion.speed),
                         " positions/sec");
    case 'l':
      return AnswerValue("Minimum " + name + " speed is ", std::to_string(axis_options.min_speed),
                         " positions/sec");
    case 'u':
      return AnswerValue("Maximum " + name + " speed is ", std::to_string(axis_options.max_speed),
                         " positions/sec");
    case 'b':
      return AnswerValue("Current " + name + " base speed is ",
                         std::to_string(axis_options.base_speed), " positions/sec");
    default:
      return kIllegal;
  }
}

std::string SimulatedPtu::AnswerValue(const std::string& before, const std::string& value,
                                      const std::string& after) const {
  return "* " + (is_verbose_ ? before + value + after : value) + kEnd;
}

std::string SimulatedPtu::MoveTo(PtuAxis axis, int target) {
  PtuAxisMotion& motion = Motion(axis);
  const std::string name = axis == PtuAxis::kPan ? "Pan" : "Tilt";
  if (is_limited_ && target > motion.options.max_position)
    return "! Maximum allowable " + name + " position is " +
           std::to_string(motion.options.max_position) + kEnd;
  if (is_limited_ && target < motion.options.min_position)
    return "! Minimum allowable " + name + " position is " +
           std::to_string(motion.options.min_position) + kEnd;
  motion.target = target;
  return std::string("*") + kEnd;
}

std::string SimulatedPtu::SetSpeed(PtuAxis axis, int speed) {
  PtuAxisMotion& motion = Motion(axis);
  const std::string name = axis == PtuAxis::kPan ? "Pan" : "Tilt";
  if (speed > motion.options.max_speed)
    return "! " + name + " speed cannot exceed " + std::to_string(motion.options.max_speed) +
           " positions/sec" + kEnd;
  if (speed < motion.options.min_speed)
    return "! " + name + " speed cannot be less than " + std::to_string(motion.options.min_speed) +
           " positions/sec" + kEnd;
  motion.speed = speed;
  return std::string("*") + kEnd;
}

void SimulatedPtu::Reset() {
  pan_.Home();
  tilt_.Home();
  busy_until_s_ = now_s_ + options_.reset_time_s;
}

void SimulatedPtu::Send(const std::string& bytes, double from_s) {
  for (const char c : bytes) {
    line_free_s_ = std::max(line_free_s_, from_s) + 10 / options_.baud;
    output_.emplace_back(line_free_s_, c);
  }
}

}  // namespace arfm_vo
