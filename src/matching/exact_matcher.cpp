#include "arfm_vo/matching/exact_matcher.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core/utility.hpp>

#include "exact_kernel.h"

namespace arfm_vo {
namespace {

/// The keypoints of one image that may match those of the same group in the other.
using Group = std::vector<int>;

bool IsFinite(const float* descriptor) {
  float sum = 0;
  for (int k = 0; k < kDescriptorSize; ++k) sum += descriptor[k];
  return std::isfinite(sum);
}

/// Dark blobs on bright ground, and bright ones on dark.
std::array<Group, 2> SplitIntoGroups(const Features& features) {
  std::array<Group, 2> groups;
  for (int i = 0; i < features.size(); ++i) {
    if (!IsFinite(features.descriptors.ptr<float>(i))) continue;
    const bool is_dark = features.keypoints[i].laplacian_sign > 0;
    groups[is_dark].push_back(i);
  }
  return groups;
}

/// The state of one ScoreSpans.
struct Scores {
  std::vector<float> best, second;
  std::vector<int32_t> index;

  explicit Scores(size_t size) : best(size), second(size), index(size) {}
  ScoreSpans Spans() { return {best.data(), second.data(), index.data()}; }
};

std::vector<float> PackPanels(const cv::Mat& descriptors, const Group& group) {
  const size_t num_panels = (group.size() + kPanelColumns - 1) / kPanelColumns;
  std::vector<float> panels(num_panels * kPanelColumns * kDescriptorSize);
  for (size_t i = 0; i < group.size(); ++i) {
    const float* from = descriptors.ptr<float>(group[i]);
    float* to = &panels[i / kPanelColumns * kPanelColumns * kDescriptorSize + i % kPanelColumns];
    for (int k = 0; k < kDescriptorSize; ++k) to[k * kPanelColumns] = from[k];
  }
  return panels;
}

float SquaredDistance(float score) {
  return score > kNoScore / 2 ? std::max(0.0f, 2 - 2 * score) : Neighbours::kNone;
}

void Scatter(const Scores& scores, const Group& from, const Group& to,
             std::vector<Neighbours>& neighbours) {
  for (size_t i = 0; i < from.size(); ++i) {
    if (scores.index[i] < 0) continue;
    neighbours[from[i]] = {to[scores.index[i]], SquaredDistance(scores.best[i]),
                           SquaredDistance(scores.second[i])};
  }
}

void SearchGroup(const cv::Mat& first, const Group& first_group, const cv::Mat& second,
                 const Group& second_group, TwoWayNeighbours& neighbours) {
  if (first_group.empty() || second_group.empty()) return;
  std::vector<const float*> rows;
  for (const int i : first_group) rows.push_back(first.ptr<float>(i));
  const std::vector<float> panels = PackPanels(second, second_group);
  Scores of_rows(rows.size());
  Scores of_columns(panels.size() / kDescriptorSize);
  const ExactSearch search{rows.data(),     static_cast<int>(rows.size()),
                           panels.data(),   static_cast<int>(second_group.size()),
                           of_rows.Spans(), of_columns.Spans()};
  static const bool can_search_avx2 = CanSearchExactlyAvx2();
  if (can_search_avx2) {
    SearchExactlyAvx2(search);
  } else {
    SearchExactlyBaseline(search);
  }
  Scatter(of_rows, first_group, second_group, neighbours.of_first);
  Scatter(of_columns, second_group, first_group, neighbours.of_second);
}

}  // namespace

TwoWayNeighbours FindNeighboursExactly(const Features& first, const Features& second) {
  CheckDescriptors(first.descriptors, first.keypoints.size(), "the first image");
  CheckDescriptors(second.descriptors, second.keypoints.size(), "the second image");
  TwoWayNeighbours neighbours;
  neighbours.of_first.resize(first.size());
  neighbours.of_second.resize(second.size());
  const auto first_groups = SplitIntoGroups(first);
  const auto second_groups = SplitIntoGroups(second);
  // The groups are disjoint, so that threads write to different elements.
  cv::parallel_for_(cv::Range(0, static_cast<int>(first_groups.size())), [&](const cv::Range& r) {
    for (int g = r.start; g < r.end; ++g) {
      SearchGroup(first.descriptors, first_groups[g], second.descriptors, second_groups[g],
                  neighbours);
    }
  });
  return neighbours;
}

}  // namespace arfm_vo
