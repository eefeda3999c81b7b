#include "synthetic/simulated_run.h"

#include <Eigen/Cholesky>

#include "arfm_vo/base/stopwatch.h"
#include "synthetic/simulated_front_end.h"

namespace arfm_vo {

SimulatedRun RunSimulated(const StereoCamera& camera, const std::vector<Rigid3>& path,
                          const SimulatedRunOptions& options, OdometryOptions odometry_options) {
  // Without noise the odometry must still state some.
  const double sigma_px = std::max(0.05, options.simulator.noise_px);
  odometry_options.odometry = WithoutImages(odometry_options.odometry, sigma_px);
  ObservationSimulator simulator(camera, path, options.simulator);
  VisualOdometry odometry(camera, odometry_options);
  if (options.is_calibrated) {
    CorrectionBelief known = CorrectionBelief::Isotropic(1e-4);
    known.mean = options.simulator.displacement;
    odometry.SetCorrection(known);
  }
  const StereoImages no_images;
  SimulatedRun run;
  run.truth = RebaseToFirst(path);
  while (const auto seen = simulator.Next()) {
    const double stamp_s = run.online.size() / options.rate_hz;
    const StereoFrame frame =
        MakeStereoFrame(camera, *seen, stamp_s, sigma_px, options.descriptor_noise, simulator);
    Stopwatch stopwatch;
    const SessionUpdate pose = odometry.Process(frame, no_images);
    const OdometryUpdate& update = pose.update;
    run.odometry_s += 1e-3 * stopwatch.LapMs();
    run.num_untracked += !update.pose.IsTracked();
    run.num_lost += !update.pose.HasPose();
    run.epoch = pose.epoch;
    run.skew = update.skew;
    run.num_keyframes += update.is_keyframe;
    if (pose.keyframe) options.on_keyframe(*pose.keyframe);
    run.online.push_back(pose.odom_from_base);
    run.covariances.push_back(update.covariance_from_start);
  }
  Stopwatch stopwatch;
  for (const TrajectoryPose& pose : odometry.Finish()) run.final.push_back(pose.world_from_camera);
  run.num_loops = odometry.num_loops();
  run.learnt = odometry.correction().value_or(CorrectionBelief());
  run.finish_s = 1e-3 * stopwatch.LapMs();
  return run;
}

double ComputeNees(const SimulatedRun& run, size_t i) {
  const Rigid3 error = run.online[i].Inverse() * run.truth[i];  // estimated camera from true one
  Eigen::Matrix<double, 6, 1> step;
  step << LogSO3(error.rotation), error.translation;
  return step.dot(run.covariances[i].ldlt().solve(step));
}

}  // namespace arfm_vo
