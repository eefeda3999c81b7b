#include "recordings/judged_run.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "arfm_vo/geometry/linear_algebra.h"

namespace arfm_vo {
namespace {

constexpr double kMaxSigmas = 3;
constexpr double kMinPathBaselines = 5;  ///< of a path whose length is compared

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Compares poses of the odometry with the truth, both as motions since an anchor pair.
class Comparison {
 public:
  Comparison(const Rigid3& true_anchor, const Rigid3& live_anchor)
      : odom_from_world_(live_anchor * true_anchor.Inverse()) {}

  double Error(const Rigid3& truth, const Rigid3& live) const {
    return (live.translation - (odom_from_world_ * truth).translation).norm();
  }
  /// `covariance` of (x, y, z, rotations about the axes of odom).
  double Nees(const Rigid3& truth, const Rigid3& live, const Matrix6& covariance) const {
    const Rigid3 expected = odom_from_world_ * truth;
    Vector6 error;
    error << live.translation - expected.translation,
        LogSO3(live.rotation * expected.rotation.conjugate());
    return SquaredMahalanobis(error, covariance);
  }

 private:
  Rigid3 odom_from_world_;
};

class Judge {
 public:
  Judge(const Recording& recording, const Tolerance& tolerance)
      : source_(recording.source()), fault_(recording.plan().fault), tolerance_(tolerance) {}

  void Add(int index, const SessionUpdate& update, const SharedView& view) {
    JudgedPair pair;
    pair.state = update.IsTracked() ? Outcome::kTracked
                 : update.HasPose() ? Outcome::kDegraded
                                    : Outcome::kLost;
    pair.view = view;
    pair.text = update.text;
    pair.live = update.odom_from_base;
    pair.is_judged = index > 0 && index >= fault_.begin;
    const bool is_blind = fault_.IsRightUseless() && index >= fault_.begin && index < fault_.end;
    pair.can_be_tracked = view.CanBeTracked() && !is_blind;
    const Rigid3& truth = source_.WorldFromLeft(index);
    if (index > 0) path_m_ += TrueStep(index);
    pair.path_m = path_m_ - anchor_path_m_;
    if (update.HasPose()) Compare(truth, update, pair);
    // The last pose before the fault is what later ones are compared with.
    if (update.HasPose() && (!anchor_ || index < fault_.begin)) {
      anchor_.emplace(truth, update.odom_from_base);
      anchor_path_m_ = path_m_;
      if (!start_) start_ = anchor_;
    }
    run_.pairs.push_back(pair);
  }

  JudgedRun Finish() {
    double true_m = 0, live_m = 0;
    for (size_t i = 1; i < run_.pairs.size(); ++i) {
      const JudgedPair &before = run_.pairs[i - 1], &now = run_.pairs[i];
      if (before.state == Outcome::kLost || now.state == Outcome::kLost) continue;
      live_m += (now.live.translation - before.live.translation).norm();
      true_m += TrueStep(static_cast<int>(i));
    }
    const double min_m = kMinPathBaselines * source_.camera().baseline_m;
    if (true_m > min_m) run_.length_ratio = live_m / true_m;
    run_.path_m = path_m_;
    if (start_ && path_m_ > min_m) {
      const Rigid3& truth = source_.WorldFromLeft(source_.size() - 1);
      run_.end_error_percent = 100 * start_->Error(truth, run_.pairs.back().live) / path_m_;
    }
    return run_;
  }

 private:
  double TrueStep(int index) const {
    return (source_.WorldFromLeft(index).translation - source_.WorldFromLeft(index - 1).translation)
        .norm();
  }

  void Compare(const Rigid3& truth, const SessionUpdate& update, JudgedPair& pair) const {
    if (!anchor_) return;
    pair.error_m = anchor_->Error(truth, update.odom_from_base);
    pair.sigma_m = std::sqrt(update.covariance.topLeftCorner<3, 3>().trace());
    const double tolerated = tolerance_.percent / 100 * pair.path_m + tolerance_.floor_m;
    pair.is_wrong =
        update.IsTracked() && pair.error_m > kMaxSigmas * pair.sigma_m && pair.error_m > tolerated;
    pair.start_error_m = start_->Error(truth, update.odom_from_base);
    pair.nees = start_->Nees(truth, update.odom_from_base, update.covariance);
  }

  const PairSource& source_;
  FaultPlan fault_;
  Tolerance tolerance_;
  std::optional<Comparison> start_, anchor_;
  double path_m_ = 0, anchor_path_m_ = 0;
  JudgedRun run_;
};

}  // namespace

JudgedRun RunAndJudge(Recording& recording, const OdometryOptions& options,
                      const Tolerance& tolerance) {
  const PairSource& source = recording.source();
  VisualOdometry odometry(source.camera(), options);
  Judge judge(recording, tolerance);
  std::optional<TruePair> before;
  for (int i = 0; i < source.size(); ++i) {
    Recording::Pair pair = recording.Take(i);
    SharedView view;
    if (before) {
      const Rigid3 before_from_now =
          source.WorldFromLeft(i - 1).Inverse() * source.WorldFromLeft(i);
      view = CompareViews(source.camera(), *before, pair.clean, before_from_now, pair.shown);
    }
    judge.Add(i, odometry.Process(pair.images), view);
    before = std::move(pair.clean);
  }
  odometry.Finish();
  return judge.Finish();
}

const char* ToString(Outcome state) {
  return state == Outcome::kTracked ? "tracked" : state == Outcome::kDegraded ? "degraded" : "lost";
}

}  // namespace arfm_vo
