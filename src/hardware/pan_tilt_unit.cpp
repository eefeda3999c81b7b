#include "arfm_vo/hardware/pan_tilt_unit.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "arfm_vo/base/format.h"

namespace arfm_vo {
namespace {

constexpr double kRadPerArcsec = M_PI / 180 / 3600;
constexpr int kMaxQueries = 8;  ///< for one position
/// One answer more must agree where the axis was not read for this long and can be far, and one
/// where the line garbled a reply within this time: faults come in spells.
constexpr double kFollowed_s = 0.4, kClean_s = 3;
constexpr int kMaxImplausible = 3;
/// Rounding of a count to whole numbers and of its time.
constexpr double kSlackCounts = 2;
/// Share by which two steps of a steady motion may differ: acceleration, uneven round trips.
constexpr double kSteadiness = 0.2;

/// b to c goes on as a to b went, at most at `max_speed` (counts/s).
bool IsSteady(const PtuLink::Answer& a, const PtuLink::Answer& b, const PtuLink::Answer& c,
              double max_speed) {
  const double step = c.value - b.value;
  if (std::abs(step) > max_speed * (c.time_s - b.time_s) + kSlackCounts) return false;
  const double expected = (b.value - a.value) * (c.time_s - b.time_s) / (b.time_s - a.time_s);
  return std::abs(step - expected) <= kSlackCounts + kSteadiness * std::abs(step);
}

/// The last `needed` are the same, or the last `needed` + 1 those of a steady motion.
bool Agree(const std::vector<PtuLink::Answer>& answers, int needed, double max_speed) {
  const int n = static_cast<int>(answers.size());
  int num_same = 1, num_steady = 2;
  while (num_same < n && answers[n - 1 - num_same].value == answers.back().value) ++num_same;
  if (num_same >= needed) return true;
  while (num_steady < n && IsSteady(answers[n - 1 - num_steady], answers[n - num_steady],
                                    answers[n - num_steady + 1], max_speed))
    ++num_steady;
  return n > needed && num_steady > needed;
}

double Degrees(double rad) { return rad * 180 / M_PI; }

}  // namespace

PanTiltUnit::PanTiltUnit(std::unique_ptr<ByteStream> stream, double reply_timeout_s)
    : stream_(std::move(stream)), link_(*stream_, reply_timeout_s) {}

bool PanTiltUnit::Connect() {
  return link_.Initialize() && ReadProperties(PtuAxis::kPan) && ReadProperties(PtuAxis::kTilt);
}

bool PanTiltUnit::ReadProperties(PtuAxis axis) {
  const auto resolution = link_.QueryTwice(axis, 'R');
  const auto min = link_.QueryTwice(axis, 'N'), max = link_.QueryTwice(axis, 'X');
  const auto speed = link_.QueryTwice(axis, 'S');
  const auto slowest = link_.QueryTwice(axis, 'L'), fastest = link_.QueryTwice(axis, 'U');
  if (!resolution || !min || !max || !speed || !slowest || !fastest) return false;
  const auto is_count = [](double value) { return value == std::floor(value); };
  if (!(*resolution > 0) || *max <= *min || !is_count(*min) || !is_count(*max)) return false;
  Axis& known = axes_[Index(axis)];
  known = Axis();
  known.properties = {
      *resolution * kRadPerArcsec, int(*min), int(*max), int(*speed), int(*slowest), int(*fastest)};
  known.fastest = known.properties.speed;
  return true;
}

bool PanTiltUnit::IsWithinLimits(const Axis& axis, const PtuLink::Answer& answer) const {
  return answer.value == std::floor(answer.value) &&
         answer.value >= axis.properties.min_position - kSlackCounts &&
         answer.value <= axis.properties.max_position + kSlackCounts;
}

bool PanTiltUnit::IsWithinReach(const Axis& axis, const PtuLink::Answer& answer) const {
  if (!axis.last) return true;
  const bool is_at_rest = axis.target == static_cast<int>(axis.last->value);
  const double since_s =
      answer.time_s - axis.last->time_s + (answer.round_trip_s + axis.last->round_trip_s) / 2;
  const double reach = is_at_rest ? 0 : axis.fastest * since_s + kSlackCounts;
  return std::abs(answer.value - axis.last->value) <= reach;
}

bool PanTiltUnit::Accept(Axis& axis, const PtuLink::Answer& answer) {
  // What is out of reach again and again is the truth: the unit was moved or reset by others.
  if (!IsWithinReach(axis, answer) && ++axis.num_implausible < kMaxImplausible) return false;
  if (axis.num_implausible >= kMaxImplausible) axis.target.reset();
  const int count = static_cast<int>(answer.value);
  if (!axis.target && axis.last && axis.last->value == answer.value) axis.target = count;
  axis.num_at_target = axis.target == count ? axis.num_at_target + 1 : 0;
  axis.num_implausible = 0;
  axis.last = answer;
  return true;
}

std::optional<PtuReading> PanTiltUnit::ReadPosition(PtuAxis axis) {
  Axis& known = axes_[Index(axis)];
  const bool is_followed = known.last && stream_->Now() - known.last->time_s < kFollowed_s;
  const bool is_clean = stream_->Now() - link_.last_fault_s() > kClean_s;
  const int needed = 2 + (is_followed ? 0 : 1) + (is_clean ? 0 : 1);
  std::vector<PtuLink::Answer> answers;  // in a row
  for (int query = 0; query < kMaxQueries; ++query) {
    const auto answer = link_.Query(axis, 'P');
    if (answer && IsWithinLimits(known, *answer)) {
      answers.push_back(*answer);
      if (!Agree(answers, needed, known.fastest)) continue;
      if (Accept(known, *answer))
        return PtuReading{answer->value * known.properties.resolution_rad, answer->time_s};
    }
    if (answer) link_.MarkOutOfStep();
    answers.clear();
  }
  return std::nullopt;
}

std::optional<std::string> PanTiltUnit::CheckAngle(PtuAxis axis, double angle_rad) const {
  const PtuAxisProperties& properties = axes_[Index(axis)].properties;
  const double count = std::round(angle_rad / properties.resolution_rad);
  if (count >= properties.min_position && count <= properties.max_position) return std::nullopt;
  return Format("%s %.2f deg is outside the limits %.2f .. %.2f deg", ToString(axis),
                Degrees(angle_rad), Degrees(properties.MinRad()), Degrees(properties.MaxRad()));
}

std::optional<std::string> PanTiltUnit::MoveTo(PtuAxis axis, double angle_rad) {
  if (const auto refusal = CheckAngle(axis, angle_rad)) return refusal;
  Axis& known = axes_[Index(axis)];
  const int count = static_cast<int>(std::lround(angle_rad / known.properties.resolution_rad));
  known.target.reset();  // until the unit has taken it, the axis may move or not
  known.num_at_target = 0;
  const auto problem = link_.Command(FormatPtuSet(axis, 'P', count));
  if (problem) return std::string(ToString(axis)) + ": " + *problem;
  known.target = count;
  return std::nullopt;
}

std::optional<std::string> PanTiltUnit::SetSpeed(PtuAxis axis, double speed_rad_s) {
  Axis& known = axes_[Index(axis)];
  PtuAxisProperties& properties = known.properties;
  const double speed = std::round(speed_rad_s / properties.resolution_rad);
  if (!(speed >= properties.min_speed && speed <= properties.max_speed))
    return Format("%s speed %.2f deg/s is outside %.2f .. %.2f deg/s", ToString(axis),
                  Degrees(speed_rad_s), Degrees(properties.min_speed * properties.resolution_rad),
                  Degrees(properties.max_speed * properties.resolution_rad));
  known.fastest = std::max(known.fastest, static_cast<int>(speed));
  const auto problem = link_.Command(FormatPtuSet(axis, 'S', static_cast<int>(speed)));
  if (problem) return std::string(ToString(axis)) + " speed: " + *problem;
  properties.speed = static_cast<int>(speed);
  return std::nullopt;
}

bool PanTiltUnit::IsSettled() const {
  return axes_[0].num_at_target >= 2 && axes_[1].num_at_target >= 2;
}

void PanTiltUnit::StartHoming() {
  for (Axis& axis : axes_) {
    axis.target.reset();
    axis.last.reset();
    axis.num_at_target = 0;
  }
  link_.StartReset();
}

bool PanTiltUnit::PollHoming() {
  if (!link_.PollReset()) return false;
  link_.TakeLimitHit();  // homing finds the limits
  has_lost_position_ = false;
  return true;
}

bool PanTiltUnit::HasLostPosition() {
  has_lost_position_ = link_.TakeLimitHit() || has_lost_position_;
  return has_lost_position_;
}

}  // namespace arfm_vo
