#include "skew_compensation.h"

namespace arfm_vo {
namespace {

/// Share of the way by which the pose may be off for a skew that was not known on it.
constexpr double kDoubt = 0.1;
/// Known skew that moves what is seen by more than this is not made up for well enough to trust.
constexpr double kMaxShiftPx = 1;

}  // namespace

double SkewCompensation::Learn(const LocalMap& map, OdometryUpdate& update) {
  const Rigid3& camera_from_world = update.pose.camera_from_world;
  skew_.Add(map, update.observations, update.stamp_s, camera_from_world);
  update.skew = skew_.Find();
  const bool is_new = update.skew && !is_found_;
  is_found_ |= is_new;
  if (update.pose.IsTracked() && skew_.MedianShiftPx(later_from_now_, map, update.observations,
                                                     camera_from_world) >= kMaxShiftPx) {
    update.Degrade(Reason::kSkewed);
  }
  return is_new ? kDoubt * camera_from_world.Inverse().translation.norm() : 0;
}

}  // namespace arfm_vo
