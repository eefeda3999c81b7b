#pragma once

#include <algorithm>
#include <vector>

#include "arfm_vo/features/features.h"

namespace arfm_vo {

/// Keypoints sorted into the cells of a grid, so that those near a place are found at once.
class KeypointGrid {
 public:
  KeypointGrid(const std::vector<Keypoint>& keypoints, float cell_width, float cell_height)
      : cell_width_(cell_width), cell_height_(cell_height) {
    float max_x = 0, max_y = 0;
    for (const Keypoint& keypoint : keypoints) {
      max_x = std::max(max_x, keypoint.x);
      max_y = std::max(max_y, keypoint.y);
    }
    columns_ = static_cast<int>(max_x / cell_width_) + 1;
    rows_ = static_cast<int>(max_y / cell_height_) + 1;
    begins_.assign(columns_ * rows_ + 1, 0);
    std::vector<int> cells(keypoints.size());
    for (size_t i = 0; i < keypoints.size(); ++i) {
      cells[i] = Row(keypoints[i].y) * columns_ + Column(keypoints[i].x);
      ++begins_[cells[i] + 1];
    }
    for (size_t cell = 1; cell < begins_.size(); ++cell) begins_[cell] += begins_[cell - 1];
    sorted_.resize(keypoints.size());
    std::vector<int> next(begins_.begin(), begins_.end() - 1);
    for (size_t i = 0; i < keypoints.size(); ++i) sorted_[next[cells[i]]++] = static_cast<int>(i);
  }

  /// Calls visit(index) for every keypoint in the cells that the rectangle touches.
  template <class Visit>
  void VisitCells(float min_x, float max_x, float min_y, float max_y, Visit&& visit) const {
    if (!(max_x >= 0 && max_y >= 0)) return;
    const int first_column = Column(min_x), last_column = Column(max_x);
    for (int row = Row(min_y); row <= Row(max_y); ++row) {
      const int end = begins_[row * columns_ + last_column + 1];
      for (int i = begins_[row * columns_ + first_column]; i < end; ++i) visit(sorted_[i]);
    }
  }

 private:
  static int Cell(float position, float size, int count) {
    return static_cast<int>(std::clamp(position / size, 0.0f, static_cast<float>(count - 1)));
  }
  int Column(float x) const { return Cell(x, cell_width_, columns_); }
  int Row(float y) const { return Cell(y, cell_height_, rows_); }

  float cell_width_, cell_height_;
  int columns_, rows_;
  std::vector<int> begins_;  ///< [cells + 1], into sorted_
  std::vector<int> sorted_;
};

}  // namespace arfm_vo
