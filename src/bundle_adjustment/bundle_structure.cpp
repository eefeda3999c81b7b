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
  const auto is_repeated = [](const BundleObservation& a, const BundleObservation& b) {
    return a.point == b.point && a.pose == b.pose;
  };
  observations.erase(std::unique(observations.begin(), observations.end(), is_repeated),
                     observations.end());
}

void BundleStructure::FindTracks() {
  for (int i = 0; i < static_cast<int>(observations.size()); ++i) {
    const int point = observations[i].point;
    if (i == 0 || point != observations[i - 1].point) tracks.push_back({point, i, i});
    ++tracks.back().last;
  }
}

void BundleStructure::FindBlocks(const BundleProblem& problem) {
  std::vector<std::vector<int>> tied_to(num_free_poses());
  const auto tie = [&](int a, int b) {
    if (a != kFixed && b != kFixed) tied_to[std::min(a, b)].push_back(std::max(a, b));
  };
  for (const Track& track : tracks)
    for (int i = track.first; i < track.last; ++i)
      for (int j = i + 1; j < track.last; ++j) tie(FreePose(i), FreePose(j));
  for (const PoseConstraint& constraint : problem.constraints)
    tie(free_pose[constraint.first], free_pose[constraint.second]);
  blocks = BlockPattern(std::move(tied_to));
}

}  // namespace arfm_vo
