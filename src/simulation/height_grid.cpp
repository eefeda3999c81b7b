#include "arfm_vo/simulation/height_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arfm_vo/base/check.h"
#include "arfm_vo/simulation/parallel_rows.h"

namespace arfm_vo {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The smallest s in [0, length] with a s^2 + b s + c <= 0, or infinity.
double FirstNonPositive(double a, double b, double c, double length) {
  if (c <= 0) return 0;
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return kInfinity;
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  double first = kInfinity;
  for (const double root : {q / a, c / q}) {
    if (root >= 0 && root <= length) first = std::min(first, root);
  }
  return first;
}

/// Where a ray in grid coordinates (cells, and metres upward) meets the bilinear patch (i, j)
/// within [begin, end].
double IntersectPatch(const Raster& heights, const Ray& ray, int i, int j, double begin,
                      double end) {
  const double h00 = heights.At(i, j), h10 = heights.At(i + 1, j);
  const double h01 = heights.At(i, j + 1), h11 = heights.At(i + 1, j + 1);
  const double hu = h10 - h00, hv = h01 - h00, huv = h11 - h10 - h01 + h00;
  const Eigen::Vector3d p = ray.origin + begin * ray.direction;
  const Eigen::Vector3d& d = ray.direction;
  const double u = p.x() - i, v = p.y() - j;
  const double c = p.z() - (h00 + hu * u + hv * v + huv * u * v);
  const double b = d.z() - (hu * d.x() + hv * d.y() + huv * (u * d.y() + v * d.x()));
  return begin + FirstNonPositive(-huv * d.x() * d.y(), b, c, end - begin);
}

double SafeInverse(double x) { return std::abs(x) < 1e-30 ? 1e30 : 1 / x; }

}  // namespace

Raster::Raster(const Eigen::Vector2d& min_corner, double cell_m, int num_cells)
    : min_corner_(min_corner),
      cell_m_(cell_m),
      cells_per_m_(1 / cell_m),
      num_cells_(num_cells),
      nodes_(num_cells + 1, num_cells + 1) {}

void Raster::Fill(int num_threads, const std::function<double(double, double)>& value) {
  ForEachRow(num_cells_ + 1, num_threads, [&](int j) {
    for (int i = 0; i <= num_cells_; ++i) {
      nodes_(i, j) = value(min_corner_.x() + i * cell_m_, min_corner_.y() + j * cell_m_);
    }
  });
}

double Raster::Sample(double x, double y) const {
  const double gx = std::clamp((x - min_corner_.x()) * cells_per_m_, 0.0, double(num_cells_));
  const double gy = std::clamp((y - min_corner_.y()) * cells_per_m_, 0.0, double(num_cells_));
  const int i = std::min(static_cast<int>(gx), num_cells_ - 1);
  const int j = std::min(static_cast<int>(gy), num_cells_ - 1);
  const double u = gx - i, v = gy - j;
  const double low = At(i, j) + u * (At(i + 1, j) - At(i, j));
  const double high = At(i, j + 1) + u * (At(i + 1, j + 1) - At(i, j + 1));
  return low + v * (high - low);
}

bool Raster::Contains(double x, double y) const {
  const double side = cell_m_ * num_cells_;
  return x >= min_corner_.x() && y >= min_corner_.y() && x <= min_corner_.x() + side &&
         y <= min_corner_.y() + side;
}

HeightGrid::HeightGrid(Raster heights) : heights_(std::move(heights)) {
  const int size = heights_.num_cells();
  Require(size >= 1 && (size & (size - 1)) == 0, "height grid: cells must be a power of two");
  const Eigen::ArrayXXf& nodes = heights_.nodes();
  max_heights_.push_back(nodes.topLeftCorner(size, size)
                             .max(nodes.bottomLeftCorner(size, size))
                             .max(nodes.topRightCorner(size, size))
                             .max(nodes.bottomRightCorner(size, size)));
  for (int side = size / 2; side >= 1; side /= 2) {
    const Eigen::ArrayXXf& fine = max_heights_.back();
    Eigen::ArrayXXf coarse = Eigen::ArrayXXf::NullaryExpr(
        side, side,
        [&](Eigen::Index i, Eigen::Index j) { return fine.block<2, 2>(2 * i, 2 * j).maxCoeff(); });
    max_heights_.push_back(std::move(coarse));
  }
}

Eigen::Vector3d HeightGrid::Normal(double x, double y) const {
  const double step = heights_.cell_m();
  return Eigen::Vector3d(Height(x - step, y) - Height(x + step, y),
                         Height(x, y - step) - Height(x, y + step), 2 * step)
      .normalized();
}

bool HeightGrid::ClipToSquare(const Ray& ray, double& begin, double& end) const {
  const double side = heights_.cell_m() * heights_.num_cells();
  for (int axis = 0; axis < 2; ++axis) {
    const double inverse = SafeInverse(ray.direction[axis]);
    const double to_low = (heights_.min_corner()[axis] - ray.origin[axis]) * inverse;
    const double to_high = to_low + side * inverse;
    begin = std::max(begin, std::min(to_low, to_high));
    end = std::min(end, std::max(to_low, to_high));
  }
  return begin <= end;
}

double HeightGrid::Intersect(const Ray& world_ray, double begin, double end) const {
  if (!ClipToSquare(world_ray, begin, end)) return kInfinity;
  Ray ray = world_ray;
  ray.origin.head<2>() = (ray.origin.head<2>() - heights_.min_corner()) / heights_.cell_m();
  ray.direction.head<2>() /= heights_.cell_m();
  if (ray.direction.z() > 0) {
    end = std::min(end, (max_heights_.back()(0, 0) - ray.origin.z()) / ray.direction.z());
  }
  const double inverse_x = SafeInverse(ray.direction.x());
  const double inverse_y = SafeInverse(ray.direction.y());
  // A step past a border that is certainly seen in double precision: 1e-7 cells.
  const double nudge = 1e-7 * std::min(std::abs(inverse_x), std::abs(inverse_y));
  const int size = heights_.num_cells(), top = static_cast<int>(max_heights_.size()) - 1;
  const int ahead_x = inverse_x > 0, ahead_y = inverse_y > 0;
  int level = std::min(top, 4);
  for (double z = begin; z <= end;) {
    const Eigen::Vector3d p = ray.origin + z * ray.direction;
    const int i = std::clamp(static_cast<int>(p.x()), 0, size - 1) >> level;
    const int j = std::clamp(static_cast<int>(p.y()), 0, size - 1) >> level;
    const double exit_x = (((i + ahead_x) << level) - ray.origin.x()) * inverse_x;
    const double exit_y = (((j + ahead_y) << level) - ray.origin.y()) * inverse_y;
    const double exit = std::min(std::max(z, std::min(exit_x, exit_y)), end);
    const double lowest = ray.direction.z() < 0 ? ray.origin.z() + exit * ray.direction.z() : p.z();
    if (lowest <= max_heights_[level](i, j)) {
      if (level > 0) {
        --level;
        continue;
      }
      const double hit = IntersectPatch(heights_, ray, i, j, z, exit);
      if (hit < kInfinity) return hit;
    }
    // Up a level only on leaving the parent cell: no step is taken twice.
    const int next = exit_x < exit_y ? i + ahead_x : j + ahead_y;
    if ((next & 1) == 0 && level < top) ++level;
    z = exit + nudge;
  }
  return kInfinity;
}

}  // namespace arfm_vo
