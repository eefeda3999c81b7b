#include "arfm_vo/simulation/board_renderer.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "arfm_vo/simulation/parallel_rows.h"

namespace arfm_vo {
namespace {

constexpr double kBlack = 0.06, kWhite = 0.8, kBackground = 0.3;

/// A convex polygon of at most 8 corners (a quadrilateral cut by a rectangle).
struct Polygon {
  std::array<Eigen::Vector2d, 8> corners;
  int size = 0;

  void Add(const Eigen::Vector2d& corner) { corners[size++] = corner; }
  double Area() const {
    double twice = 0;
    for (int i = 0; i < size; ++i) {
      const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % size];
      twice += a.x() * b.y() - a.y() * b.x();
    }
    return std::abs(twice) / 2;
  }
};

/// The part of a polygon with sign * x[axis] <= sign * limit (Sutherland and Hodgman 1974).
Polygon Clip(const Polygon& polygon, int axis, double sign, double limit) {
  Polygon kept;
  for (int i = 0; i < polygon.size; ++i) {
    const Eigen::Vector2d& a = polygon.corners[i];
    const Eigen::Vector2d& b = polygon.corners[(i + 1) % polygon.size];
    const double beyond_a = sign * (a[axis] - limit), beyond_b = sign * (b[axis] - limit);
    if (beyond_a <= 0) kept.Add(a);
    if ((beyond_a < 0 && beyond_b > 0) || (beyond_a > 0 && beyond_b < 0)) {
      kept.Add(a + (b - a) * (beyond_a / (beyond_a - beyond_b)));
    }
  }
  return kept;
}

}  // namespace

/// Where the corners of a pixel lie on the board, in squares; the board's own squares are those
/// with indices -1 .. columns - 1 and -1 .. rows - 1.
struct BoardRenderer::PixelOnBoard {
  std::array<Eigen::Vector2d, 4> corners;
};

void DistortedCamera::Check() const {
  Require(fx > 0 && fy > 0, "distorted camera: focal lengths must be positive");
  Require(width >= 1 && height >= 1, "distorted camera: width and height must be positive");
  for (const double value : {fx, fy, cx, cy, k1, k2, p1, p2, k3}) {
    Require(std::isfinite(value), "distorted camera: a value is not finite");
  }
}

Eigen::Vector2d DistortedCamera::Project(const Eigen::Vector2d& n) const {
  const double x = n.x(), y = n.y(), r2 = n.squaredNorm();
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {fx * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)) + cx,
          fy * (y * radial + 2 * p2 * x * y + p1 * (r2 + 2 * y * y)) + cy};
}

Eigen::Vector2d DistortedCamera::Unproject(const Eigen::Vector2d& pixel) const {
  constexpr double kStep = 1e-6;
  Eigen::Vector2d n((pixel.x() - cx) / fx, (pixel.y() - cy) / fy);
  for (int iteration = 0; iteration < 20; ++iteration) {
    const Eigen::Vector2d error = Project(n) - pixel;
    if (error.squaredNorm() < 1e-22) break;
    Eigen::Matrix2d jacobian;
    jacobian.col(0) = (Project(n + Eigen::Vector2d(kStep, 0)) - error - pixel) / kStep;
    jacobian.col(1) = (Project(n + Eigen::Vector2d(0, kStep)) - error - pixel) / kStep;
    n -= jacobian.inverse() * error;
  }
  return n;
}

void BoardPattern::Check() const {
  Require(columns >= 2 && rows >= 2, "board: needs at least 2 x 2 inner corners");
  Require(square_m > 0, "board: square_m must be positive");
}

BoardRenderer::BoardRenderer(const DistortedCamera& camera, const BoardPattern& pattern)
    : camera_(camera), pattern_(pattern) {
  camera.Check();
  pattern.Check();
  rays_.reserve(static_cast<size_t>(camera.width + 1) * (camera.height + 1));
  for (int v = 0; v <= camera.height; ++v) {
    for (int u = 0; u <= camera.width; ++u) {
      rays_.push_back(camera.Unproject({u - 0.5, v - 0.5}));
    }
  }
}

