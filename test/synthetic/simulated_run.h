#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "arfm_vo/odometry/trajectory_error.h"
#include "arfm_vo/odometry/visual_odometry.h"
#include "synthetic/observation_simulator.h"

namespace arfm_vo {

struct SimulatedRunOptions {
  ObservationSimulatorOptions simulator;
  double descriptor_noise = 0.3;  ///< ObservationSimulator::Describe
  double rate_hz = 10;
  bool is_paced = false;      ///< frames come at the rate, else as soon as one is done
  bool is_calibrated = true;  ///< the odometry knows the right image's displacement
  /// Places along the path that look like one seen before, which lies at least 20 m off.
  int num_false_loops = 0;
  std::function<void(const PlacedKeyframe&)> on_keyframe = [](const PlacedKeyframe&) {};
};

/// An odometry without images along a path, and how it did.
struct SimulatedRun {
  std::vector<Rigid3> truth, online, final;  ///< world_from_camera, from the first camera
  std::vector<Eigen::Matrix<double, 6, 6>> covariances;  ///< of `online`, as OdometryUpdate has it
  int num_untracked = 0, num_lost = 0;                   ///< of them without any pose
  int num_keyframes = 0, num_loops = 0;
  std::optional<StereoSkew> skew;       ///< as the last frame had it
  CorrectionBelief learnt;              ///< at the end
  uint32_t epoch = 0;                   ///< of the last frame; the first is 1
  std::vector<double> frame_ms;         ///< of each
  double odometry_s = 0, finish_s = 0;  ///< wall time; without the simulation

  TrajectoryError OnlineError() const { return ComputeTrajectoryError(truth, online); }
  TrajectoryError FinalError() const { return ComputeTrajectoryError(truth, final); }
};

/// Sends what `simulator` sees along `path` (world_from_camera) through `odometry`, whose options
/// are made to do without images.
SimulatedRun RunSimulated(const StereoCamera& camera, const std::vector<Rigid3>& path,
                          const SimulatedRunOptions& options, OdometryOptions odometry);

/// Normalised estimation error squared of frame `i` of the run, chi-square of 6 degrees of freedom
/// where the covariance is honest.
double ComputeNees(const SimulatedRun& run, size_t i);

}  // namespace arfm_vo
