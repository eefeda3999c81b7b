#pragma once

#include <algorithm>
#include <cmath>

namespace arfm_vo {

inline double Logistic(double log_odds) { return 1 / (1 + std::exp(-log_odds)); }

/// How much something tells that is exp(`log_ratio`) times likelier where one thing holds than as a
/// rule, and just as likely where another does, of this probability.
inline double LogRatioBeside(double log_ratio, double probability_of_another) {
  return log_ratio - std::log1p(probability_of_another * std::expm1(log_ratio));
}

/// Whether something holds, followed over time: a hidden Markov model of two states, in log odds.
class Belief {
 public:
  explicit Belief(double probability) : log_odds_(std::log(probability / (1 - probability))) {}

  /// Time passes: what holds may end, what does not may begin; expected times in seconds. Returns
  /// the probability that it held and does no longer.
  double Advance(double interval_s, double ends_after_s, double begins_after_s) {
    const double before = Probability();
    const double settled = ends_after_s / (ends_after_s + begins_after_s);
    const double remembered = std::exp(-interval_s * (1 / ends_after_s + 1 / begins_after_s));
    const double now = settled + remembered * (before - settled);
    log_odds_ = std::log(now / (1 - now));
    return before * (1 - settled) * (1 - remembered);
  }
  /// An observation that is exp(`log_ratio`) times likelier where it holds.
  void Add(double log_ratio) {
    constexpr double kMost = 20;
    log_odds_ = std::clamp(log_odds_ + log_ratio, -kMost, kMost);
  }

  /// It is not likelier than this.
  void Limit(double log_odds) { log_odds_ = std::min(log_odds_, log_odds); }

  double log_odds() const { return log_odds_; }
  double Probability() const { return Logistic(log_odds_); }

 private:
  double log_odds_;
};

}  // namespace arfm_vo
