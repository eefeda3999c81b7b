#include "arfm_vo/driving/pose_watch.h"

#include <algorithm>
#include <cmath>

#include "arfm_vo/base/range_check.h"
#include "arfm_vo/driving/route.h"

namespace arfm_vo {
namespace {

constexpr double kMaxFromFuture_s = 0.2;
/// Between the clocks that tell when a pose and its covariance were taken.
constexpr double kClockNoise_s = 0.01;
/// A pose that is told to be worse is none: odometry that is lost says 9999 m^2.
constexpr double kMaxDatumSigma_m = 90;

RoverPose InMap(const Rigid3& map_from_odom, const RoverPose& pose_in_odom) {
  return ProjectToPlane(map_from_odom * LiftFromPlane(pose_in_odom));
}

/// What is left of a standard deviation since the datum. It may fall too: on the way back to the
/// start, or where an adjustment has told more. NaN stays NaN.
double Since(double datum, double sigma) {
  return std::min(sigma, std::sqrt(std::abs(sigma * sigma - datum * datum)));
}

}  // namespace

void PoseWatchOptions::Check() const {
  RequireAbove(max_pose_age_s, 0, 3600, "pose.max_pose_age_s");
  RequireAbove(max_position_sigma_m, 0, 1000, "pose.max_position_sigma_m");
  RequireAbove(max_heading_sigma_rad, 0, 10, "pose.max_heading_sigma_rad");
  RequireInRange(max_tilt_deg, 1, 60, "pose.max_tilt_deg");
}

PoseWatch::PoseWatch(const PoseWatchOptions& options, const TrackKinematics& kinematics)
    : options_(options), consistency_(kinematics) {
  options_.Check();
}

void PoseWatch::Observe(double now_s, const PoseObservation& pose) {
  const bool is_flawed = !FindGoalFlaw(pose.odom_from_base).empty() ||
                         !FindGoalFlaw(pose.MapFromBase()).empty() ||
                         !std::isfinite(pose.taken_s) || pose.taken_s > now_s + kMaxFromFuture_s;
  flaw_ = is_flawed ? std::optional(StopReason::kPoseInvalid) : std::nullopt;
  if (is_flawed) return;
  if (epoch_start_s_ && pose.taken_s < *epoch_start_s_ - kClockNoise_s)
    return ObserveNone(StopReason::kPoseMissing);
  told_ = pose;
}

bool PoseWatch::Observe(double now_s, const PoseUncertainty& uncertainty) {
  if (!(uncertainty.taken_s <= now_s + kMaxFromFuture_s)) return false;
  uncertainty_ = uncertainty;
  return true;
}

bool PoseWatch::ObserveEpoch(uint32_t epoch, double taken_s) {
  const bool is_new = epoch_ && *epoch_ != epoch;
  epoch_ = epoch;
  if (!is_new) return false;
  epoch_start_s_ = taken_s;
  told_.reset();
  uncertainty_.reset();
  datum_.reset();
  sightings_.clear();
  flaw_ = StopReason::kPoseMissing;
  return true;
}

std::optional<Fault> PoseWatch::CompareWithTracks(const TrackedSighting& sighting) const {
  if (sightings_.empty()) return std::nullopt;
  const PoseDifference jump = consistency_.Compare(sightings_.back(), sighting);
  if (jump.IsExcessive())
    return Fault{StopReason::kPoseContradiction, "off the tracks by " + jump.ToString()};
  const PoseDifference slide = consistency_.Compare(sightings_.front(), sighting);
  if (slide.IsExcessive())
    return Fault{StopReason::kSliding, "off the tracks by " + slide.ToString()};
  return std::nullopt;
}

std::optional<Fault> PoseWatch::TakeMap(const Rigid3& map_from_odom) {
  map_from_odom_ = map_from_odom;
  if (sightings_.empty()) {
    AgreeOnMap();
    return std::nullopt;
  }
  const TrackedSighting& now = sightings_.back();
  const PoseDifference step = consistency_.MapStep(InMap(agreed_map_from_odom_, now.pose),
                                                   InMap(map_from_odom, now.pose), agreed_, now);
  if (!step.IsExcessive()) return std::nullopt;
  AgreeOnMap();
  return Fault{StopReason::kMapStep, "by " + step.ToString()};
}

void PoseWatch::AgreeOnMap() {
  agreed_map_from_odom_ = map_from_odom_;
  agreed_ = sightings_.empty() ? TrackedSighting{} : sightings_.back();
}

void PoseWatch::Keep(const TrackedSighting& sighting) {
  sightings_.push_back(sighting);
  const double start_s = sighting.taken_s - kSlideWindow_s;
  while (sightings_.size() > 2 && sightings_[1].taken_s <= start_s) sightings_.pop_front();
}

std::optional<Fault> PoseWatch::Judge(double now_s, const TrackHistory& tracks) {
  if (flaw_ || !told_) return std::nullopt;
  auto fault = TakeMap(told_->map_from_odom);
  const bool is_new = sightings_.empty() || told_->taken_s > sightings_.back().taken_s;
  if (!is_new || IsUncertain(now_s)) return fault;
  if (uncertainty_->taken_s < told_->taken_s - kClockNoise_s) return fault;
  const TrackedSighting sighting{told_->taken_s, ProjectToPlane(told_->odom_from_base),
                                 uncertainty_->position_sigma_m, uncertainty_->heading_sigma_rad,
                                 tracks.At(told_->taken_s).value_or(TrackWays{})};
  if (const auto contradiction = CompareWithTracks(sighting)) {
    fault = contradiction;
    sightings_.clear();
  }
  Keep(sighting);
  last_odom_from_base_ = told_->odom_from_base;
  return fault;
}

std::optional<RoverPose> PoseWatch::SetDatum() {
  const bool is_known = uncertainty_ && uncertainty_->position_sigma_m < kMaxDatumSigma_m;
  if (flaw_ || !told_ || !is_known) return std::nullopt;
  datum_ = uncertainty_;
  return ProjectToPlane(told_->MapFromBase());
}

RoverPose PoseWatch::PredictInMap(const TrackWays& ways) const {
  return InMap(map_from_odom_, consistency_.Predict(sightings_.back(), ways));
}

bool PoseWatch::IsUncertain(double now_s) const {
  if (!uncertainty_ || !(now_s - uncertainty_->taken_s <= options_.max_pose_age_s)) return true;
  const PoseUncertainty datum = datum_.value_or(PoseUncertainty{});
  // Written so that NaN is uncertain.
  return !(Since(datum.position_sigma_m, uncertainty_->position_sigma_m) <=
               options_.max_position_sigma_m &&
           Since(datum.heading_sigma_rad, uncertainty_->heading_sigma_rad) <=
               options_.max_heading_sigma_rad);
}

std::optional<StopReason> PoseWatch::FindFault(double now_s) const {
  if (flaw_) return flaw_;
  if (now_s - told_->taken_s > options_.max_pose_age_s) return StopReason::kPoseStale;
  if (IsUncertain(now_s)) return StopReason::kPoseUncertain;
  if (!epoch_) return StopReason::kEpochMissing;
  if (sightings_.empty()) return StopReason::kPoseMissing;
  return std::nullopt;
}

}  // namespace arfm_vo
