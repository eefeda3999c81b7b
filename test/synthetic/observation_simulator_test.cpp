#include "synthetic/observation_simulator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "arfm_vo/geometry/kitti_poses.h"
#include "base/shared_data.h"

namespace arfm_vo {
namespace {

const StereoCamera kCamera{707, 707, 601.9, 183.1, 0.5372, 1226, 370};

/// Frames 0.8 m apart along +z.
std::vector<Rigid3> StraightPath(int num_frames) {
  std::vector<Rigid3> path(num_frames);
  for (int i = 0; i < num_frames; ++i) path[i].translation.z() = 0.8 * i;
  return path;
}

TEST(ObservationSimulator, ErrorsAreWhatTheOptionsSay) {
  ObservationSimulator simulator(kCamera, StraightPath(60));
  int num_all = 0, num_outliers = 0, num_close = 0;
  double squares = 0;
  while (const auto frame = simulator.Next()) {
    for (const SimulatedObservation& seen : frame->observations) {
      const Eigen::Vector3d x =
          frame->world_from_camera.Inverse() * simulator.Landmark(seen.landmark_id);
      const Eigen::Vector3d error = seen.pixels - kCamera.ProjectStereo(x);
      ++num_all;
      num_outliers += seen.is_outlier;
      num_close += seen.is_outlier && error.norm() < 3;
      if (!seen.is_outlier) squares += error.squaredNorm() / 3;
    }
  }
  EXPECT_EQ(num_all, 60 * 300);
  EXPECT_NEAR(static_cast<double>(num_outliers) / num_all, 0.2, 0.01);
  EXPECT_LT(num_close, 0.06 * num_outliers);  // by chance within 3 px of the truth
  EXPECT_NEAR(std::sqrt(squares / (num_all - num_outliers)), 0.5, 0.01);
}

TEST(ObservationSimulator, TracksHaveTheLengthAskedForAndNoGaps) {
  ObservationSimulatorOptions options;
  options.mean_track_frames = 6;
  ObservationSimulator simulator(kCamera, std::vector<Rigid3>(200), options);  // at rest
  std::map<int, std::vector<int>> frames_of_track;
  for (int i = 0; const auto frame = simulator.Next(); ++i) {
    for (const SimulatedObservation& seen : frame->observations)
      frames_of_track[seen.track_id].push_back(i);
  }
  double sum = 0;
  int num_ended = 0;
  for (const auto& [track, frames] : frames_of_track) {
    EXPECT_EQ(frames.back() - frames.front() + 1, static_cast<int>(frames.size())) << track;
    if (frames.back() == 199) continue;
    sum += frames.size();
    ++num_ended;
  }
  EXPECT_NEAR(sum / num_ended, 6, 0.3);
}

TEST(ObservationSimulator, LandmarksAreSeenAgainWhenTheCameraComesBack) {
  std::vector<Rigid3> path;
  constexpr int kLap = 200;
  for (int i = 0; i < 2 * kLap; ++i) {  // two laps of a circle of 30 m, heading along it
    const double angle = 2 * M_PI * i / kLap;
    path.emplace_back(ExpSO3({0, angle, 0}),
                      Eigen::Vector3d(30 - 30 * std::cos(angle), 0, 30 * std::sin(angle)));
  }
  ObservationSimulator simulator(kCamera, path);
  std::map<int, std::set<int>> tracks_in_first_lap;
  int num_returned = 0, num_in_last = 0;
  for (int i = 0; const auto frame = simulator.Next(); ++i) {
    for (const SimulatedObservation& seen : frame->observations) {
      if (i < kLap / 2) tracks_in_first_lap[seen.landmark_id].insert(seen.track_id);
      if (i != kLap + kLap / 4) continue;
      ++num_in_last;
      const auto before = tracks_in_first_lap.find(seen.landmark_id);
      if (before == tracks_in_first_lap.end()) continue;
      ++num_returned;
      EXPECT_EQ(before->second.count(seen.track_id), 0u);
    }
  }
  EXPECT_GT(num_returned, num_in_last / 2);
}

TEST(ObservationSimulator, FollowsARealPathOfThousandsOfFrames) {
  const std::string file = FindShared("data/kitti/ground_truth_poses/00.txt");
  if (file.empty()) GTEST_SKIP() << "needs the shared data: kitti/ground_truth_poses/00.txt";
  ObservationSimulator simulator(kCamera, ReadKittiPoses(file));
  int num_full = 0;
  while (const auto frame = simulator.Next()) num_full += frame->observations.size() == 300;
  EXPECT_EQ(num_full, 4541);
}

}  // namespace
}  // namespace arfm_vo
