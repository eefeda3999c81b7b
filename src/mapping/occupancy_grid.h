#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace arfm_vo {

/// The picture in square cells: which pixels are taken, and how many points each cell holds.
class OccupancyGrid {
 public:
  OccupancyGrid(int width, int height, int cell_px, double separation_px)
      : cell_px_(cell_px),
        separation_px_(separation_px),
        columns_(width / cell_px + 1),
        rows_(height / cell_px + 1),
        cells_(static_cast<size_t>(columns_) * rows_) {}

  int Count(double u, double v) const { return static_cast<int>(cells_[Cell(u, v)].size()); }
  void Add(double u, double v) { cells_[Cell(u, v)].push_back({u, v}); }

  bool IsFree(double u, double v) const {
    for (int row = Row(v - separation_px_); row <= Row(v + separation_px_); ++row) {
      for (int column = Column(u - separation_px_); column <= Column(u + separation_px_);
           ++column) {
        for (const Eigen::Vector2d& taken : cells_[row * columns_ + column]) {
          const double du = taken.x() - u, dv = taken.y() - v;
          if (du * du + dv * dv < separation_px_ * separation_px_) return false;
        }
      }
    }
    return true;
  }

 private:
  int Column(double u) const { return std::clamp(static_cast<int>(u) / cell_px_, 0, columns_ - 1); }
  int Row(double v) const { return std::clamp(static_cast<int>(v) / cell_px_, 0, rows_ - 1); }
  size_t Cell(double u, double v) const { return Row(v) * columns_ + Column(u); }

  int cell_px_;
  double separation_px_;
  int columns_, rows_;
  std::vector<std::vector<Eigen::Vector2d>> cells_;
};

}  // namespace arfm_vo
