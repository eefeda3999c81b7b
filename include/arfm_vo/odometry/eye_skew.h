#pragma once

#include <Eigen/Core>
#include <optional>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/mapping/local_map.h"

namespace arfm_vo {

/// How much later than the left picture the right one is taken (earlier: negative).
struct EyeSkew {
  double s = 0, sigma_s = 0;
};

/// Estimates the skew from rows. In a still rig left and right rows differ by a field over the
/// image that stays (StereoCorrection); with skew they differ besides by the skew times the speed
/// at which a point's row moves. Both are estimated together by least squares over all frames.
class EyeSkewEstimator {
 public:
  explicit EyeSkewEstimator(const StereoCamera& camera);

  /// A tracked frame and what both eyes saw in it, right pixels moved to where they would be
  /// without the skew that Find() told before.
  void Add(const LocalMap& map, const LandmarkObservations& observations, double stamp_s,
           const Rigid3& camera_from_world);
  /// Nothing where it may well be none: that is no more than a millisecond, give or take.
  const std::optional<EyeSkew>& Find() const { return found_; }
  /// The camera's motion (later_from_now) from a left picture to its right one, at the speed of the
  /// way to `predicted`, or of the last way; none where there is no skew to be found.
  Rigid3 MotionBetweenEyes(double stamp_s, const std::optional<Rigid3>& predicted) const;
  /// How far that motion moves what the right eye sees of the observed landmarks, px, their median.
  double MedianShiftPx(const Rigid3& later_from_now, const LocalMap& map,
                       const LandmarkObservations& observations,
                       const Rigid3& camera_from_world) const;
  /// The next frame does not follow the last one.
  void Interrupt() { last_.reset(); }

 private:
  static constexpr int kSize = 11;  ///< ten of the row field, px, and the skew, s
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  struct Last {
    double stamp_s;
    Rigid3 camera_from_world;
    Rigid3 now_from_before;
    double interval_s;  ///< of that motion; 0: none is known
  };
  void AddRow(const Eigen::Vector4d& pixels, double row_speed_px_s, double sigma_px);
  void Solve();

  StereoCamera camera_;
  Matrix information_;               ///< of the frames, without what is known before
  Matrix scatter_ = Matrix::Zero();  ///< of the frames' scores, which rows that err together widen
  Vector score_;                     ///< of the newest frame
  Vector right_side_ = Vector::Zero(), solution_ = Vector::Zero();
  std::optional<EyeSkew> found_;  ///< where it is significant
  std::optional<Last> last_;
};

}  // namespace arfm_vo
