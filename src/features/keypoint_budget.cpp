#include "arfm_vo/features/keypoint_budget.h"

#include <algorithm>
#include <tuple>

namespace arfm_vo {
namespace {

bool IsStronger(const ScaleSpaceMaximum& a, const ScaleSpaceMaximum& b) {
  return std::tie(b.response, a.y, a.x, a.octave, a.layer) <
         std::tie(a.response, b.y, b.x, b.octave, b.layer);
}

/// A maximum and its place among those of its cell, 0 for the strongest.
struct RankedMaximum {
  ScaleSpaceMaximum maximum;
  int rank = 0;
};

}  // namespace

void KeepStrongest(size_t num, std::vector<ScaleSpaceMaximum>& maxima) {
  if (maxima.size() <= num) return;
  std::nth_element(maxima.begin(), maxima.begin() + static_cast<std::ptrdiff_t>(num), maxima.end(),
                   IsStronger);
  maxima.resize(num);
}

std::vector<ScaleSpaceMaximum> RankSpread(const std::vector<ScaleSpaceMaximum>& maxima, int rows,
                                          int cols, int bucket_px) {
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
  for (size_t i = 0; i < ranked.size(); ++i) strongest[i] = ranked[i].maximum;
  return strongest;
}

}  // namespace arfm_vo
