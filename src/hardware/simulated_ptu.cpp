#include "arfm_vo/hardware/simulated_ptu.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "arfm_vo/base/format.h"

namespace arfm_vo {
namespace {

constexpr char kEnd[] = "\r\n";
constexpr char kDone[] = "*\r\n";
constexpr char kIllegal[] = "! Illegal command entered\r\n";

/// The number at the end of "pp-2500"; nothing where there is none.
std::optional<int> ParseArgument(const std::string& command) {
  const auto number = command.size() > 2 ? ParsePtuNumber(command.substr(2)) : std::nullopt;
  if (!number || std::abs(*number) > 999999) return std::nullopt;
  return static_cast<int>(*number);
}

}  // namespace

void PtuAxisMotion::Advance(double now_s) {
  while (now_s_ < now_s && !IsAtRest()) {
    const double dt = std::min(kStep_s, now_s - now_s_);
    Step(dt);
    now_s_ += dt;
  }
  now_s_ = std::max(now_s_, now_s);
}

void PtuAxisMotion::Step(double dt) {
  const double error = target - position_;
  const double direction = error >= 0 ? 1 : -1;
  const double base = std::min(options.base_speed, speed);
  // Speed from which the axis can still come to the base speed at the target.
  const double stopping = std::sqrt(base * base + 2.0 * options.acceleration *
                                                      std::max(std::abs(error) - base * dt, 0.0));
  double wanted = direction * std::min<double>(speed, stopping);
  if (velocity_ * direction < -base) wanted = 0;  // on its way to the other side: brake first
  double change =
      std::clamp(wanted - velocity_, -options.acceleration * dt, options.acceleration * dt);
  if (std::abs(velocity_) <= base && std::abs(wanted) >= base && velocity_ * wanted <= 0)
    change = direction * base - velocity_;  // starts at the base speed
  velocity_ += change;
  if (std::abs(error) <= std::max(std::abs(velocity_), base) * dt) {
    position_ = target;
    velocity_ = 0;
  } else {
    position_ += velocity_ * dt;
  }
}

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
      const std::string reply = command_.empty() ? "" : Answer(command_);
      Send(reply, std::max(now_s_, busy_until_s_) + options_.command_time_s);
      command_.clear();
    } else if (c > ' ' && command_.size() < 32) {
      command_ += static_cast<char>(std::tolower(c));
    }
  }
  now_s_ = std::max(now_s_, now_s);
  pan_.Advance(now_s_);
  tilt_.Advance(now_s_);
}

std::string SimulatedPtu::Answer(const std::string& command) {
  if (command[0] == 'r' && command.size() <= 2) {
    Reset();
    return "!T!T!P!P*\r\n";
  }
  if (command == "ee" || command == "ed") {
    has_echo_ = command == "ee";
    return kDone;
  }
  if (command == "ft" || command == "fv") {
    is_verbose_ = command == "fv";
    return kDone;
  }
  if (command == "ci" || command == "i") return kDone;
  if (command.size() >= 2 && command[0] == 'p') return AnswerAxis(PtuAxis::kPan, command);
  if (command.size() >= 2 && command[0] == 't') return AnswerAxis(PtuAxis::kTilt, command);
  return kIllegal;
}

std::string SimulatedPtu::AnswerAxis(PtuAxis axis, const std::string& command) {
  const char letter = command[1];
  if (command.size() > 2) {
    const auto argument = ParseArgument(command);
    return argument ? Set(axis, letter, *argument) : kIllegal;
  }
  const PtuAxisMotion& motion = Motion(axis);
  const SimulatedPtuAxisOptions& unit = motion.options;
  const std::pair<char, double> values[] = {{'p', std::round(motion.Position())},
                                            {'n', unit.min_position},
                                            {'x', unit.max_position},
                                            {'s', motion.speed},
                                            {'l', unit.min_speed},
                                            {'u', unit.max_speed}};
  const std::string begin = is_verbose_ ? "* The value is " : "* ";  // in other words for each
  if (letter == 'r') return begin + Format("%.4f", unit.resolution_arcsec) + kEnd;
  for (const auto& [name, value] : values)
    if (letter == name) return begin + Format("%.0f", value) + kEnd;
  return kIllegal;
}

std::string SimulatedPtu::Set(PtuAxis axis, char letter, int value) {
  PtuAxisMotion& motion = Motion(axis);
  const SimulatedPtuAxisOptions& unit = motion.options;
  const bool is_position = letter == 'p';
  if (!is_position && letter != 's') return kIllegal;
  const int lowest = is_position ? unit.min_position : unit.min_speed;
  const int highest = is_position ? unit.max_position : unit.max_speed;
  const int allowed = std::clamp(value, lowest, highest);
  const std::string name = axis == PtuAxis::kPan ? "Pan" : "Tilt";
  if (value != allowed && is_position)
    return Format("! %s allowable %s position is %d", value > allowed ? "Maximum" : "Minimum",
                  name.c_str(), allowed) +
           kEnd;
  if (value != allowed)
    return Format("! %s speed cannot %s %d positions/sec", name.c_str(),
                  value > allowed ? "exceed" : "be less than", allowed) +
           kEnd;
  (is_position ? motion.target : motion.speed) = value;
  return kDone;
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
