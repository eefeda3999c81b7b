#include "corrected_frame.h"

#include <vector>

#include "arfm_vo/base/median.h"

namespace arfm_vo {

StereoFrame Corrected(StereoFrame frame, const StereoCamera& camera,
                      const StereoCorrection& correction) {
  if (correction.IsZero()) return frame;
  for (StereoPoint& point : frame.points) {
    const Eigen::Vector3d& seen = point.observation;
    const Eigen::Vector3d nominal = NominalPixels(
        camera, correction, {seen.x(), seen.y(), seen.z(), seen.y() + point.row_residual_px});
    point.x_in_camera =
        camera.TriangulateMeasured(nominal.x(), nominal.y(), nominal.x() - nominal.z());
  }
  return frame;
}

double MedianRowResidual(const StereoPoints& points) {
  std::vector<double> residuals;
  for (const StereoPoint& point : points) residuals.push_back(point.row_residual_px);
  return Median(std::move(residuals));
}

}  // namespace arfm_vo
