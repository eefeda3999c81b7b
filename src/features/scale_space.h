#pragma once

#include <algorithm>
#include <opencv2/core/mat.hpp>

#include "arfm_vo/features/box_hessian.h"

namespace arfm_vo {

/// The samples of a layer at which a maximum is looked for: where the next larger filter fits.
struct SearchRange {
  int first = 0;                 ///< row and column
  int end_row = 0, end_col = 0;  ///< one past the last

  SearchRange(int octave, int layer, int step, int width, int height) {
    const int margin = BoxFilterSize(octave, layer + 1) / 2 + step;
    first = (margin + step - 1) / step;
    end_row = std::max(0, (height - margin + step - 1) / step);
    end_col = std::max(0, (width - margin + step - 1) / step);
  }
};

/// Greater than all 26 neighbours in three layers; of equal neighbours the first in order of layer,
/// row and column wins, so that a plateau gives one maximum.
inline bool IsMaximum(const cv::Mat_<float>* layers, int row, int col) {
  const float centre = layers[1](row, col);
  for (int layer = 0; layer < 3; ++layer) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const int order = 9 * (layer - 1) + 3 * dy + dx;
        const float other = layers[layer](row + dy, col + dx);
        if (order < 0 ? other >= centre : order > 0 && other > centre) return false;
      }
    }
  }
  return true;
}

}  // namespace arfm_vo
