#include "arfm_vo/simulation/scene.h"

#include <algorithm>
#include <boost/algorithm/string/join.hpp>
#include <cmath>

#include "arfm_vo/simulation/hash_noise.h"

namespace arfm_vo {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kRoadMargin = 60;  ///< m more of it where the way is a road

/// The segments of a path; `length_m` of driving are asked for.
std::vector<PathSegment> Segments(const std::string& path, double length_m) {
  if (path == "curve" || path == "slopes") {
    return {{4, 0.6}, {6, -0.9}, {3, 0}, {5, -0.5}, {6, 0.8}};
  }
  if (path == "turn") return {{length_m / 3, 0}, {0, M_PI / 2}, {length_m / 3, 0.2}};
  if (path == "loop") return {{length_m / 2, 2 * M_PI}};
  if (path == "wide_turn") {
    const double straight = std::max(5.0, (length_m - 15) / 2);
    return {{straight, 0.03}, {15, 98 * kDegree}, {straight, -0.03}};
  }
  return {{std::max(length_m, 1.0), 0}};
}

}  // namespace

const std::vector<std::string>& Scene::PathNames() {
  static const std::vector<std::string> names{"straight", "curve", "turn",   "slopes",
                                              "loop",     "rest",  "shadow", "wide_turn"};
  return names;
}

void SceneOptions::Check() const {
  const std::vector<std::string>& names = Scene::PathNames();
  Require(std::count(names.begin(), names.end(), path) == 1,
          "path '" + path + "' is none of: " + boost::join(names, " "));
  Require(num_pairs >= 1 && num_pairs <= 100000, "pairs must be in 1..100000");
  Require(step_m > 0 && step_m <= 5, "step must be in (0, 5] m");
  Require(turn_step_deg > 0 && turn_step_deg <= 90, "turn-step must be in (0, 90] deg");
  Require(width >= 0 && height >= 0 && width <= 8192 && height <= 8192,
          "width and height must be in 0..8192");
  Require(num_threads >= 1, "threads must be at least 1");
  Require(margin_m >= 1 && margin_m <= 500, "margin must be in [1, 500] m");
  for (const double sweep : {sweep_pan_deg, sweep_tilt_deg}) {
    Require(sweep >= 0 && sweep <= 180, "sweep-pan and sweep-tilt must be in [0, 180] deg");
  }
  for (const double angle : {right_x_mrad, right_y_mrad, right_z_mrad}) {
    Require(std::abs(angle) <= 50, "right-x, right-y and right-z must be in [-50, 50] mrad");
  }
}

Scene::Scene(const SceneOptions& options) : options_(options) {
  options.Check();
  ChooseCamera();
  PlanarPath path = ChoosePath();
  terrain_ =
      std::make_unique<Terrain>(ChooseTerrain(path), ChooseCorridor(path), options.num_threads);
  RenderOptions render;
  render.num_threads = options.num_threads;
  if (options.path == "wide_turn") render.skylight = 0.4;
  render.sensor.noise_grey_levels = options.noise_grey_levels;
  render.sensor.seed = options.seed;
  renderer_ = std::make_unique<TerrainRenderer>(*terrain_, render);
  for (size_t i = 0; i < path.size(); ++i) {
    world_from_left_.push_back(PlaceRover(*terrain_, path[i], shape_) *
                               BaseFromLeft(Stamp(static_cast<int>(i))));
  }
}

Rigid3 Scene::BaseFromLeft(double stamp_s) const {
  const double angle = 2 * M_PI * stamp_s / Stamp(std::max(1, options_.num_pairs - 1));
  return BaseFromLeftCamera(shape_, options_.sweep_pan_deg / 2 * kDegree * std::sin(angle),
                            options_.sweep_tilt_deg / 2 * kDegree * std::sin(2 * angle));
}

