// A map of a rendered drive, and drives that wake up near it and elsewhere. Usage:
// recognise_rendered RESTARTS ELSEWHERE
#include <cmath>
#include <cstdlib>
#include <vector>

#include "arfm_vo/base/random.h"
#include "arfm_vo/simulation/drive_path.h"
#include "arfm_vo/simulation/terrain_renderer.h"
#include "mapping/odometry_chain.h"

namespace arfm_vo {
namespace {

/// The same ground in the light of any time of the day, and a rover's camera above it.
class Site {
 public:
  Site(double sun_elevation_deg, double sun_azimuth_deg, int seed)
      : terrain_(Options(sun_elevation_deg, sun_azimuth_deg, seed), {}, 2),
        renderer_(terrain_, Rendering()) {}

  /// The left eye of a rover that stands there.
  Rigid3 EyeAt(const RoverPose& pose) const {
    return PlaceRover(terrain_, pose, {}) * BaseFromLeftEye({});
  }
  StereoImages Render(const Rigid3& world_from_left, int pair) const {
    return renderer_.RenderPair(kRover, world_from_left, pair, 1 + 0.1 * pair);
  }
  static constexpr StereoCamera kRover{420, 420, 255.5, 191.5, 0.2, 512, 384};

 private:
  static TerrainOptions Options(double sun_elevation_deg, double sun_azimuth_deg, int seed) {
    TerrainOptions options;
    options.seed = seed;
    options.sun_elevation_deg = sun_elevation_deg;
    options.sun_azimuth_deg = sun_azimuth_deg;
    return options;
  }
  static RenderOptions Rendering() {
    RenderOptions options;
    options.num_threads = 2;
    options.edge_samples = 1;
    return options;
  }

  Terrain terrain_;
  TerrainRenderer renderer_;
};

/// A map of 8 m, and drives that begin up to 1 m and 20 degrees aside, in other light, and
/// elsewhere; 0.1 m a pair, ten pairs a second.
void RunSimulated(int num_restarts, int num_elsewhere) {
  const PlanarPath path = SamplePath({}, {{8, 0.8}}, 0.1, 1, 80);
  const Site noon(40, 130, 1);
  OdometryChain first(Site::kRover);
  first.map().Keep({}, kMaxPoints);
  std::vector<Rigid3> eyes;
  for (const RoverPose& pose : path) {
    eyes.push_back(noon.EyeAt(pose));
    first.Process(noon.Render(eyes.back(), static_cast<int>(eyes.size()) - 1));
  }
  first.map().Adjust();
  const KnownMap map = first.map().MakeKnownMap();
  std::printf("simulated: %zu keyframes, %zu points\n", map.keyframes.size(),
              NumPoints(map.keyframes));
  std::fflush(stdout);
  const Site lights[] = {Site(30, 100, 1), Site(50, 170, 1), Site(25, 140, 1)};
  Result near, far;
  RandomEngine random(9);
  const auto between = [&](double low, double high) {
    return low + (high - low) * RandomUnit(random);
  };
  for (int i = 0; i < num_restarts + num_elsewhere; ++i) {
    const bool is_near = i < num_restarts;
    Result& result = is_near ? near : far;
    const Site& site = lights[i % 3];
    RoverPose start = path[static_cast<size_t>(between(5, 55))];
    Eigen::Vector2d aside(between(-0.7, 0.7), between(-0.7, 0.7));
    start.heading_rad += between(-20, 20) * M_PI / 180;
    if (!is_near) aside += Eigen::Vector2d(30 + between(0, 20), between(-30, 30));
    start.x_m += aside.x();
    start.y_m += aside.y();
    OdometryChain drive(Site::kRover);
    drive.map().Keep(map, kMaxPoints);
    ++result.starts;
    const PlanarPath way = SamplePath(start, {{4, 0}}, 0.1, 1, 30);
    for (int k = 0; k < 30; ++k) {
      const Rigid3 eye = site.EyeAt(way[k]);
      const auto update = drive.Process(site.Render(eye, 1000 + 40 * i + k));
      if (drive.map().localiser().state() != MapState::kLocalised) continue;
      ++result.found;
      result.wait_s += 0.1 * k;
      const Rigid3 found = drive.map().map_from_odom() * update.odom_from_base;
      const auto away_m = [&](const KnownKeyframe& keyframe) {
        return (keyframe.map_from_camera.translation - found.translation).norm();
      };
      const auto nearest = std::min_element(
          map.keyframes.begin(), map.keyframes.end(),
          [&](const KnownKeyframe& a, const KnownKeyframe& b) { return away_m(a) < away_m(b); });
      const Rigid3& known = eyes[std::lround((nearest->stamp_s - 1) / 0.1)];
      result.Judge((known.Inverse() * eye).Inverse() * nearest->map_from_camera.Inverse() * found,
                   0, drive.map().localiser().found());
      break;
    }
  }
  std::printf(
      "aside, in other light: %d starts, %d found, %d off by more than 5 cm or 1 degree, "
      "mean wait %.2f s, worst %.3f m, %.2f deg\nelsewhere: %d starts, %d found\n",
      near.starts, near.found, near.wrong, near.wait_s / std::max(1, near.found), near.worst_m,
      near.worst_deg, far.starts, far.found);
}

}  // namespace
}  // namespace arfm_vo

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  arfm_vo::RunSimulated(std::atoi(argv[1]), std::atoi(argv[2]));
  return 0;
}
