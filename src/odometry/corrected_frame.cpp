#include "corrected_frame.h"

#include <vector>

#include "arfm_vo/base/median.h"
#include "arfm_vo/geometry/right_shift.h"

namespace arfm_vo {

StereoFrame Corrected(StereoFrame frame, const StereoCamera& camera,
                      const StereoCorrection& correction, const Rigid3& later_from_now) {
  const bool is_in_time = later_from_now.IsIdentity();
  if (correction.IsZero() && is_in_time) return frame;
  const auto place = [&](StereoPoint& point) {
    const Eigen::Vector3d& seen = point.observation;
    const Eigen::Vector3d nominal = NominalPixels(
        camera, correction, {seen.x(), seen.y(), seen.z(), seen.y() + point.row_residual_px});
    point.x_in_camera =
        camera.TriangulateMeasured(nominal.x(), nominal.y(), nominal.x() - nominal.z());
  };
  for (StereoPoint& point : frame.points) {
    place(point);
    if (is_in_time) continue;
    const Eigen::Vector2d shift = ShiftOfRight(camera, later_from_now, point.x_in_camera);
    point.observation.z() -= shift.x();
    point.row_residual_px -= shift.y();
    place(point);
  }
  return frame;
}

double MedianRowResidual(const StereoPoints& points) {
  std::vector<double> residuals;
  for (const StereoPoint& point : points) residuals.push_back(point.row_residual_px);
  return Median(std::move(residuals));
}

double MedianRowResidual(const LandmarkObservations& observations) {
  std::vector<double> residuals;
  for (const LandmarkObservation& observation : observations) {
    const Eigen::Vector4d seen = observation.Pixels();
    if (observation.has_right) residuals.push_back(seen.w() - seen.y());
  }
  return Median(std::move(residuals));
}

}  // namespace arfm_vo
