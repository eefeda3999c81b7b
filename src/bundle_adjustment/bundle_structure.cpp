#include "bundle_structure.h"

#include <algorithm>

namespace arfm_vo {

BundleStructure::BundleStructure(const BundleProblem& problem, const BundleSelection& selection)
    : free_pose(problem.camera_from_world.size(), kFixed) {
  for (size_t i = 0; i < free_pose.size(); ++i) {
    if (!selection.pose_is_free[i]) continue;
    free_pose[i] = num_free_poses();
    pose_of_free.push_back(static_cast<int>(i));
  }
  SortObservations(problem, selection);
  FindTracks();
  FindBlocks(problem);
}

void BundleStructure::SortObservations(const BundleProblem& problem,
                                       const BundleSelection& selection) {
  // Counting sort by point, then each point's few by pose.
  std::vector<int> begin(problem.points.size() + 1, 0);
  for (size_t i = 0; i < problem.observations.size(); ++i) {
    if (selection.observation_is_used[i]) ++begin[problem.observations[i].point + 1];
  }
  for (size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  observations.resize(begin.back());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (size_t i = 0; i < problem.observations.size(); ++i) {
    if (!selection.observation_is_used[i]) continue;
    observations[next[problem.observations[i].point]++] = problem.observations[i];
  }
  const auto by_pose = [](const BundleObservation& a, const BundleObservation& b) {
    return a.pose < b.pose;
  };
  for (size_t i = 0; i + 1 < begin.size(); ++i) {
    const auto first = observations.begin() + begin[i], last = observations.begin() + begin[i + 1];
    if (!std::is_sorted(first, last, by_pose)) std::stable_sort(first, last, by_pose);
  }
}

void BundleStructure::FindTracks() {
  const int num_observations = static_cast<int>(observations.size());
  sightings.reserve(observations.size());
  for (int i = 0; i < num_observations; ++i) {
    const BundleObservation& observation = observations[i];
    const bool is_new_point = i == 0 || observation.point != observations[i - 1].point;
    if (is_new_point) {
      const int first = static_cast<int>(sightings.size());
      tracks.push_back({observation.point, first, first});
    }
    if (is_new_point || observation.pose != observations[i - 1].pose) {
      sightings.push_back({observation.pose, free_pose[observation.pose], i, i});
      ++tracks.back().last;
    }
    ++sightings.back().last;
  }
}

void BundleStructure::FindBlocks(const BundleProblem& problem) {
  // For each free pose in turn, those it shares a point with.
  std::vector<std::vector<int>> tracks_of(num_free_poses()), tied_to(num_free_poses());
  for (int i = 0; i < static_cast<int>(tracks.size()); ++i) {
    for (int k = tracks[i].first; k < tracks[i].last; ++k) {
      if (sightings[k].free_pose != kFixed) tracks_of[sightings[k].free_pose].push_back(i);
    }
  }
  for (const PoseConstraint& constraint : problem.constraints) {
    const int a = free_pose[constraint.first], b = free_pose[constraint.second];
    if (a != kFixed && b != kFixed) tied_to[std::min(a, b)].push_back(std::max(a, b));
  }
  std::vector<int> seen_by(num_free_poses(), kFixed);
  for (int row = 0; row < num_free_poses(); ++row) {
    const auto add = [&](int column) {
      if (column < row || seen_by[column] == row) return;
      seen_by[column] = row;
      blocks.columns.push_back(column);
    };
    add(row);
    for (const int track : tracks_of[row]) {
      for (int k = tracks[track].first; k < tracks[track].last; ++k) add(sightings[k].free_pose);
    }
    for (const int column : tied_to[row]) add(column);
    std::sort(blocks.columns.begin() + blocks.row_begin.back(), blocks.columns.end());
    blocks.row_begin.push_back(static_cast<int>(blocks.columns.size()));
  }
}

}  // namespace arfm_vo
