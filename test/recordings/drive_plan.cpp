#include "recordings/drive_plan.h"

#include <algorithm>
#include <cmath>

namespace arfm_vo {
namespace {

constexpr double kDegree = M_PI / 180;

struct PictureSize {
  int width, height;
};

/// Small ones mostly: a pair of 1280 x 960 costs seconds.
PictureSize DrawSize(Draw& draw) {
  constexpr PictureSize sizes[]{{320, 240}, {480, 300}, {512, 384}, {640, 480}, {1280, 960}};
  const int size = draw.OneOf<int>({0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 3, 3});
  return sizes[draw.Chance(0.015) ? 4 : size];
}

/// A small rover, a rover, a car: camera height, baseline and size belong together.
void DrawRig(DrivePlan& plan, Draw& draw) {
  const int kind = draw.OneOf<int>({0, 0, 1, 1, 2});
  constexpr double min_height[]{0.2, 0.5, 1.2}, max_height[]{0.5, 1.2, 1.8};
  constexpr double min_baseline[]{0.05, 0.1, 0.3}, max_baseline[]{0.15, 0.35, 0.6};
  const PictureSize size = DrawSize(draw);
  const double fov = draw.Between(40, 110) * kDegree;
  const double focal = size.width / (2 * std::tan(fov / 2));
  const double off_u = draw.Between(-0.03, 0.03), off_v = draw.Between(-0.03, 0.03);
  plan.camera = {focal,
                 focal,
                 (size.width - 1) / 2.0 + off_u * size.width,
                 (size.height - 1) / 2.0 + off_v * size.height,
                 draw.LogBetween(min_baseline[kind], max_baseline[kind]),
                 size.width,
                 size.height};
  plan.shape.camera_height_m = draw.Between(min_height[kind], max_height[kind]);
  plan.shape.track_length_m = plan.shape.camera_height_m * draw.Between(0.6, 1.5);
  plan.shape.track_gauge_m = plan.shape.track_length_m * draw.Between(0.5, 0.8);
  plan.shape.camera_forward_m = plan.shape.track_length_m * draw.Between(0, 0.5);
  plan.shape.camera_left_m = plan.camera.baseline_m / 2;
  plan.shape.camera_tilt_deg = kind == 2 ? draw.Between(0, 8) : draw.Between(5, 28);
}

void DrawMotion(DrivePlan& plan, Draw& draw) {
  const double height = plan.shape.camera_height_m;
  const double speed_mps = height * draw.LogBetween(0.4, 4);
  plan.motion = draw.OneOf(MotionNames());
  plan.interval_s = 1 / draw.LogBetween(5, 20);
  plan.turn_step_rad = draw.LogBetween(0.5, 6) * kDegree;
  if (plan.motion == "slow") {
    plan.interval_s = draw.Between(1, 5);
    plan.turn_step_rad = draw.Between(1, 8) * kDegree;
  }
  plan.step_m =
      plan.motion == "slow" ? height * draw.Between(0.08, 0.45) : speed_mps * plan.interval_s;
  const double max_turn = plan.num_pairs * std::min(0.7 * plan.turn_step_rad, 4 * kDegree);
  plan.turn_rad = draw.Sign() * std::min(draw.Between(20, 160) * kDegree, max_turn);
  plan.shake_rad = plan.motion == "shake" ? draw.Between(0.3, 1.2) * kDegree : 0;
  if (plan.motion == "pauses") {
    plan.pause_pairs = draw.Integer(5, plan.num_pairs / 3);
    plan.pause_begin = draw.Integer(4, plan.num_pairs - plan.pause_pairs - 4);
  }
}

std::vector<PathSegment> Segments(const DrivePlan& plan) {
  const double length = plan.step_m * plan.num_pairs;
  if (plan.motion == "straight") return {{length, 0}};
  if (plan.motion == "point_turn") {
    const double part = 0.25 * length;
    return {{part, 0}, {0, plan.turn_rad}, {part, 0}, {0, -plan.turn_rad}};
  }
  if (plan.motion == "arc") return {{length, plan.turn_rad}};
  return {{0.4 * length, 0.3 * plan.turn_rad}, {0.6 * length, -0.5 * plan.turn_rad}};
}

}  // namespace

const std::vector<std::string>& MotionNames() {
  static const std::vector<std::string> names{"straight", "arc",   "point_turn",
                                              "pauses",   "shake", "slow"};
  return names;
}

const std::vector<std::string>& SceneNames() {
  static const std::vector<std::string> names{"sand",   "rocks",     "leaves",         "corridor",
                                              "street", "repeating", "little_texture", "night"};
  return names;
}

DrivePlan DrawDrivePlan(int max_pairs, Draw& draw) {
  DrivePlan plan;
  DrawRig(plan, draw);
  plan.num_pairs = draw.Integer(std::max(16, max_pairs * 2 / 3), std::max(16, max_pairs));
  if (plan.camera.width > 1000) plan.num_pairs = std::max(16, plan.num_pairs / 2);
  DrawMotion(plan, draw);
  plan.scene = draw.OneOf(SceneNames());
  plan.noise_grey_levels = draw.Between(0.5, 3);
  plan.seed = draw.Integer(1, 1 << 20);
  return plan;
}

PlanarPath MakePath(const DrivePlan& plan) {
  Draw draw(static_cast<uint32_t>(plan.seed));
  RoverPose start;
  start.heading_rad = draw.Between(0, 2 * M_PI);
  const int driven = plan.num_pairs - plan.pause_pairs;
  PlanarPath path = SamplePath(start, Segments(plan), plan.step_m, plan.turn_step_rad, driven);
  if (plan.pause_pairs > 0) {
    const RoverPose here = path.at(plan.pause_begin);
    path.insert(path.begin() + plan.pause_begin, plan.pause_pairs, here);
  }
  CenterPath(path);
  return path;
}

}  // namespace arfm_vo
