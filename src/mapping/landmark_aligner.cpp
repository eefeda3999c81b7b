#include "arfm_vo/mapping/landmark_aligner.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "arfm_vo/base/check.h"
#include "arfm_vo/geometry/right_shift.h"

namespace arfm_vo {
namespace {

/// Whether two warps place no sample of a patch further apart than alignment cares for.
bool LookAlike(const cv::Matx22f& a, const cv::Matx22f& b) {
  constexpr float kMaxShiftPx = 0.1f;
  const cv::Matx22f shift = Patch::kHalfSpan * (a - b);
  return std::max(std::abs(shift(0, 0)) + std::abs(shift(0, 1)),
                  std::abs(shift(1, 0)) + std::abs(shift(1, 1))) < kMaxShiftPx;
}

}  // namespace

void LandmarkAlignerOptions::Check() const {
  Require(max_magnification > 1, "alignment.max_magnification must be above 1");
  Require(min_sigma_px > 0, "alignment.min_sigma_px must be positive");
  Require(max_right_row_px > 0, "alignment.max_right_row_px must be positive");
}

std::optional<cv::Matx22f> SourceFromTarget(const StereoCamera& camera, const Landmark& landmark,
                                            const Rigid3& source_from_world,
                                            const Rigid3& target_from_world) {
  const Eigen::Vector3d x_in_source = source_from_world * landmark.x_in_world;
  const Eigen::Vector3d x_in_target = target_from_world * landmark.x_in_world;
  if (x_in_source.z() <= 0 || x_in_target.z() <= 0) return std::nullopt;
  const Eigen::Vector3d normal = source_from_world.rotation * landmark.normal_in_world;
  const double distance = normal.dot(x_in_source);
  if (distance < 1e-3 * x_in_source.norm()) return std::nullopt;
  // A pixel step in the source moves the point X of the plane m X = 1 by (z / f) (e_i - m_i X).
  const Eigen::Vector3d m = normal / distance;
  Eigen::Matrix<double, 3, 2> step;
  step.col(0) = x_in_source.z() / camera.fx * (Eigen::Vector3d::UnitX() - m.x() * x_in_source);
  step.col(1) = x_in_source.z() / camera.fy * (Eigen::Vector3d::UnitY() - m.y() * x_in_source);
  const Eigen::Matrix3d rotation =
      (target_from_world.rotation * source_from_world.rotation.conjugate()).toRotationMatrix();
  const double x = x_in_target.x(), y = x_in_target.y(), z = x_in_target.z();
  Eigen::Matrix<double, 2, 3> projection;
  projection << camera.fx / z, 0, -camera.fx * x / (z * z), 0, camera.fy / z,
      -camera.fy * y / (z * z);
  const Eigen::Matrix2d target_from_source = projection * rotation * step;
  if (target_from_source.determinant() < 1e-6) return std::nullopt;
  const Eigen::Matrix2f inverse = target_from_source.inverse().cast<float>();
  return cv::Matx22f(inverse(0, 0), inverse(0, 1), inverse(1, 0), inverse(1, 1));
}

LandmarkAligner::LandmarkAligner(const StereoCamera& camera, const LandmarkAlignerOptions& options)
    : camera_(camera), options_(options) {
  camera.Check();
  options.Check();
}

std::optional<cv::Matx22f> LandmarkAligner::FindWarp(const Landmark& landmark,
                                                     const Keyframe& reference,
                                                     const Rigid3& camera_from_world) const {
  const auto warp =
      SourceFromTarget(camera_, landmark, reference.camera_from_world, camera_from_world);
  if (!warp) return std::nullopt;
  const double shrinkage = std::sqrt(cv::determinant(*warp));
  if (shrinkage * options_.max_magnification < 1 || shrinkage > options_.max_magnification) {
    return std::nullopt;
  }
  return warp;
}

std::optional<LandmarkObservation> LandmarkAligner::Align(const Landmark& landmark,
                                                          const Keyframe& reference,
                                                          const StereoImages& images,
                                                          const Rigid3& camera_from_world,
                                                          bool use_right) const {
  const cv::Point2f place(landmark.keypoint.x, landmark.keypoint.y);
  const auto warp = FindWarp(landmark, reference, camera_from_world);
  if (!warp) return std::nullopt;
  const auto patch = Patch::Sample(reference.left, place, *warp);
  if (!patch) return std::nullopt;

  const Eigen::Vector3d x_in_camera = camera_from_world * landmark.x_in_world;
  const Eigen::Vector4d predicted = ProjectStereo4(camera_, correction_, x_in_camera);
  const Eigen::Vector2d late = ShiftOfRight(camera_, later_from_now_, x_in_camera);
  const cv::Point2f shift(static_cast<float>(late.x()), static_cast<float>(late.y()));
  const PatchAlignment left = AlignPatch(
      *patch, images.left, {static_cast<float>(predicted.x()), static_cast<float>(predicted.y())});
  if (!left.IsAligned()) return std::nullopt;

  LandmarkObservation observation;
  observation.landmark = landmark.id;
  float variance = left.covariance[0] + left.covariance[2];
  const cv::Point2f guess =
      shift + cv::Point2f(static_cast<float>(predicted.z() + left.position.x - predicted.x()),
                          static_cast<float>(predicted.w() + left.position.y - predicted.y()));
  PatchAlignment right;
  const Rigid3 right_from_world(
      camera_from_world.rotation,
      camera_from_world.translation - Eigen::Vector3d(camera_.baseline_m, 0, 0));
  const auto right_warp =
      use_right ? FindWarp(landmark, reference, right_from_world) : std::nullopt;
  if (right_warp) {
    if (LookAlike(*warp, *right_warp)) {
      right = AlignPatch(*patch, images.right, guess);
    } else if (const auto right_patch = Patch::Sample(reference.left, place, *right_warp)) {
      right = AlignPatch(*right_patch, images.right, guess);
    }
  }
  observation.has_right =
      right.IsAligned() && std::abs(right.position.y - guess.y) < options_.max_right_row_px;
  if (observation.has_right) {
    variance = 0.5f * (variance + right.covariance[0] + right.covariance[2]);
  }
  right.position -= shift;
  observation.pixels << left.position.x, left.position.y, right.position.x, right.position.y;
  observation.sigma_px =
      static_cast<float>(std::max(options_.min_sigma_px, std::sqrt(0.5 * variance)));
  return observation;
}

std::optional<LandmarkObservation> LandmarkAligner::AlignCoarsely(
    const Landmark& landmark, const Keyframe& reference, const HalvedImages& left_halved, int level,
    const Rigid3& camera_from_world) const {
  const auto warp = FindWarp(landmark, reference, camera_from_world);
  if (!warp) return std::nullopt;
  const float size = std::ldexp(1.F, level);
  const cv::Point2f place(landmark.keypoint.x / size, landmark.keypoint.y / size);
  const auto patch = Patch::Sample(reference.left_halved[level - 1], place, *warp);
  if (!patch) return std::nullopt;
  const Eigen::Vector4d predicted =
      ProjectStereo4(camera_, correction_, camera_from_world * landmark.x_in_world) / size;
  const PatchAlignment found =
      AlignPatch(*patch, left_halved[level - 1],
                 {static_cast<float>(predicted.x()), static_cast<float>(predicted.y())});
  if (!found.IsAligned()) return std::nullopt;
  LandmarkObservation observation;
  observation.landmark = landmark.id;
  observation.has_right = false;
  observation.pixels << size * found.position.x, size * found.position.y, 0, 0;
  const double sigma_px = std::sqrt(0.5 * (found.covariance[0] + found.covariance[2]));
  observation.sigma_px = static_cast<float>(size * std::max(options_.min_sigma_px, sigma_px));
  return observation;
}

}  // namespace arfm_vo
