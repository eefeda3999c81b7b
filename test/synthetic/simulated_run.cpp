#include "synthetic/simulated_run.h"

#include <chrono>
#include <thread>
#include <utility>

#include "arfm_vo/base/stopwatch.h"
#include "arfm_vo/geometry/linear_algebra.h"
#include "synthetic/simulated_front_end.h"

namespace arfm_vo {
namespace {

constexpr size_t kFalseFrames = 20;      ///< that a false place is in view
constexpr double kFalseDistance_m = 20;  ///< of it from the one that it looks like, at least

/// Places along a path at which what was seen elsewhere before is seen again, as if it stood here.
class FalsePlaces {
 public:
  FalsePlaces(const StereoCamera& camera, const std::vector<Rigid3>& path,
              const SimulatedRunOptions& options)
      : camera_(camera), path_(path), noise_px_(options.simulator.noise_px) {
    for (int i = 0; i < options.num_false_loops; ++i) {
      const size_t at = path.size() * (i + 2) / (options.num_false_loops + 2) - kFalseFrames;
      for (int tries = 0; tries < 1000; ++tries) {
        const auto like = static_cast<size_t>(RandomUnit(engine_) * (at - at / 10));
        const double apart_m = (path[at].translation - path[like].translation).norm();
        if (apart_m < kFalseDistance_m) continue;
        places_.push_back({at, like});
        break;
      }
    }
  }

  void AddTo(SimulatedFrame& frame, const ObservationSimulator& simulator) {
    const size_t newest = seen_.size();
    std::vector<int>& seen = seen_.emplace_back();
    for (const SimulatedObservation& observation : frame.observations)
      if (!observation.is_outlier) seen.push_back(observation.landmark_id);
    for (const auto& [at, like] : places_) {
      if (newest < at || newest >= at + kFalseFrames) continue;
      const Rigid3 camera_from_like = path_[newest].Inverse() * path_[at] * path_[like].Inverse();
      for (const int id : seen_[like]) Add(id, camera_from_like * simulator.Landmark(id), frame);
    }
  }

 private:
  double Noise() {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += RandomUnit(engine_);
    return noise_px_ * sum;
  }
  void Add(int id, const Eigen::Vector3d& x, SimulatedFrame& frame) {
    if (x.z() < 2) return;
    const Eigen::Vector3d pixels = camera_.ProjectStereo(x);
    if (!camera_.Contains(pixels.head<2>()) || pixels.z() < 0) return;
    const Eigen::Vector3d noise(Noise(), Noise(), Noise());
    frame.observations.push_back({id, -1, pixels + noise, pixels.y() + Noise(), false});
  }

  StereoCamera camera_;
  const std::vector<Rigid3>& path_;
  double noise_px_;
  RandomEngine engine_{1};
  std::vector<std::pair<size_t, size_t>> places_;  ///< frames: where it is, which it looks like
  std::vector<std::vector<int>> seen_;             ///< [frames] landmarks
};

}  // namespace

SimulatedRun RunSimulated(const StereoCamera& camera, const std::vector<Rigid3>& path,
                          const SimulatedRunOptions& options, OdometryOptions odometry_options) {
  // Without noise the odometry must still state some.
  const double sigma_px = std::max(0.05, options.simulator.noise_px);
  odometry_options.odometry = WithoutImages(odometry_options.odometry, sigma_px);
  ObservationSimulator simulator(camera, path, options.simulator);
  FalsePlaces false_places(camera, path, options);
  VisualOdometry odometry(camera, odometry_options);
  if (options.is_calibrated) {
    CorrectionBelief known = CorrectionBelief::Isotropic(1e-4);
    known.mean = options.simulator.displacement;
    odometry.SetCorrection(known);
  }
  const StereoImages no_images;
  SimulatedRun run;
  run.truth = RebaseToFirst(path);
  const auto start = std::chrono::steady_clock::now();
  while (auto seen = simulator.Next()) {
    false_places.AddTo(*seen, simulator);
    const double stamp_s = run.online.size() / options.rate_hz;
    const StereoFrame frame =
        MakeStereoFrame(camera, *seen, stamp_s, sigma_px, options.descriptor_noise, simulator);
    std::this_thread::sleep_until(start +
                                  std::chrono::duration<double>(options.is_paced ? stamp_s : 0));
    Stopwatch stopwatch;
    const SessionUpdate pose = odometry.Process(frame, no_images);
    const OdometryUpdate& update = pose.update;
    run.frame_ms.push_back(stopwatch.LapMs());
    run.odometry_s += 1e-3 * run.frame_ms.back();
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
  return SquaredMahalanobis(step, run.covariances[i]);
}

}  // namespace arfm_vo
