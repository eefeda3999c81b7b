#include "arfm_vo/simulation/rock_field.h"

#include <algorithm>
#include <cmath>

#include "arfm_vo/base/range_check.h"
#include "arfm_vo/simulation/hash_noise.h"

namespace arfm_vo {
namespace {

constexpr double kCell = 2.0;         ///< m, of placing
constexpr double kShadowCell = 0.4;   ///< m, of the shadow lists
constexpr double kShadowReach = 2.0;  ///< shadows on falling ground are longer than on level ground

/// Repeatable draws for one rock.
struct Draw {
  uint32_t word;
  double operator()(int what) const { return HashUnit(word + 0x9e3779b9u * (what + 1)); }
  double operator()(int what, double low, double high) const {
    return low + (high - low) * (*this)(what);
  }
};

double DrawRadius(const RockOptions& options, double unit) {
  // Inverse of the truncated power law's distribution.
  const double rarest = std::pow(options.max_radius_m / options.min_radius_m, -options.power);
  return options.min_radius_m * std::pow(1 - unit * (1 - rarest), -1 / options.power);
}

/// An angular rock: an ellipsoid with flat faces cut off, part of it in the ground.
Solid MakeRock(const Draw& draw, const Eigen::Vector3d& ground, double radius, double flatness) {
  Solid rock;
  const Eigen::Vector3d axes(radius, radius * draw(10, 0.65, 1),
                             radius * flatness * draw(11, 0.7, 1.3));
  const Eigen::Quaterniond turn =
      Eigen::AngleAxisd(draw(12, 0, 2 * M_PI), Eigen::Vector3d::UnitZ()) *
      Eigen::AngleAxisd(draw(13, -0.35, 0.35), Eigen::Vector3d::UnitX()) *
      Eigen::AngleAxisd(draw(14, -0.35, 0.35), Eigen::Vector3d::UnitY());
  rock.body_from_world = turn.conjugate().toRotationMatrix();
  rock.unit_from_world = axes.cwiseInverse().asDiagonal() * rock.body_from_world;
  rock.center = ground + Eigen::Vector3d(0, 0, axes.z() * draw(15, -0.1, 0.45));
  rock.bounding_radius_m = axes.maxCoeff();
  const int num_planes = 5 + static_cast<int>(draw(16, 0, 4));
  for (int i = 0; i < num_planes; ++i) {
    const double azimuth = (i + draw(20 + 3 * i, -0.4, 0.4)) * 2 * M_PI / num_planes;
    const double height = draw(21 + 3 * i, -0.2, 0.9);
    const double across = std::sqrt(1 - height * height);
    rock.planes.emplace_back(across * std::cos(azimuth), across * std::sin(azimuth), height,
                             draw(22 + 3 * i, 0.6, 0.95));
  }
  rock.albedo = draw(17, 0.22, 0.5);
  rock.contrast = draw(18, 0.5, 1);
  rock.texture_offset_m = {draw(19, 0, 500), draw(9, 0, 500)};
  return rock;
}

}  // namespace

void RockOptions::Check() const {
  RequireInRange(density_per_m2, 0, 100, "rocks.density_per_m2");
  Require(min_radius_m > 0 && max_radius_m > min_radius_m,
          "rocks.max_radius_m must be above rocks.min_radius_m, and that above 0");
  Require(power > 0, "rocks.power must be positive");
  Require(flatness > 0, "rocks.flatness must be positive");
}

RockField::RockField(const RockOptions& options, const RockBed& bed, double side_m,
                     const Eigen::Vector3d& to_sun, uint32_t seed)
    : side_m_(side_m), to_sun_(to_sun) {
  options.Check();
  const int num_cells = static_cast<int>(std::floor(side_m / kCell));
  for (int j = 0; j < num_cells; ++j) {
    for (int i = 0; i < num_cells; ++i) FillCell(options, bed, i, j, seed);
  }
  shadow_side_ = std::max(1, static_cast<int>(std::ceil(side_m / kShadowCell)));
  shadow_rocks_.resize(static_cast<size_t>(shadow_side_) * shadow_side_);
  for (size_t i = 0; i < rocks_.size(); ++i) IndexShadow(static_cast<int>(i));
}

void RockField::FillCell(const RockOptions& options, const RockBed& bed, int i, int j,
                         uint32_t seed) {
  const uint32_t cell_word = HashCell(i, j, seed);
  const double expected = options.density_per_m2 * kCell * kCell;
  const int number = static_cast<int>(expected + HashUnit(cell_word));
  for (int k = 0; k < number; ++k) {
    const Draw draw{HashCell(k, 77, cell_word)};
    const double x = (i + draw(0)) * kCell - side_m_ / 2, y = (j + draw(1)) * kCell - side_m_ / 2;
    const double radius = DrawRadius(options, draw(2));
    if (draw(3) > bed.cover(x, y) || radius > bed.max_radius_m(x, y)) continue;
    rocks_.push_back(MakeRock(draw, {x, y, bed.height_m(x, y)}, radius, options.flatness));
  }
}

void RockField::IndexShadow(int index) {
  const Solid& rock = rocks_[index];
  const Eigen::Vector2d away = -to_sun_.head<2>();
  const double length =
      kShadowReach * 2 * rock.bounding_radius_m / std::max(to_sun_.z(), 0.05) * away.norm();
  const Eigen::Vector2d direction =
      away.norm() > 1e-9 ? Eigen::Vector2d(away.normalized()) : Eigen::Vector2d::UnitX();
  const double wide = rock.bounding_radius_m + kShadowCell * M_SQRT1_2;
  const Eigen::Vector2d start = rock.center.head<2>(), stop = start + length * direction;
  const auto cell_of = [&](double x) {
    return std::clamp(static_cast<int>((x + side_m_ / 2) / kShadowCell), 0, shadow_side_ - 1);
  };
  const int low_x = cell_of(std::min(start.x(), stop.x()) - wide);
  const int high_x = cell_of(std::max(start.x(), stop.x()) + wide);
  const int low_y = cell_of(std::min(start.y(), stop.y()) - wide);
  const int high_y = cell_of(std::max(start.y(), stop.y()) + wide);
  for (int j = low_y; j <= high_y; ++j) {
    for (int i = low_x; i <= high_x; ++i) {
      const Eigen::Vector2d offset = kShadowCell * Eigen::Vector2d(i + 0.5, j + 0.5) -
                                     Eigen::Vector2d::Constant(side_m_ / 2) - start;
      const double along = std::clamp(offset.dot(direction), 0.0, length);
      if ((offset - along * direction).norm() <= wide)
        shadow_rocks_[j * shadow_side_ + i].push_back(index);
    }
  }
}

bool RockField::IsShadowed(const Eigen::Vector3d& point) const {
  const int i = static_cast<int>(std::floor((point.x() + side_m_ / 2) / kShadowCell));
  const int j = static_cast<int>(std::floor((point.y() + side_m_ / 2) / kShadowCell));
  if (i < 0 || j < 0 || i >= shadow_side_ || j >= shadow_side_) return false;
  const std::vector<int>& rocks = shadow_rocks_[j * shadow_side_ + i];
  return std::any_of(rocks.begin(), rocks.end(), [&](int rock) {
    return rocks_[rock].Blocks({point, to_sun_});
  });
}

}  // namespace arfm_vo
