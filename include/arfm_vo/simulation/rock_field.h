#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/simulation/solid.h"

namespace arfm_vo {

struct RockOptions {
  double density_per_m2 = 6;   ///< of all rocks; the number above radius r falls as r^-power
  double min_radius_m = 0.02;  ///< of the smallest rock
  double max_radius_m = 0.4;   ///< of the largest rock, above min_radius_m
  double power = 1.9;          ///< of the rocks' distribution over the radius
  double flatness = 0.65;      ///< mean height over width

  void Check() const;
  ARFM_FIELDS(density_per_m2, min_radius_m, max_radius_m, power, flatness)
};

/// The lie of the land that rocks are strewn on.
struct RockBed {
  std::function<double(double x, double y)> height_m;
  /// Share of the density at a place, in [0, 1].
  std::function<double(double x, double y)> cover;
  /// The largest radius allowed at a place, m.
  std::function<double(double x, double y)> max_radius_m;
};

/// Rocks strewn over a square of `side_m` around the origin, and where their shadows fall.
class RockField {
 public:
  RockField() = default;
  RockField(const RockOptions& options, const RockBed& bed, double side_m,
            const Eigen::Vector3d& to_sun, uint32_t seed);

  const std::vector<Solid>& rocks() const { return rocks_; }
  /// Whether a rock stands between the point and the sun.
  bool IsShadowed(const Eigen::Vector3d& point) const;

 private:
  void FillCell(const RockOptions& options, const RockBed& bed, int i, int j, uint32_t seed);
  /// Adds a rock to the cells that its shadow may reach.
  void IndexShadow(int index);

  double side_m_ = 0;
  Eigen::Vector3d to_sun_ = Eigen::Vector3d::UnitZ();
  std::vector<Solid> rocks_;
  int shadow_side_ = 0;                         ///< shadow cells along a side
  std::vector<std::vector<int>> shadow_rocks_;  ///< [cells] indices of rocks_
};

}  // namespace arfm_vo
