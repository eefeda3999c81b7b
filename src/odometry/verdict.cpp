#include "arfm_vo/odometry/verdict.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace arfm_vo {
namespace {

// Prior rates, besides those of PathDoubt: how long it takes, as a rule.
/// A rival is so much more often seen where something moves, in logarithms; and none where not.
constexpr double kRivalSeen = 4, kNoRival = -0.5;
/// Until the right picture is not of its moment: a late frame, a knock.
constexpr double kRightFails_s = 60;
/// Until it is again.
constexpr double kRightRecovers_s = 1;

/// Share of what both images see that lies on its rows, and of what the left image sees of the map
/// that the right one shows as well: of pictures that belong together, and of others.
constexpr double kTogether = 0.75, kApart = 0.25;

/// Of points that have moved so many are seen where others were: where something is fixed before
/// the camera, and by chance.
constexpr double kStill = 0.2, kStillByChance = 0.05;
/// Until something is fixed there, and until it is taken away.
constexpr double kIsFixed_s = 36000, kIsTakenAway_s = 600;

/// An image with fewer keypoints, against the other's, is dark or covered.
constexpr double kBlindShare = 0.1;

/// Disparity of a point whose depth is known, in its standard deviations.
constexpr double kMinSignificance = 3;

/// The covariance of a pose that may as well be `other`.
Eigen::Matrix<double, 6, 6> SpreadTo(const Rigid3& other, const Rigid3& pose) {
  const Rigid3 between = other * pose.Inverse();
  Eigen::Matrix<double, 6, 1> step;
  step << LogSO3(between.rotation), between.translation;
  return step * step.transpose();
}

GroundPrior AdvanceGround(double interval_s, double hidden_after_s, Belief& ground) {
  const double just_hidden = ground.Advance(interval_s, hidden_after_s, kAnotherLeaves_s);
  return {ground.Probability(), just_hidden};
}

}  // namespace

void Verdict::Advance(double stamp_s) {
  const double interval_s = std::max(0., stamp_s - stamp_s_);
  follows_ = std::exchange(is_followed_, false);
  right_belongs_.Advance(interval_s, kRightFails_s, kRightRecovers_s);
  fixed_.Advance(interval_s, kIsTakenAway_s, kIsFixed_s);
  another_moves_.Advance(interval_s, kAnotherLeaves_s, kAnotherComes_s);
  // What has come hides the ground at some moment of its stay.
  Belief where_come = ground_;
  if_come_ = AdvanceGround(interval_s, kAnotherLeaves_s, where_come);
  if_none_ = AdvanceGround(interval_s, kAnotherComes_s, ground_);
  stamp_s_ = stamp_s;
}

void Verdict::Look(const StereoFrame& frame) {
  left_fault_ = FaultOfLeft(frame);
  if (left_fault_ == Reason::kNone && !frame.right_is_repeated) {
    right_belongs_.Add(LogRatioOfShare(frame.row_agreement, kTogether, kApart));
  }
  right_fault_ = left_fault_ == Reason::kNone ? FaultOfRight(frame) : left_fault_;
}

Expectation Verdict::Expect(const std::optional<PredictedPose>& predicted) const {
  Expectation expected{predicted, if_none_, if_come_};
  expected.use_right = right_fault_ == Reason::kNone;
  expected.is_wary = IsUnsure();
  expected.fixed_log_odds = fixed_.log_odds();
  expected.another_log_odds = another_moves_.log_odds();
  return expected;
}

Reason Verdict::FaultOfLeft(const StereoFrame& frame) const {
  return frame.left_is_repeated ? Reason::kLeftRepeated : Reason::kNone;
}

Reason Verdict::FaultOfRight(const StereoFrame& frame) const {
  if (frame.right_is_repeated) return Reason::kRightRepeated;
  if (frame.images_are_swapped) return Reason::kSwapped;
  if (frame.num_right_keypoints < kBlindShare * frame.features.size()) return Reason::kRightBlind;
  if (right_belongs_.Probability() < 0.5) return Reason::kRightOff;
  return Reason::kNone;
}

