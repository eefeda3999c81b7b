#include <algorithm>
#include <cmath>
#include <limits>

#include "arfm_vo/driving/pilot.h"
#include "fuzz/byte_source.h"
#include "fuzz/fuzz_targets.h"
#include "fuzz/promise.h"

namespace arfm_vo {
namespace {

constexpr double kTick_s = 0.02;
constexpr double kNever_s = -std::numeric_limits<double>::infinity();
constexpr double kMaxFromFuture_s = 0.2;  ///< what is told to be of a later time is not believed

/// A rover on ground without slip, whose chassis, cameras and operator are well unless the bytes
/// say otherwise. The pilot's options are the defaults.
class FuzzedDrive {
 public:
  explicit FuzzedDrive(ByteSource& bytes) : bytes_(bytes) {}

  /// Something happens, then up to 2.4 s go by.
  void Step() {
    const uint8_t action = bytes_.Byte();
    Happen(action % 16);
    for (int i = 8 * (action / 16); i >= 0; --i) Tick();
  }

 private:
  void Happen(int event) {
    switch (event) {
      case 0:
      case 1:
        if (pilot_.Start(now_s_).is_accepted) has_started_ = true;
        break;
      case 2:
        pilot_.Stop();
        has_started_ = false;
        break;
      case 3:
        SetEmergencyStop(bytes_.Byte() % 2 == 0);
        break;
      case 4:
      case 5:
        SetRoute();
        break;
      case 6:
        pilot_.CancelRoute();
        break;
      case 7:
        streams_velocity_ = bytes_.Byte() % 4 != 0;
        velocity_ = {bytes_.Value<double>(), bytes_.Value<double>()};
        break;
      case 8:
        SpoilPose();
        break;
      case 9:
        ObserveUncertainty(
            {now_s_ - bytes_.Value<double>(), bytes_.Value<double>(), bytes_.Value<double>()});
        break;
      case 10:
        epoch_ = bytes_.Byte() % 4;
        break;
      case 11:
        SpoilChassis();
        break;
      case 12:
        left_mm_ += bytes_.Value<int16_t>();
        right_mm_ += bytes_.Value<int16_t>();
        break;
      case 13:
        pilot_.SetDatum();
        break;
      case 14:
        is_bus_up_ = bytes_.Byte() % 4 != 0;
        has_operator_ = bytes_.Byte() % 4 != 0;
        has_pose_ = bytes_.Byte() % 4 != 0;
        break;
      default:
        now_s_ += std::abs(bytes_.Value<int16_t>()) / 256.0;
    }
  }

  void SetEmergencyStop(bool is_set) {
    is_emergency_stop_ = is_set;
    pilot_.SetEmergencyStop("fuzz", is_set);
  }

  void SetRoute() {
    Route route;
    for (int i = bytes_.Byte() % 4; i > 0; --i) {
      route.push_back({bytes_.Value<double>(), bytes_.Value<double>(), {}});
      if (bytes_.Byte() % 2 == 0) route.back().heading_rad = bytes_.Value<double>();
    }
    Takes([&] { pilot_.SetRoute(route); });
  }

  void SpoilPose() {
    PoseObservation pose{now_s_ - bytes_.Value<double>(), odom_from_base_, map_from_odom_};
    Rigid3& spoilt = bytes_.Byte() % 2 == 0 ? pose.odom_from_base : pose.map_from_odom;
    const uint8_t field = bytes_.Byte() % 7;
    (field < 3 ? spoilt.translation[field] : spoilt.rotation.coeffs()[field - 3]) =
        bytes_.Value<double>();
    if (bytes_.Byte() % 4 == 0) map_from_odom_ = pose.map_from_odom;
    ObservePose(pose);
  }

  void SpoilChassis() {
    const uint8_t bits = bytes_.Byte();
    chassis_.is_emergency_stop = bits & 1;
    chassis_.has_fault = bits & 2;
    chassis_.is_remote_lost = bits & 4;
    chassis_.has_motor_fault = bits & 8;
    is_ours_ = (bits & 16) == 0;
    if (bits & 32) pilot_.chassis_watch().ObserveForeignCommand(now_s_);
    if (bits & 64)
      pilot_.motion_watch().ObserveMotion(now_s_, {bytes_.Value<double>(), bytes_.Value<double>()});
    if (bits & 128) pilot_.motion_watch().ObserveCurrent(now_s_, bytes_.Value<double>());
  }

  void Note(double taken_s, double& newest_s) const {
    if (taken_s <= now_s_ + kMaxFromFuture_s) newest_s = std::max(newest_s, taken_s);
  }

