#include "arfm_vo/features/keypoint_budget.h"

#include <algorithm>
#include <tuple>

namespace arfm_vo {
namespace {

bool IsStronger(const ScaleSpaceMaximum& a, const ScaleSpaceMaximum& b) {
  return std::tie(b.response, a.y, a.x, a.octave, a.layer) <
         std::tie(a.response, b.y, b.x, b.octave, b.layer);
}

bool IsAbove(const ScaleSpaceMaximum& a, const ScaleSpaceMaximum& b) {
  return std::tie(a.y, a.x, a.octave, a.layer) < std::tie(b.y, b.x, b.octave, b.layer);
}

/// A maximum and its place among those of its cell, 0 for the strongest.
struct RankedMaximum {
  ScaleSpaceMaximum maximum;
  int rank = 0;
};

}  // namespace

std::vector<ScaleSpaceMaximum> SelectSpread(const std::vector<ScaleSpaceMaximum>& maxima, int rows,
                                            int cols, int target, int bucket_px) {
  std::vector<ScaleSpaceMaximum> strongest = maxima;
  std::sort(strongest.begin(), strongest.end(), IsStronger);
  const int cell_px = bucket_px > 0 ? bucket_px : std::max(rows, cols);
  const int cells_across = (cols + cell_px - 1) / cell_px;
  std::vector<int> num_in_cell(cells_across * ((rows + cell_px - 1) / cell_px), 0);
  std::vector<RankedMaximum> ranked;
  ranked.reserve(strongest.size());
  for (const ScaleSpaceMaximum& maximum : strongest) {
    int& num = num_in_cell[maximum.y / cell_px * cells_across + maximum.x / cell_px];
    ranked.push_back({maximum, num++});
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const RankedMaximum& a, const RankedMaximum& b) { return a.rank < b.rank; });
  if (static_cast<int>(ranked.size()) > target) ranked.resize(target);
  std::vector<ScaleSpaceMaximum> selected;
  selected.reserve(ranked.size());
  for (const RankedMaximum& entry : ranked) selected.push_back(entry.maximum);
  std::sort(selected.begin(), selected.end(), IsAbove);
  return selected;
}

}  // namespace arfm_vo
