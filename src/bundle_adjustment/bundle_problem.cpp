#include "arfm_vo/bundle_adjustment/bundle_problem.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

/// Like Require, but builds the message only where it is needed: there are many observations.
void RequireItem(bool condition, const char* what, size_t index, const char* fault) {
  if (!condition) Require(false, "bundle: " + std::string(what) + std::to_string(index) + fault);
}

bool IsIndex(int index, size_t size) { return index >= 0 && static_cast<size_t>(index) < size; }

void CheckObservations(const BundleProblem& problem) {
  for (size_t i = 0; i < problem.observations.size(); ++i) {
    const BundleObservation& observation = problem.observations[i];
    const char* const what = "observation ";
    RequireItem(IsIndex(observation.pose, problem.camera_from_world.size()), what, i,
                ": pose is out of range");
    RequireItem(IsIndex(observation.point, problem.points.size()), what, i,
                ": point is out of range");
    RequireItem(observation.pixels.head<2>().allFinite() &&
                    (!observation.has_right || observation.pixels.allFinite()),
                what, i, ": pixels are not finite");
    RequireItem(std::isfinite(observation.sigma_px) && observation.sigma_px > 0, what, i,
                ": sigma_px must be positive");
  }
}

void CheckConstraints(const BundleProblem& problem) {
  for (size_t i = 0; i < problem.constraints.size(); ++i) {
    const PoseConstraint& constraint = problem.constraints[i];
    const char* const what = "constraint ";
    RequireItem(IsIndex(constraint.first, problem.camera_from_world.size()) &&
                    IsIndex(constraint.second, problem.camera_from_world.size()),
                what, i, ": pose is out of range");
    RequireItem(constraint.first != constraint.second, what, i, ": ties a pose to itself");
    RequireItem(constraint.second_from_first.IsFinite() && constraint.information.allFinite(), what,
                i, ": not finite");
  }
}

}  // namespace

void BundleProblem::Check() const {
  camera.Check();
  Require(pose_is_fixed.size() == camera_from_world.size(),
          "bundle: pose_is_fixed must have one flag a pose");
  for (size_t i = 0; i < camera_from_world.size(); ++i) {
    RequireItem(camera_from_world[i].IsFinite(), "pose ", i, " is not finite");
  }
  for (size_t i = 0; i < points.size(); ++i) {
    RequireItem(points[i].allFinite(), "point ", i, " is not finite");
  }
  CheckObservations(*this);
  CheckConstraints(*this);
  Require(!observations.empty() || !constraints.empty(), "bundle: there is no observation");
  Require(std::any_of(pose_is_fixed.begin(), pose_is_fixed.end(), [](char flag) { return flag; }),
          "bundle: no pose is fixed, so the gauge is free");
  Require(correction.coefficients_px.allFinite(), "bundle: the stereo correction is not finite");
  Require(!correction_prior || (correction_prior->mean.coefficients_px.allFinite() &&
                                correction_prior->covariance.allFinite() &&
                                correction_prior->covariance.diagonal().minCoeff() > 0),
          "bundle: correction_prior must be finite with positive variances");
}

}  // namespace arfm_vo