double BoardRenderer::Tone(int column, int row) const {
  if (column < -2 || row < -2 || column > pattern_.columns || row > pattern_.rows) {
    return kBackground;
  }
  const bool is_border =
      column == -2 || row == -2 || column == pattern_.columns || row == pattern_.rows;
  return is_border || (column + row) % 2 != 0 ? kWhite : kBlack;
}

double BoardRenderer::MeanOverPixel(const PixelOnBoard& pixel) const {
  Eigen::Vector2d low = pixel.corners[0], high = low;
  Polygon whole;
  for (const Eigen::Vector2d& corner : pixel.corners) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
    whole.Add(corner);
  }
  const auto cell = [](double x) { return static_cast<int>(std::floor(std::clamp(x, -9.0, 1e4))); };
  const int low_i = cell(low.x()), high_i = cell(high.x());
  const int low_j = cell(low.y()), high_j = cell(high.y());
  if ((low_i == high_i && low_j == high_j) || high_i < -2 || high_j < -2 ||
      low_i > pattern_.columns || low_j > pattern_.rows || high_i - low_i > 50 ||
      high_j - low_j > 50) {
    return Tone(low_i, low_j);
  }
  const double area = whole.Area();
  double sum = 0;
  for (int i = low_i; i <= high_i; ++i) {
    const Polygon column = Clip(Clip(whole, 0, 1, i + 1), 0, -1, i);
    for (int j = low_j; j <= high_j; ++j) {
      sum += Tone(i, j) * Clip(Clip(column, 1, 1, j + 1), 1, -1, j).Area();
    }
  }
  return sum / area;
}

cv::Mat BoardRenderer::Trace(const Rigid3& camera_from_board, int num_threads) const {
  Require(camera_from_board.IsFinite(), "board: its pose is not finite");
  // board_from_ray * (x, y, 1) is the point on the board's plane, up to scale.
  Eigen::Matrix3d ray_from_board = camera_from_board.RotationMatrix();
  ray_from_board.leftCols<2>() *= pattern_.square_m;
  ray_from_board.col(2) = camera_from_board.translation;
  const Eigen::Matrix3d board_from_ray = ray_from_board.inverse();
  const double facing = std::abs(camera_from_board.RotationMatrix()(2, 2));
  cv::Mat radiance(camera_.height, camera_.width, CV_32FC1);
  ForEachRow(camera_.height, num_threads, [&](int v) {
    for (int u = 0; u < camera_.width; ++u) {
      PixelOnBoard pixel;
      double nearest = 1e9;  // 1 / depth in units of the scale; not positive behind the camera
      constexpr int kAround[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
      for (int k = 0; k < 4; ++k) {
        const size_t at = static_cast<size_t>(v + kAround[k][1]) * (camera_.width + 1) + u;
        const Eigen::Vector2d& ray = rays_[at + kAround[k][0]];
        const Eigen::Vector3d q = board_from_ray * Eigen::Vector3d(ray.x(), ray.y(), 1);
        pixel.corners[k] = q.head<2>() / q.z();
        nearest = std::min(nearest, q.z());
      }
      // The board is lit from the camera's side, a little unevenly; the room behind is even.
      const double light = (0.75 + 0.25 * facing) * (0.9 + 0.1 * u / camera_.width);
      radiance.at<float>(v, u) = light * (nearest > 1e-9 ? MeanOverPixel(pixel) : kBackground);
    }
  });
  return radiance;
}

cv::Mat BoardRenderer::Render(const Rigid3& camera_from_board, const SensorOptions& sensor,
                              uint32_t image_id, int num_threads) const {
  return ExposeImage(Trace(camera_from_board, num_threads), sensor, image_id);
}

}  // namespace arfm_vo
