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
        cells_(static_cast<size_t>(columns_) * (height / cell_px + 1)) {}

  int Count(double u, double v) const { return static_cast<int>(cells_[Cell(u, v)].size()); }
  void Add(double u, double v) { cells_[Cell(u, v)].push_back({u, v}); }

  bool IsFree(double u, double v) const {
    for (const double du : {-separation_px_, 0.0, separation_px_}) {
      for (const double dv : {-separation_px_, 0.0, separation_px_}) {
        for (const Eigen::Vector2d& taken : cells_[Cell(u + du, v + dv)]) {
          if ((taken - Eigen::Vector2d(u, v)).norm() < separation_px_) return false;
        }
      }
    }
    return true;
  }

 private:
  size_t Cell(double u, double v) const {
    const int column = std::clamp(static_cast<int>(u) / cell_px_, 0, columns_ - 1);
    const int rows = static_cast<int>(cells_.size()) / columns_;
    const int row = std::clamp(static_cast<int>(v) / cell_px_, 0, rows - 1);
    return static_cast<size_t>(row) * columns_ + column;
  }

  int cell_px_;
  double separation_px_;
  int columns_;
  std::vector<std::vector<Eigen::Vector2d>> cells_;
};

}  // namespace arfm_vo
