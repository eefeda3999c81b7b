#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace arfm_vo {

/// A square raster of values at nodes `cell_m` apart, bilinear in between and held beyond its edge.
class Raster {
 public:
  Raster() = default;
  /// `num_cells` cells along each side from the corner `min_corner`; [num_cells + 1]^2 nodes.
  Raster(const Eigen::Vector2d& min_corner, double cell_m, int num_cells);
  /// Sets every node to value(x, y).
  void Fill(int num_threads, const std::function<double(double, double)>& value);

  double Sample(double x, double y) const;
  bool Contains(double x, double y) const;

  const Eigen::Vector2d& min_corner() const { return min_corner_; }
  double cell_m() const { return cell_m_; }
  int num_cells() const { return num_cells_; }
  float At(int i, int j) const { return nodes_(i, j); }
  const Eigen::ArrayXXf& nodes() const { return nodes_; }

 private:
  Eigen::Vector2d min_corner_ = Eigen::Vector2d::Zero();
  double cell_m_ = 1, cells_per_m_ = 1;
  int num_cells_ = 0;
  Eigen::ArrayXXf nodes_;  ///< (x, y)
};

/// A ray x(z) = origin + z * direction; the direction need not be a unit vector.
struct Ray {
  Eigen::Vector3d origin, direction;
};

/// A height field z = h(x, y) that rays are cut with exactly (bilinear patches), by a pyramid of
/// maximum heights (Tevs, Ihrke, Seidel 2008).
class HeightGrid {
 public:
  HeightGrid() = default;
  /// `heights` must have a power of two of cells.
  explicit HeightGrid(Raster heights);

  double Height(double x, double y) const { return heights_.Sample(x, y); }
  /// The upward unit normal, smooth across cells.
  Eigen::Vector3d Normal(double x, double y) const;
  bool Contains(double x, double y) const { return heights_.Contains(x, y); }
  /// The smallest parameter in [begin, end] at which the ray is within the grid's square and not
  /// above the surface; infinity where there is none.
  double Intersect(const Ray& ray, double begin, double end) const;
  /// Clips [begin, end] to the part of the ray over the grid's square; false where none is left.
  bool ClipToSquare(const Ray& ray, double& begin, double& end) const;
  const Raster& heights() const { return heights_; }

 private:
  Raster heights_;
  std::vector<Eigen::ArrayXXf> max_heights_;  ///< level k: cells of 2^k x 2^k patches
};

}  // namespace arfm_vo
