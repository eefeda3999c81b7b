#include "arfm_vo/odometry/keyframe_policy.h"

#include <vector>

#include "arfm_vo/base/median.h"

namespace arfm_vo {
namespace {

/// Share of the newest keyframe's points that is fewer than it had.
constexpr double kFewer = 0.9;

/// How far a pixel of the newest keyframe moves in the frame beyond what the rotation explains.
double Parallax(const StereoCamera& camera, const Eigen::Matrix3d& frame_from_newest,
                const Eigen::Vector4d& in_newest, const Eigen::Vector4d& in_frame) {
  const Eigen::Vector3d ray((in_newest.x() - camera.cx) / camera.fx,
                            (in_newest.y() - camera.cy) / camera.fy, 1);
  const Eigen::Vector3d turned = frame_from_newest * ray;
  if (turned.z() < 0.1) return 0;
  return (camera.Project(turned) - in_frame.head<2>()).norm();
}

}  // namespace

bool NeedsKeyframe(const StereoCamera& camera, const Keyframe& newest,
                   const Rigid3& camera_from_world, const LandmarkObservations& observations,
                   const KeyframePolicyOptions& options) {
  // A scene may hold no more: then another keyframe would not help.
  const int num_tracked = static_cast<int>(observations.size());
  const double num_newest = static_cast<double>(newest.observations.size());
  if (num_tracked < kFewer * num_newest && num_tracked < options.min_tracked_points) return true;
  const Eigen::Matrix3d frame_from_newest =
      (camera_from_world.rotation * newest.camera_from_world.rotation.conjugate())
          .toRotationMatrix();
  std::vector<double> parallax;
  auto seen = newest.observations.begin();
  for (const LandmarkObservation& observation : observations) {
    while (seen != newest.observations.end() && seen->landmark < observation.landmark) ++seen;
    if (seen == newest.observations.end()) break;
    if (seen->landmark != observation.landmark) continue;
    parallax.push_back(Parallax(camera, frame_from_newest, seen->Pixels(), observation.Pixels()));
  }
  if (static_cast<int>(parallax.size()) < options.min_shared_fraction * num_newest) return true;
  if (parallax.empty()) return true;
  return Median(std::move(parallax)) >= options.min_parallax_px;
}

}  // namespace arfm_vo
