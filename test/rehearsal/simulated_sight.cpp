#include "rehearsal/simulated_sight.h"

#include <cmath>
#include <limits>

namespace arfm_vo {

void SimulatedSightOptions::Check() const {
  rig.Check();
  Require(pair_period_s > 0.01 && pair_period_s <= 60, "sight.pair_period_s must be in (0.01, 60]");
  Require(latency_s >= 0 && latency_s <= 60, "sight.latency_s must be in 0..60");
  render.Check();
}

SimulatedSight::SimulatedSight(const SimulatedSightOptions& options,
                               const OdometryOptions& odometry, const RoverShape& shape,
                               const Terrain& terrain)
    : options_(options),
      camera_(options.rig.Camera()),
      base_from_camera_(BaseFromLeftCamera(shape)),
      renderer_(terrain, options.render),
      odometry_(camera_, odometry) {
  options_.Check();
}

Glimpse SimulatedSight::Look(double now_s, const Rigid3& world_from_base) {
  const StereoImages images =
      renderer_.RenderPair(camera_, world_from_base * base_from_camera_, num_pairs_++, now_s);
  const PoseEstimate estimate = odometry_.Process(images).update.pose;
  Glimpse glimpse;
  glimpse.taken_s = now_s;
  glimpse.told_s = now_s + options_.latency_s;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  glimpse.uncertainty = {now_s, nan, nan};
  if (!estimate.IsMeasured()) return glimpse;
  glimpse.map_from_base =
      base_from_camera_ * estimate.camera_from_world.Inverse() * base_from_camera_.Inverse();
  glimpse.uncertainty.position_sigma_m =
      std::sqrt(estimate.covariance.bottomRightCorner<3, 3>().trace());
  glimpse.uncertainty.heading_sigma_rad =
      std::sqrt(estimate.covariance.topLeftCorner<3, 3>().trace());
  return glimpse;
}

}  // namespace arfm_vo