  void ObservePose(const PoseObservation& pose) {
    if (pose.odom_from_base.IsFinite() && pose.map_from_odom.IsFinite())
      Note(pose.taken_s, seen_s_);
    pilot_.ObservePose(now_s_, pose);
  }

  void ObserveUncertainty(const PoseUncertainty& uncertainty) {
    if (std::isfinite(uncertainty.position_sigma_m) && std::isfinite(uncertainty.heading_sigma_rad))
      Note(uncertainty.taken_s, known_s_);
    pilot_.ObserveUncertainty(now_s_, uncertainty);
  }

  void Observe() {
    chassis_.authority = is_ours_ ? ChassisAuthority::kUs : ChassisAuthority::kRemoteControl;
    pilot_.chassis_watch().ObserveBus(is_bus_up_);
    if (is_bus_up_) {
      pilot_.chassis_watch().ObserveFeedback(now_s_, FeedbackKind::kMotion);
      pilot_.chassis_watch().Observe(now_s_, chassis_);
      pilot_.ObserveTracks(now_s_, static_cast<int>(left_mm_), static_cast<int>(right_mm_));
    }
    const auto challenge = pilot_.operator_watch().Advance(now_s_, 1);
    if (has_operator_ && challenge) {
      heard_s_ = now_s_;
      pilot_.operator_watch().ObserveAnswer(now_s_, *challenge);
    }
    if (++num_ticks_ % 5 != 0) return;
    pilot_.ObserveEpoch(epoch_, now_s_);
    if (!has_pose_) return pilot_.ObserveNoPose();
    ObserveUncertainty({now_s_, 0.01, 0.01});
    ObservePose({now_s_, odom_from_base_, map_from_odom_});
  }

  void Tick() {
    now_s_ += kTick_s;
    Observe();
    if (streams_velocity_) pilot_.SetVelocity(now_s_, velocity_);
    const DriveCommand command = pilot_.Tick(now_s_);
    const PlanarMotion& motion = command.chassis_motion;
    Promise(motion.IsFinite() && std::abs(motion.forward_mps) <= kMaxSpeed_mps &&
                std::abs(motion.turn_radps) <= kMaxTurnRate_radps,
            "motions keep the limits");
    if (!motion.IsZero()) CheckMayMove();
    pilot_.TakeResults();
    Move(motion);
  }

  void CheckMayMove() const {
    Promise(has_started_, "nothing moves before a start, and after a stop");
    Promise(!is_emergency_stop_, "nothing moves in an emergency stop");
    Promise(is_bus_up_ && is_ours_, "nothing moves that does not obey");
    Promise(now_s_ - heard_s_ <= OperatorWatchOptions().timeout_s, "an operator is there");
    const double max_age_s = PoseWatchOptions().max_pose_age_s + kTick_s;
    Promise(now_s_ - seen_s_ <= max_age_s, "nothing moves without a pose");
    Promise(now_s_ - known_s_ <= max_age_s, "nothing moves without a covariance");
  }

  void Move(const PlanarMotion& motion) {
    const TrackSpeeds speeds = TrackKinematics({}).TracksFor(motion);
    left_mm_ += 1000 * kTick_s * speeds.left_mps;
    right_mm_ += 1000 * kTick_s * speeds.right_mps;
    odom_from_base_ = odom_from_base_ * Rigid3(ExpSO3({0, 0, kTick_s * motion.turn_radps}),
                                               Eigen::Vector3d(kTick_s * motion.forward_mps, 0, 0));
  }

  ByteSource& bytes_;
  Pilot pilot_{PilotOptions()};
  double now_s_ = 100;
  int num_ticks_ = 0;
  bool has_started_ = false, is_emergency_stop_ = false;
  bool is_bus_up_ = true, is_ours_ = true, has_operator_ = true, has_pose_ = true;
  double heard_s_ = kNever_s, seen_s_ = kNever_s, known_s_ = kNever_s;
  bool streams_velocity_ = false;
  PlanarMotion velocity_;
  uint32_t epoch_ = 1;
  ChassisStatus chassis_;
  double left_mm_ = 0, right_mm_ = 0;
  Rigid3 odom_from_base_, map_from_odom_;
};

void DriveBySight(const std::string& input) {
  ByteSource bytes(input);
  FuzzedDrive drive(bytes);
  while (!bytes.IsEmpty()) drive.Step();
}

}  // namespace

std::vector<FuzzTarget> DrivingTargets() { return {{"pilot", DriveBySight}}; }

}  // namespace arfm_vo
