#include "arfm_vo/ros/rover/start_check.h"

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <cmath>
#include <cstdlib>

#include "arfm_vo/base/format.h"

namespace arfm_vo {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr double kMaxAge_s = 5;  // nodes tell their diagnostics once a second
/// By a tape measure the shortest baseline, 5 cm, is known to 2 mm.
constexpr double kMaxBaselineError = 0.05;
/// A picture that does not turn with the head by so much contradicts the tracks, which stand.
constexpr double kHeadWay_deg = 15;
constexpr double kTogether_s = 5;  // the contradiction and the head's motion
constexpr double kRest = 0.005;    // m/s, rad/s: slower is noise
constexpr char kCalibration[] = ": calibration", kHead[] = ": pan-tilt";

double SecondsSince(const ros::SteadyTime& time) { return (ros::SteadyTime::now() - time).toSec(); }

/// No chassis here tells its brake: what shows it is that the tracks stand.
CheckLine CheckBrake(const ChassisReadings& readings) {
  if (!readings.motion) return {"brake", {}, "the chassis is silent"};
  const auto [forward_mps, turn_radps] = readings.motion->motion;
  return {"brake", std::max(std::abs(forward_mps), std::abs(turn_radps)) <= kRest,
          Format("the chassis measures %.3f m/s and %.3f rad/s", forward_mps, turn_radps)};
}

CheckLine CheckBattery(const ChassisReadings& readings) {
  if (!readings.system) return {"battery", {}, "the chassis is silent"};
  const std::string errors = DescribeErrors(readings.system->error_bits);
  const std::string charge =
      readings.battery ? Format(", %d %%", readings.battery->charge_percent) : "";
  return {"battery", errors.find("battery") == std::string::npos,
          Format("%.1f V", readings.system->battery_v) + charge +
              (errors.empty() ? "" : ", " + errors)};
}

}  // namespace

std::string StartCheck::Told::Value(const std::string& key) const {
  for (const auto& value : status.values)
    if (value.key == key) return value.value;
  return "";
}

void StartCheck::Take(const diagnostic_msgs::DiagnosticArray& diagnostics) {
  for (const DiagnosticStatus& status : diagnostics.status) {
    const bool is_head = boost::ends_with(status.name, kHead);
    if (!is_head && !boost::ends_with(status.name, kCalibration)) continue;
    if (told_.size() >= 64) told_.clear();  // whoever is a node of the rover tells again
    Told& told = told_[status.name];
    const std::string before = told.Value("pan (deg)");
    told = {ros::SteadyTime::now(), status};
    const std::string after = told.Value("pan (deg)");
    if (!is_head || before.empty() || after.empty() || before == after) continue;
    head_way_deg_ += std::abs(std::atof(after.c_str()) - std::atof(before.c_str()));
    head_moved_ = told.at;
  }
}

CheckLine StartCheck::CheckCalibration() const {
  CheckLine line{"calibration", {}, "no camera's node tells its baseline"};
  for (const auto& [name, told] : told_) {
    if (!boost::ends_with(name, kCalibration) || SecondsSince(told.at) > kMaxAge_s) continue;
    if (told.status.level != DiagnosticStatus::OK)
      return {"calibration", false, told.status.message};
    const double baseline_m = std::atof(told.Value("baseline (m)").c_str());
    if (baseline_m <= 0) continue;
    const std::string days = told.Value("age (days)");
    const std::string text = Format("baseline %.4f m, ", baseline_m) +
                             (days.empty() ? "of unknown age" : "made " + days + " days ago");
    if (baseline_m_ == 0)
      line.detail = text + "; nobody has measured it (baseline_m)";
    else
      line = {"calibration", std::abs(baseline_m - baseline_m_) <= kMaxBaselineError * baseline_m_,
              text + Format("; by the tape measure %.3f m", baseline_m_)};
  }
  return line;
}

CheckLine StartCheck::CheckHead(const Told& head, std::optional<double> contradicted_s) const {
  if (SecondsSince(head.at) > kMaxAge_s) return {"head", false, "its node is silent"};
  if (head.status.level != DiagnosticStatus::OK) return {"head", false, head.status.message};
  if (head.Value("homed") != "True")
    return {"head", {}, "was not homed since it was switched on: call home"};
  if (head_way_deg_ < kHeadWay_deg)
    return {"head", {}, Format("has not moved yet: move it by %.0f deg", kHeadWay_deg)};
  const bool is_followed =
      !contradicted_s || std::abs(*contradicted_s - SecondsSince(head_moved_)) > kTogether_s;
  return {
      "head", is_followed,
      is_followed ? "homed, and the picture turns with it" : "the picture does not turn with it"};
}

std::vector<CheckLine> StartCheck::List(double now_s) const {
  std::vector<CheckLine> lines = driver_.pilot().Check(now_s, ChassisDriver::kGuard);
  lines.push_back(CheckBrake(driver_.link().Readings()));
  lines.push_back(CheckBattery(driver_.link().Readings()));
  lines.push_back(CheckCalibration());
  std::optional<double> contradicted_s = driver_.pilot().Status().contradicted_s;
  if (contradicted_s) contradicted_s = now_s - *contradicted_s;
  for (const auto& [name, told] : told_)
    if (boost::ends_with(name, kHead)) lines.push_back(CheckHead(told, contradicted_s));
  return lines;
}

std::string StartCheck::Describe(double now_s, bool flaws_only) const {
  std::string text;
  for (const CheckLine& line : List(now_s)) {
    const bool is_overridden = options_.IsOverridden(line.item);
    if (flaws_only && (line.is_well.value_or(false) || is_overridden)) continue;
    text += "\n" + line.ToString() + (is_overridden ? " (overridden)" : "");
  }
  return text;
}

}  // namespace arfm_vo
