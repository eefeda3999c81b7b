#include "arfm_vo/odometry/trajectory_files.h"

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/number_rows.h"

namespace arfm_vo {

// Adding 0.0 turns -0 into 0.
std::string FormatKitti(const Trajectory& trajectory) {
  std::string text;
  for (const TrajectoryPose& pose : trajectory) {
    const Eigen::Matrix<double, 3, 4> matrix = pose.world_from_camera.Matrix();
    for (int i = 0; i < 12; ++i) {
      text += FormatNumber(matrix(i / 4, i % 4) + 0.0) + (i < 11 ? " " : "\n");
    }
  }
  return text;
}

std::string FormatTracked(const Trajectory& trajectory) {
  std::string text;
  for (const TrajectoryPose& pose : trajectory) text += pose.is_tracked ? "1\n" : "0\n";
  return text;
}

std::string FormatTum(const Trajectory& trajectory, const std::string& frame) {
  std::string text =
      "# " + frame + " in that of the first tracked pair: stamp tx ty tz qx qy qz qw\n";
  for (const TrajectoryPose& pose : trajectory) {
    if (!pose.is_tracked) continue;
    const Eigen::Vector3d& t = pose.world_from_camera.translation;
    Eigen::Vector4d q = pose.world_from_camera.rotation.coeffs();
    if (q.w() < 0) q = -q;
    text += FormatNumber(pose.stamp_s, true);
    for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
      text += " " + FormatNumber(value + 0.0);
    }
    text += "\n";
  }
  return text;
}

Trajectory ReadTumTrajectory(const std::string& path) {
  Trajectory trajectory;
  for (const NumberRow& row : ReadNumberRows(path, 8)) {
    const std::string place = path + ":" + std::to_string(row.line);
    const std::vector<double>& v = row.values;
    const Eigen::Quaterniond rotation(v[7], v[4], v[5], v[6]);
    Require(std::abs(rotation.norm() - 1) < 1e-3, place + ": the quaternion is not of unit length");
    Require(trajectory.empty() || v[0] > trajectory.back().stamp_s,
            place + ": the stamp is not later than the one before");
    trajectory.push_back({v[0], Rigid3(rotation.normalized(), Eigen::Vector3d(v[1], v[2], v[3]))});
  }
  return trajectory;
}

}  // namespace arfm_vo
