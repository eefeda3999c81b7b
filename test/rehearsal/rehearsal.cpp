#include "rehearsal/rehearsal.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <utility>

#include "arfm_vo/hardware/chassis_driver.h"
#include "arfm_vo/simulation/simulated_chassis.h"
#include "driving/attend.h"
#include "simulation/can_memory_bus.h"

namespace arfm_vo {
namespace {

constexpr int kChassisPeriod_ms = 10;
constexpr int kDriverPeriod_ms = 20;
constexpr long kGoal_ms = 600, kStart_ms = 1000;
constexpr uint32_t kEpoch = 1;
/// Slowest sensible drive: a limit for runs that never end.
constexpr double kMaxSecondsPerMetre = 60, kMaxSeconds = 300;

using Sight = std::function<Glimpse(double now_s, const Rigid3& world_from_base)>;

class Stage {
 public:
  Stage(const GoalScene& scene, const RehearsalOptions& options, Sight sight)
      : goal_(scene.GoalInMap()),
        map_from_world_(scene.Ground()(scene.start()).Inverse()),
        listener_(bus_.OpenEnd()),
        chassis_(bus_.OpenEnd(), TrackedPlant(options.plant, scene.start(), scene.Ground())),
        driver_(options.pilot, bus_.OpenEnd()),
        sight_(std::move(sight)),
        pair_period_ms_(std::lround(1000 * options.sight.pair_period_s)) {
    drive_.goal = goal_;
  }

  RehearsedDrive Run() {
    const double limit_s = kMaxSeconds + kMaxSecondsPerMetre * std::hypot(goal_.x_m, goal_.y_m);
    while (drive_.outcome.empty() && 0.001 * now_ms_ < limit_s) Step();
    if (drive_.outcome.empty()) drive_.outcome = "not there in time";
    Judge();
    drive_.sight = RecordSight(seen_, map_from_base_);
    return std::move(drive_);
  }

 private:
  double Now() const { return 0.001 * now_ms_; }
  const TrackedPlant& Plant() const { return chassis_.plant(); }

  void Step() {
    if (now_ms_ % kChassisPeriod_ms == 0) chassis_.Tick(Now());
    if (now_ms_ % pair_period_ms_ == 0) Look();
    while (!glimpses_.empty() && glimpses_.front().told_s <= Now() + 1e-9) {
      Tell(glimpses_.front());
      glimpses_.pop_front();
    }
    Attend(driver_.pilot().operator_watch(), Now());
    if (now_ms_ == kGoal_ms) SendGoal();
    if (now_ms_ == kStart_ms) {
      drive_.num_frames_before_start = drive_.num_frames;
      driver_.pilot().Start(Now());
    }
    if (now_ms_ % kDriverPeriod_ms == 0) driver_.Tick(Now());
    CountStops();
    Listen();
    for (const GoalResult& result : driver_.pilot().TakeResults()) {
      drive_.outcome = ToString(result.outcome);
      drive_.has_arrived = result.outcome == GoalOutcome::kArrived;
      if (!drive_.has_arrived) drive_.outcome += std::string(": ") + ToString(result.reason);
    }
    now_ms_ += kChassisPeriod_ms;
  }

  void SendGoal() {
    const Reply reply = driver_.pilot().SetRoute({goal_});
    if (!reply.is_accepted) drive_.outcome = reply.text;
  }

  void Look() {
    const Rigid3 world_from_base = Plant().WorldFromBase();
    const Glimpse glimpse = sight_(Now(), world_from_base);
    glimpses_.push_back(glimpse);
    seen_.push_back(glimpse);
    map_from_base_.push_back(map_from_world_ * world_from_base);
    ++drive_.num_pairs;
    drive_.num_lost += !glimpse.map_from_base;
    TrackPoint point;
    point.time_s = Now();
    point.truth = ProjectToPlane(map_from_world_ * world_from_base);
    point.slope_deg = SlopeOf(world_from_base);
    point.is_tracked = glimpse.map_from_base.has_value();
    if (point.is_tracked) point.sight = ProjectToPlane(*glimpse.map_from_base);
    drive_.track.push_back(point);
    drive_.steepest_deg = std::max(drive_.steepest_deg, point.slope_deg);
  }

  void Tell(const Glimpse& glimpse) {
    Pilot& pilot = driver_.pilot();
    pilot.ObserveEpoch(kEpoch, glimpse.taken_s);
    pilot.ObserveUncertainty(Now(), glimpse.uncertainty);
    if (glimpse.map_from_base)
      pilot.ObservePose(Now(), {glimpse.taken_s, *glimpse.map_from_base, {}});
  }

  void CountStops() {
    const DriveState state = driver_.pilot().Status().state;
    const bool has_stopped = state == DriveState::kPaused || state == DriveState::kBlocked;
    drive_.num_stops += has_stopped && state_ == DriveState::kDriving;
    state_ = state;
  }

  void Listen() {
    while (const auto frame = listener_->Receive()) {
      const ChassisCommand command = DecodeCommand(*frame);
      drive_.num_frames += command.index() != 0;
      if (const auto* motion = std::get_if<MotionCommand>(&command))
        drive_.fastest_command_mps =
            std::max(drive_.fastest_command_mps, std::abs(motion->motion.forward_mps));
    }
  }

  void Judge() {
    const RoverPose truth = ProjectToPlane(map_from_world_ * Plant().WorldFromBase());
    drive_.final_error_m = std::hypot(goal_.x_m - truth.x_m, goal_.y_m - truth.y_m);
    drive_.final_heading_error_deg =
        std::abs(WrapAngle(*goal_.heading_rad - truth.heading_rad)) * 180 / M_PI;
    drive_.driven_m = Plant().DrivenDistance();
    drive_.duration_s = Now();
    const double track_m = (Plant().Ways().left_m + Plant().Ways().right_m) / 2;
    drive_.slip_ratio = track_m > 0 ? 1 - Plant().DrivenDistance() / track_m : 0;
  }

  RehearsedDrive drive_;
  Waypoint goal_;
  Rigid3 map_from_world_;
  CanMemoryBus bus_;
  std::unique_ptr<CanBus> listener_;
  SimulatedChassis chassis_;
  ChassisDriver driver_;
  Sight sight_;
  std::deque<Glimpse> glimpses_;  ///< that are to be told
  std::vector<Glimpse> seen_;
  std::vector<Rigid3> map_from_base_;  ///< [seen_] true
  DriveState state_ = DriveState::kStandby;
  long pair_period_ms_, now_ms_ = 0;
};

template <class Sight>
RehearsedDrive DriveBy(const GoalScene& scene, const RehearsalOptions& options, Sight& sight) {
  options.Check();
  return Stage(scene, options,
               [&](double now_s, const Rigid3& world_from_base) {
                 return sight.Look(now_s, world_from_base);
               })
      .Run();
}

}  // namespace

void RehearsalOptions::Check() const {
  pilot.Check();
  plant.Check();
  sight.Check();
  odometry.Check();
  shape.Check();
}

RehearsedDrive Rehearse(const GoalScene& scene, const RehearsalOptions& options) {
  SimulatedSight sight(options.sight, options.odometry, options.shape, scene.terrain());
  return DriveBy(scene, options, sight);
}

RehearsedDrive Rehearse(const GoalScene& scene, const RehearsalOptions& options,
                        const std::vector<SightRecord>& records) {
  DrawnSight sight(records, options.sight.latency_s, options.plant.seed);
  return DriveBy(scene, options, sight);
}

}  // namespace arfm_vo
