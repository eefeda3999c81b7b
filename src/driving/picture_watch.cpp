#include "arfm_vo/driving/picture_watch.h"

#include <cmath>

#include "arfm_vo/base/format.h"

namespace arfm_vo {
namespace {

constexpr double kWindow_s = 1;
constexpr size_t kMinPictures = 4;  // a line has two of them
/// A camera cannot tell less than a grey level; three standard errors are chance.
constexpr double kGreyLevel = 1, kNumSigmas = 3;
/// With fewer landmarks in stereo, one of so many, left and right do not fit.
constexpr size_t kMinStereoShare = 10;

}  // namespace

void PictureWatch::Observe(const Picture& picture) {
  if (!pictures_.empty() && picture.taken_s == pictures_.back().taken_s) return;
  const double gap_s = pictures_.empty() ? 0 : picture.taken_s - pictures_.back().taken_s;
  if (!(gap_s >= 0 && gap_s <= max_age_s_)) {
    pictures_.clear();
    has_settled_ = false;
  }
  pictures_.push_back(picture);
  while (pictures_.size() > kMinPictures && pictures_[1].taken_s <= picture.taken_s - kWindow_s)
    pictures_.pop_front();
  has_settled_ = has_settled_ || IsSteady();
}

/// The line through the grey means changes by no more over the window than its own scatter
/// explains.
bool PictureWatch::IsSteady() const {
  const auto n = static_cast<double>(pictures_.size());
  if (pictures_.size() < kMinPictures || Span() < kWindow_s) return false;
  double mean_s = 0, mean = 0, var_s = 0, var = 0, covariance = 0;
  for (const Picture& one : pictures_) {
    mean_s += one.taken_s / n;
    mean += one.grey_mean / n;
  }
  for (const Picture& one : pictures_) {
    const double time_s = one.taken_s - mean_s, grey = one.grey_mean - mean;
    var_s += time_s * time_s;
    var += grey * grey;
    covariance += time_s * grey;
  }
  const double slope = covariance / var_s;
  const double scatter = std::max(0.0, var - slope * covariance) / (n - 2);
  const double sigma = std::sqrt(scatter / var_s);
  return Span() * (std::abs(slope) - kNumSigmas * sigma) <= kGreyLevel;
}

std::vector<CheckLine> PictureWatch::Check(double now_s) const {
  if (pictures_.empty()) {
    const std::string none = "the odometry tells of no picture";
    return {{"camera", {}, none}, {"exposure", {}, none}, {"both_cameras", {}, none}};
  }
  const Picture& last = pictures_.back();
  const double age_s = now_s - last.taken_s;
  const bool has_rate = age_s <= max_age_s_ && Span() > 0;
  const double rate_hz = has_rate ? static_cast<double>(pictures_.size() - 1) / Span() : 0;
  return {
      {"camera", has_rate,
       has_rate ? Format("%.1f pictures a second", rate_hz)
                : Format("the last picture is %.1f s old", age_s)},
      {"exposure", has_settled_,
       Format("%s, mean grey %.0f", has_settled_ ? "has settled" : "has not settled",
              last.grey_mean)},
      {"both_cameras",
       last.num_seen_by_both * kMinStereoShare >= last.num_landmarks && last.num_seen_by_both > 0,
       Format("%zu of %zu landmarks are seen by both", last.num_seen_by_both, last.num_landmarks)}};
}

}  // namespace arfm_vo
