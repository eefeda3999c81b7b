#include "arfm_vo/odometry/odometry_update.h"

namespace arfm_vo {

std::string OdometryUpdate::Describe() const {
  const std::string status = ToString(pose.status), why = ToString(reason);
  if (reason == Reason::kNone) return status;
  if (!pose.HasPose()) return why;
  return status + ": " + why + (pose.IsMeasured() ? "" : ", the last motion is continued");
}

}  // namespace arfm_vo
