#include "arfm_vo/odometry/odometry_update.h"

namespace arfm_vo {

std::string OdometryUpdate::Describe() const {
  const std::string status = ToString(pose.status), why = ToString(reason);
  if (reason == Reason::kNone) return status;
  if (!pose.HasPose()) return why;
  return status + ": " + why + (pose.IsMeasured() ? "" : std::string(", ") + goes_on_by);
}

}  // namespace arfm_vo
