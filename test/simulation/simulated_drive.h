#pragma once

#include <gtest/gtest.h>

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "arfm_vo/hardware/chassis_driver.h"
#include "arfm_vo/simulation/simulated_chassis.h"
#include "simulation/can_memory_bus.h"

namespace arfm_vo {

/// A chassis driver, a simulated chassis on the same bus, and a perfect sight that is 100 ms late,
/// all on one clock of 1 ms. What a test may break stands open.
class SimulatedDrive {
 public:
  static PilotOptions WithFarGoals(PilotOptions options = {}) {
    options.goal_limits.max_distance_m = 1000;
    return options;
  }

  explicit SimulatedDrive(const PilotOptions& pilot = WithFarGoals(),
                          const TrackedPlantOptions& plant = {},
                          const PlaceOnGround& place = LiftFromPlane)
      : listener_(bus_.OpenEnd()),
        chassis_(std::in_place, bus_.OpenEnd(), TrackedPlant(plant, RoverPose{}, place)),
        driver_(std::in_place, pilot, bus_.OpenEnd()) {}

  /// Goes on by `duration_s`.
  void Run(double duration_s) {
    RunUntil(duration_s, [] { return false; });
  }
  /// Goes on until done() or for `limit_s`; says whether it was done.
  template <class Done>
  bool RunUntil(double limit_s, Done&& done) {
    const long end_ms = now_ms_ + std::lround(limit_s * 1000);
    while (now_ms_ < end_ms && !done()) Step();
    return done();
  }

  /// Is started and takes a route.
  void DriveAlong(const Route& route) {
    Run(0.5);
    ASSERT_TRUE(pilot().Start(Now()).is_accepted);
    ASSERT_TRUE(pilot().SetRoute(route).is_accepted);
  }
  bool IsBlocked() const { return pilot().Status().state == DriveState::kBlocked; }
  bool HasGoal() const { return pilot().Status().has_goal; }

  double Now() const { return 0.001 * now_ms_; }
  Pilot& pilot() { return driver_->pilot(); }
  const Pilot& pilot() const { return driver_->pilot(); }
  SimulatedChassis& chassis() { return *chassis_; }
  TrackedPlant& plant() { return chassis_->plant(); }
  ChassisDriver& driver() { return *driver_; }
  /// The driver ends as a program that is asked to.
  void EndDriver() { driver_.reset(); }

  /// Of the last 0x111 on the bus.
  PlanarMotion Commanded() const { return commanded_; }
  /// When the last 0x111 that was not zero was on the bus, and the first that was zero after it
  /// (before it where there is none).
  double LastMovingCommandTime() const { return last_moving_s_; }
  double FirstStopCommandTime() const { return first_stop_s_; }
  double LastPoseTaken() const { return pose_taken_s_; }
  double LastAnswer() const { return answered_s_; }
  double LastCovarianceTaken() const { return covariance_taken_s_; }
  double FastestCommand() const { return fastest_mps_; }
  double FastestTrack() const {
    const TrackSpeeds speeds = chassis_->plant().Speeds();
    return std::max(std::abs(speeds.left_mps), std::abs(speeds.right_mps));
  }

  CanMemoryBus bus_;
  bool is_driver_hung_ = false, has_pose_ = true, has_covariance_ = true, is_tf_missing_ = false;
  double sigma_m_ = 0.01, stamp_offset_s_ = 0;
  std::optional<Rigid3> false_pose_;
  Rigid3 told_from_true_, map_from_odom_, base_from_told_;  ///< how odometry, map, head go wrong
  uint32_t epoch_ = 1;
  bool has_operator_ = true;
  StopReason no_pose_reason_ = StopReason::kPoseMissing;
  std::function<void()> each_tick_ = [] {};

 private:
  static constexpr int kDriverPeriod_ms = 20, kChassisPeriod_ms = 5, kPosePeriod_ms = 100;
  static constexpr double kLatency_s = 0.1;

  void Step() {
    ++now_ms_;
    if (now_ms_ % kChassisPeriod_ms == 0) chassis_->Tick(Now());
    if (now_ms_ % kPosePeriod_ms == 0) See();
    const auto challenge = driver_ ? pilot().operator_watch().Advance(Now(), 1) : std::nullopt;
    if (challenge && has_operator_ && pilot().operator_watch().ObserveAnswer(Now(), *challenge))
      answered_s_ = Now();
    if (now_ms_ % kDriverPeriod_ms == 3 && driver_ && !is_driver_hung_) {
      each_tick_();
      if (driver_) driver_->Tick(Now());
    }
    Listen();
  }

  void See() {
    sights_.emplace_back(Now(), chassis_->plant().WorldFromBase());
    for (; sights_.front().first <= Now() - kLatency_s + 1e-9; sights_.pop_front())
      if (driver_) Tell(sights_.front().first, sights_.front().second);
  }

  void Tell(double seen_s, const Rigid3& world_from_base) {
    const double taken_s = seen_s + stamp_offset_s_;
    if (has_pose_) pose_taken_s_ = taken_s;
    if (has_pose_ && has_covariance_) covariance_taken_s_ = taken_s;
    if (has_pose_) pilot().ObserveEpoch(epoch_, taken_s);
    if (is_tf_missing_) pilot().ObserveNoPose(no_pose_reason_);
    const Rigid3 told = told_from_true_ * world_from_base * base_from_told_;
    if (has_pose_ && !is_tf_missing_)
      pilot().ObservePose(Now(), {taken_s, false_pose_.value_or(told), map_from_odom_});
    if (has_pose_ && has_covariance_) pilot().ObserveUncertainty(Now(), {taken_s, sigma_m_, 0.01});
  }

  void Listen() {
    while (const auto frame = listener_->Receive()) {
      const ChassisCommand command = DecodeCommand(*frame);
      if (const auto* motion = std::get_if<MotionCommand>(&command)) {
        commanded_ = motion->motion;
        fastest_mps_ = std::max(fastest_mps_, std::abs(commanded_.forward_mps));
        if (!commanded_.IsZero()) last_moving_s_ = Now();
        if (commanded_.IsZero() && first_stop_s_ < last_moving_s_) first_stop_s_ = Now();
      }
    }
  }

  std::unique_ptr<CanBus> listener_;
  std::optional<SimulatedChassis> chassis_;
  std::optional<ChassisDriver> driver_;
  std::deque<std::pair<double, Rigid3>> sights_;  ///< when seen, world_from_base
  long now_ms_ = 100000;
  PlanarMotion commanded_;
  double last_moving_s_ = -1, first_stop_s_ = -2, fastest_mps_ = 0;
  double pose_taken_s_ = 0, covariance_taken_s_ = 0, answered_s_ = 0;
};

}  // namespace arfm_vo
