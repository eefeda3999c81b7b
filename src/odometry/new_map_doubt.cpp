#include "arfm_vo/odometry/new_map_doubt.h"

namespace arfm_vo {
namespace {

/// How far from its motion before a base may be: this part of the way, and this much.
constexpr double kOtherWay = 0.5, kOtherWay_m = 0.02;
/// The base goes on as before if it has done so on this way, or for so long where it stands.
constexpr double kKnownBy_m = 0.1, kKnownBy_s = 1;
/// After this time the motion before tells nothing.
constexpr double kUndecided_s = 2;

}  // namespace

NewMapDoubt::NewMapDoubt(double stamp_s, const Rigid3& odom_from_base, const Twist& twist_before)
    : stamp_s_(stamp_s), odom_from_start_(odom_from_base), twist_before_(twist_before) {}

bool NewMapDoubt::Follow(double stamp_s, const Rigid3& odom_from_base) {
  const double time_s = stamp_s - stamp_s_;
  const Eigen::Vector3d expected = time_s * twist_before_.head<3>();
  const Rigid3 start_from_base = odom_from_start_.Inverse() * odom_from_base;
  const double way_m = expected.norm(), other_m = (start_from_base.translation - expected).norm();
  const bool is_other = other_m > kOtherWay * way_m + kOtherWay_m;
  is_over_ = is_other ? time_s >= kUndecided_s : way_m >= kKnownBy_m || time_s >= kKnownBy_s;
  return is_other;
}

}  // namespace arfm_vo