void Verdict::CountFixed(double share) {
  // By the pose of what moves on its own the ground stands still.
  fixed_.Add(
      LogRatioBeside(LogRatioOfShare(share, kStill, kStillByChance), another_moves_.Probability()));
}

void Verdict::Reset(bool was_lost) {
  another_moves_ = Belief(was_lost ? 0.5 : 0.01);
  ground_ = Belief(was_lost ? 0.95 : 0.98);
}

bool Verdict::IsSwapped(const Rigid3& camera_from_world,
                        const std::optional<PredictedPose>& predicted) const {
  if (right_fault_ != Reason::kSwapped) return false;
  // In a turn pictures of two moments look like swapped ones. Those show where the right camera is.
  const Rigid3 left_from_right(Eigen::Quaterniond::Identity(), {baseline_m_, 0, 0});
  return !predicted || predicted->LogOdds(left_from_right * camera_from_world) >=
                           predicted->LogOdds(camera_from_world);
}

bool Verdict::Weigh(const TrackedFrame& tracked, const std::optional<PredictedPose>& predicted,
                    OdometryUpdate& update) {
  PoseEstimate& pose = update.pose;
  // The pose's points are the ground, those of its rival are, or neither.
  const double of_rival = pose.rival ? std::exp(ground_.log_odds() + tracked.log_odds_of_rival) : 0;
  const double others = 1 + of_rival;
  const bool is_likeliest = ground_.log_odds() + tracked.log_odds > 0;
  // Where the motion before leads there as well it is right, whatever is followed.
  const bool is_as_before = follows_ && predicted && predicted->LogOdds(pose.camera_from_world) > 0;
  const double log_odds = ground_.log_odds() + tracked.log_odds - std::log(others);
  const double probability = Logistic(log_odds);
  update.log_odds = log_odds;
  if (IsSwapped(pose.camera_from_world, predicted)) {
    pose.status = PoseStatus::kNoConsensus;
    update.reason = Reason::kSwapped;
    return false;
  }
  // What is fixed before the camera is a rival too.
  const double rival_seen = LogRatioBeside(kRivalSeen, Logistic(tracked.fixed_log_odds));
  another_moves_.Add(pose.rival || !is_likeliest ? rival_seen : kNoRival);
  // The same points tell the same again in the next pair: this is not added up.
  ground_.Limit(std::log(kAnotherComes_s / kAnotherLeaves_s) + log_odds - ground_.log_odds());
  if (!is_likeliest && !is_as_before) {
    pose.status = PoseStatus::kNoConsensus;
    update.reason = tracked.is_odd_rest ? Reason::kFixed : Reason::kGroundHidden;
    return false;
  }
  if (pose.rival) {
    update.doubt +=
        (1 - probability) * (of_rival / others) * SpreadTo(*pose.rival, pose.camera_from_world);
  }
  if (predicted && predicted->IsSpeedKnown()) {
    update.doubt +=
        (1 - probability) / others * SpreadTo(predicted->camera_from_world, pose.camera_from_world);
  }
  pose.covariance += update.doubt;
  is_followed_ = true;
  if (right_fault_ != Reason::kNone) {
    update.Degrade(right_fault_ == Reason::kSwapped ? Reason::kRightOff : right_fault_);
  } else {
    right_belongs_.Add(LogRatioOfShare(ShareWithRight(tracked.observations), kTogether, kApart));
  }
  if (1 - probability > PathDoubt::kLikely) update.reason = Reason::kGroupsDiffer;
  if (tracked.is_odd_rest) update.Degrade(Reason::kFixed);
  return true;
}

bool AreDepthsKnown(const StereoCamera& camera, const LocalMap& map,
                    const LandmarkObservations& observations, const Rigid3& camera_from_world) {
  double known = 0, all = 0;
  for (const LandmarkObservation& observation : observations) {
    const Landmark& landmark = map.landmarks().at(observation.landmark);
    const double disparity_px = camera.Disparity((camera_from_world * landmark.x_in_world).z());
    const double weight = disparity_px * disparity_px;  // a metre moves it in proportion
    all += weight;
    if (disparity_px >= kMinSignificance * std::sqrt(2) * observation.sigma_px) known += weight;
  }
  return 2 * known >= all;
}

}  // namespace arfm_vo
