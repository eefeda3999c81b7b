#include "corrected_frame.h"

#include <algorithm>
#include <vector>

#include "arfm_vo/base/median.h"

namespace arfm_vo {

StereoFrame Corrected(StereoFrame frame, const StereoCamera& camera,
                      const StereoCorrection& correction) {
  if (correction.IsZero()) return frame;
  const auto is_too_far = [&](StereoPoint& point) {
    const Eigen::Vector3d& seen = point.observation;
    const Eigen::Vector3d nominal = NominalPixels(
        camera, correction, {seen.x(), seen.y(), seen.z(), seen.y() + point.row_residual_px});
    const double disparity = nominal.x() - nominal.z();
    if (!(disparity > point.sigma_px)) return true;
    point.x_in_camera = camera.Triangulate(nominal.x(), nominal.y(), disparity);
    return false;
  };
  StereoPoints& points = frame.points;
  points.erase(std::remove_if(points.begin(), points.end(), is_too_far), points.end());
  return frame;
}

double MedianRowResidual(const StereoPoints& points) {
  std::vector<double> residuals;
  for (const StereoPoint& point : points) residuals.push_back(point.row_residual_px);
  return Median(std::move(residuals));
}

}  // namespace arfm_vo
