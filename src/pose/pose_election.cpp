#include "pose_election.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pose_consensus.h"

namespace arfm_vo {
namespace {

/// What a vote counts for a pose that the motion before does not allow.
constexpr double kImplausible = 0.25;
/// Poses on which fewer agree, against the best one's, are not looked for.
constexpr double kLeastRival = 0.15;
/// Fewer agree by chance.
constexpr int kMinRival = 10;

/// A pose, and who agrees with it.
struct Hypothesis {
  Rigid3 camera_from_world;
  std::vector<char> agrees;  ///< [N]
  double score;
  double plausibility = 1;  ///< by the motion before; counted in the score

  Hypothesis(const Consensus& consensus, const Rigid3& pose, size_t num_observations)
      : camera_from_world(pose),
        agrees(num_observations),
        score(consensus.Classify(pose, agrees)) {}
};

/// What agrees with `a` and not with `b`: how many, and their votes.
std::pair<int, double> CountOnly(const std::vector<PointObservation>& observations,
                                 const Hypothesis& a, const Hypothesis& b) {
  int num = 0;
  double votes = 0;
  for (size_t i = 0; i < observations.size(); ++i) {
    if (!a.agrees[i] || b.agrees[i]) continue;
    ++num;
    votes += observations[i].votes;
  }
  return {num, votes};
}

/// The pose on which most agree, by samples.
std::optional<Rigid3> Sample(const StereoCamera& camera,
                             const std::vector<PointObservation>& observations,
                             const PoseEstimatorOptions& options) {
  const Consensus consensus(camera, observations, options);
  PoseRefinementOptions briefly = options.refinement;
  briefly.max_rounds = 1;
  const auto consent = Ransac<Rigid3>(
      static_cast<int>(observations.size()), kSamplePoints, options.ransac,
      [&](const std::vector<int>& sample) { return consensus.Solve(sample); },
      [&](const Rigid3& model, std::vector<char>& flags) {
        return consensus.Classify(model, flags);
      },
      // A few noisy points would else lose against a refined prediction with fewer friends.
      [&](const Rigid3&, const std::vector<char>& flags) {
        return consensus.Improve(flags, briefly);
      });
  if (!consent) return std::nullopt;
  return consent->model;
}

/// The poses on which most agree.
class Election {
 public:
  Election(const StereoCamera& camera, const std::vector<PointObservation>& observations,
           const std::optional<PredictedPose>& predicted, const PoseEstimatorOptions& options)
      : camera_(camera),
        observations_(observations),
        options_(options),
        consensus_(camera, observations, options) {
    if (predicted && predicted->camera_from_world.IsFinite()) predicted_ = predicted;
    for (const PointObservation& observation : observations) all_votes_ += observation.votes;
  }

  Agreement Hold() {
    if (predicted_) {
      const Rigid3& predicted = predicted_->camera_from_world;
      Propose(predicted);
      const std::vector<char> friends = best_->agrees;
      const PoseRefinement refined =
          RefinePose(camera_, observations_, predicted, options_.refinement);
      if (refined.status == RefinementStatus::kConverged) {
        Propose(refined.camera_from_world);
        if (!options_.is_wary && HasMajority() &&
            best_->camera_from_world.Matrix() == refined.camera_from_world.Matrix()) {
          return {refined, std::nullopt, {}, 1};
        }
      }
      const PoseRefinement near =
          RefinePose(camera_, observations_, predicted, options_.refinement, friends);
      if (near.status == RefinementStatus::kConverged) Propose(near.camera_from_world);
    } else if (const auto sampled = Sample(camera_, observations_, options_)) {
      Propose(*sampled);
    }
    if (options_.is_wary || !HasMajority()) ProposeRest();
    if (!best_) return {};
    Agreement agreement{RefinePose(camera_, observations_, best_->camera_from_world,
                                   options_.refinement, best_->agrees),
                        std::nullopt,
                        {},
                        best_->plausibility};
    const double least = kLeastRival * CountBest(), least_votes = kLeastRival * BestVotes();
    int most = 0;
    for (const Hypothesis& other : others_) {
      const auto [num, votes] = CountOnly(observations_, other, *best_);
      const bool is_rival = num >= kMinRival && (num >= least || votes >= least_votes);
      if (!is_rival || num <= most) continue;
      most = num;
      agreement.rival = other.camera_from_world;
      agreement.rival_agrees = other.agrees;
    }
    return agreement;
  }

 private:
  void Propose(const Rigid3& pose) {
    Hypothesis hypothesis(consensus_, pose, observations_.size());
    hypothesis.plausibility = Plausibility(pose);
    hypothesis.score *= hypothesis.plausibility;
    if (best_ && hypothesis.score <= best_->score) {
      others_.push_back(std::move(hypothesis));
    } else {
      if (best_) others_.push_back(std::move(*best_));
      best_ = std::move(hypothesis);
    }
  }

  /// No other pose can have more votes.
  bool HasMajority() const {
    return best_ && best_->plausibility == 1 && 2 * BestVotes() > all_votes_;
  }
  double CountBest() const {
    return static_cast<double>(std::count(best_->agrees.begin(), best_->agrees.end(), 1));
  }
  double BestVotes() const {
    double votes = 0;
    for (size_t i = 0; i < observations_.size(); ++i) {
      votes += best_->agrees[i] * observations_[i].votes;
    }
    return votes;
  }
  double Plausibility(const Rigid3& pose) const {
    return !predicted_ || predicted_->Allows(pose) ? 1 : kImplausible;
  }

  /// Another pose that has as many votes must have them among those that contradict, but for
  /// those, far away as a rule, that agree with both: few samples find it there.
  void ProposeRest() {
    std::vector<PointObservation> rest;
    for (size_t i = 0; i < observations_.size(); ++i) {
      if (best_ && best_->agrees[i]) continue;
      rest.push_back(observations_[i]);
    }
    PoseEstimatorOptions options = options_;
    if (best_) {
      const double share = std::max<double>(kMinRival, kLeastRival * CountBest()) /
                           static_cast<double>(rest.size() + 1);
      options.ransac.max_iterations =
          CountSamples(std::min(1., share), kSamplePoints, options.ransac);
    }
    if (const auto sampled = Sample(camera_, rest, options)) Propose(*sampled);
  }

  const StereoCamera& camera_;
  const std::vector<PointObservation>& observations_;
  const PoseEstimatorOptions& options_;
  const Consensus consensus_;
  std::optional<PredictedPose> predicted_;
  double all_votes_ = 0;
  std::optional<Hypothesis> best_;
  std::vector<Hypothesis> others_;
};

}  // namespace

Agreement HoldElection(const StereoCamera& camera,
                       const std::vector<PointObservation>& observations,
                       const std::optional<PredictedPose>& predicted,
                       const PoseEstimatorOptions& options) {
  return Election(camera, observations, predicted, options).Hold();
}

}  // namespace arfm_vo