void Scene::ChooseCamera() {
  const bool is_road = options_.path == "wide_turn";
  camera_ = is_road ? StereoCamera{707.0912, 707.0912, 601.8873, 183.1104, 0.5372, 1226, 370}
                    : StereoCamera{420, 420, 255.5, 191.5, 0.2, 512, 384};
  if (is_road) {
    shape_.track_length_m = 2.7;
    shape_.track_gauge_m = 1.5;
    shape_.camera_height_m = 1.65;
    shape_.camera_forward_m = 1.6;
    shape_.camera_left_m = camera_.baseline_m / 2;
    shape_.camera_tilt_deg = 0;
  }
  const int width = options_.width > 0 ? options_.width : camera_.width;
  const int height = options_.height > 0 ? options_.height : camera_.height;
  const double scale = static_cast<double>(width) / camera_.width;
  camera_.cx = (width - 1) / 2.0 + scale * (camera_.cx - (camera_.width - 1) / 2.0);
  camera_.cy = (height - 1) / 2.0 + scale * (camera_.cy - (camera_.height - 1) / 2.0);
  camera_.fx *= scale;
  camera_.fy *= scale;
  camera_.width = width;
  camera_.height = height;
}

PlanarPath Scene::ChoosePath() const {
  RoverPose start;
  start.heading_rad = 2 * M_PI * HashUnit(HashWord(options_.seed) + 5);
  if (options_.path == "rest" || options_.path == "shadow") {
    return PlanarPath(options_.num_pairs, start);
  }
  const double length = options_.step_m * options_.num_pairs;
  PlanarPath path = SamplePath(start, Segments(options_.path, length), options_.step_m,
                               options_.turn_step_deg * kDegree, options_.num_pairs);
  CenterPath(path);
  return path;
}

TerrainOptions Scene::ChooseTerrain(const PlanarPath& path) const {
  TerrainOptions terrain;
  terrain.seed = options_.seed;
  if (options_.path == "slopes") terrain.relief_m = 1.8;
  if (options_.path == "wide_turn") {
    terrain.cell_m = 0.4;
    terrain.relief_m = 0.8;
    terrain.relief_wavelength_m = 60;
    terrain.hills_m = 140;
    terrain.texture_contrast = 0.4;
    terrain.rocks = {0.3, 0.08, 4, 1.2, 0.9};
  }
  PlanarPath centered = path;
  const double half =
      CenterPath(centered) + options_.margin_m + (options_.path == "wide_turn" ? kRoadMargin : 0);
  double cells = 128;
  while (cells < 2048 && cells * terrain.cell_m < 2 * half) cells *= 2;
  while (cells * terrain.cell_m < 2 * half) terrain.cell_m *= 2;
  terrain.side_m = cells * terrain.cell_m;
  return terrain;
}

Corridor Scene::ChooseCorridor(const PlanarPath& path) const {
  Corridor corridor;
  corridor.points = FollowPath(path, 10);
  if (options_.path == "wide_turn") {
    corridor.half_width_m = 9;
    corridor.max_rock_radius_m = 0;
    corridor.contrast = 0.4;
    corridor.tone = 0.8;
  }
  return corridor;
}

std::vector<Solid> Scene::Bodies(int pair) const {
  if (options_.path != "shadow") return {};
  // A box, about as large as a third of the picture with its shadow, drives by 2.8 m ahead.
  const double share = static_cast<double>(pair) / std::max(1, num_pairs() - 1);
  const double half_view = 2.8 * camera_.width / (2 * camera_.fx);
  const Rigid3& world_from_left = world_from_left_.at(pair);
  const Eigen::Vector3d in_camera((2 * share - 1) * 1.5 * half_view, 0.3, 2.8);
  Solid box = MakeBox(world_from_left * Rigid3(Eigen::Quaterniond::Identity(), in_camera),
                      {0.45 * half_view, 1.3, 0.3});
  box.texture_offset_m = {17, 23};
  box.albedo = 0.5;
  return {box};
}

Rigid3 Scene::WorldFromRight(int pair) const {
  const Eigen::Vector3d rotation(options_.right_x_mrad, options_.right_y_mrad,
                                 options_.right_z_mrad);
  const Rigid3 nominal_from_right(ExpSO3(-1e-3 * rotation), Eigen::Vector3d::Zero());
  return RightCameraPose(camera_, WorldFromLeft(pair)) * nominal_from_right;
}

StereoImages Scene::RenderPair(int pair) const {
  const std::vector<Solid> bodies = Bodies(pair);
  StereoImages images;
  images.stamp_s = Stamp(pair);
  images.left = renderer_->Render(camera_, WorldFromLeft(pair), 2 * pair, bodies);
  images.right = renderer_->Render(camera_, WorldFromRight(pair), 2 * pair + 1, bodies);
  return images;
}

}  // namespace arfm_vo
