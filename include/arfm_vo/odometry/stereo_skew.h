#pragma once

#include <Eigen/Core>
#include <optional>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/mapping/local_map.h"
#include "arfm_vo/pose/pose_estimator.h"

namespace arfm_vo {

struct OdometryUpdate;

/// How much later than the left picture the right one is taken (earlier: negative).
struct StereoSkew {
  double s = 0, sigma_s = 0;
};

/// Estimates the skew from rows, and how the camera moves between a pair's pictures. In a still rig
/// left and right rows differ by a field over the image that stays (StereoCorrection); with skew
/// they differ besides by the skew times the speed at which a point's row moves. Both are estimated
/// together by least squares over all frames.
class StereoSkewEstimator {
 public:
  explicit StereoSkewEstimator(const StereoCamera& camera);

  /// Takes the next pair, with the pose that is expected for it.
  void Advance(double stamp_s, const std::optional<PredictedPose>& predicted);
  /// The camera's motion from the pair's left picture to its right one; none where there is no skew
  /// to be found.
  const Rigid3& later_from_now() const { return later_from_now_; }
  /// By how much the right picture may besides be turned against the left one, for what is not
  /// known of the skew: a standard deviation, rad, about the camera's axes.
  const Eigen::Vector3d& turn_sigma_rad() const { return turn_sigma_rad_; }

  /// Learns from the pair's pose and what both cameras saw, right pixels moved to where they would
  /// be without that motion; sets its skew: nothing where it may well be none, that is no more than
  /// a millisecond, give or take. The pose is degraded where the motion is too large to be made up
  /// for well. Returns by how much the way up to here may be wrong besides, m: that of all before
  /// the skew was found.
  double Learn(const LocalMap& map, OdometryUpdate& update);
  /// The next frame does not follow the last one.
  void Interrupt() { last_.reset(); }

 private:
  static constexpr int kSize = ImageBasis::kNumTerms + 1;  ///< the row field, px, and the skew, s
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  struct Last {
    double stamp_s;
    Rigid3 camera_from_world;
    Rigid3 now_from_before;
    double interval_s;  ///< of that motion; 0: none is known
  };
  void Add(const LocalMap& map, const OdometryUpdate& update);
  /// In `duration_s`, at the speed of the way to `predicted`, or of the last way.
  Rigid3 MotionIn(double duration_s, double stamp_s,
                  const std::optional<PredictedPose>& predicted) const;
  /// How far the motion moves the observed landmarks in the right image, px, the median.
  double MedianShiftPx(const LocalMap& map, const OdometryUpdate& update) const;
  void AddRow(const Eigen::Vector4d& pixels, double row_speed_px_s, double sigma_px);
  void Solve();
  /// The skew, where it is significant.
  std::optional<StereoSkew> Found() const;

  StereoCamera camera_;
  Matrix prior_ = Matrix::Zero();        ///< information before anything is seen: the calibration's
  Matrix information_ = Matrix::Zero();  ///< of the frames, without that
  Matrix scatter_ = Matrix::Zero();  ///< of the frames' scores, which rows that err together widen
  Vector score_;                     ///< of the newest frame
  Vector right_side_ = Vector::Zero(), solution_ = Vector::Zero();
  StereoSkew skew_;        ///< by all frames
  bool is_known_ = false;  ///< it was found once
  Rigid3 later_from_now_;
  Eigen::Vector3d turn_sigma_rad_ = Eigen::Vector3d::Zero();
  std::optional<Last> last_;
};

}  // namespace arfm_vo
