#pragma once

#include <string>
#include <vector>

#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/simulation/drive_path.h"
#include "recordings/draw.h"

namespace arfm_vo {

/// A drive to be rendered: the rig, how it moves and what there is to be seen.
struct DrivePlan {
  StereoCamera camera;
  RoverShape shape;
  std::string motion, scene;
  int num_pairs = 0;
  double interval_s = 0.1;
  double step_m = 0.1, turn_step_rad = 0.05;  ///< from pair to pair
  double turn_rad = 0;                        ///< of an arc, in all; of a turn in place
  double shake_rad = 0;                       ///< standard deviation about each axis, in each pair
  int pause_begin = 0, pause_pairs = 0;
  double noise_grey_levels = 1;
  int seed = 1;  ///< of the scene
};

const std::vector<std::string>& MotionNames();
const std::vector<std::string>& SceneNames();
DrivePlan DrawDrivePlan(int max_pairs, Draw& draw);
/// Where the base stands at each pair, around the origin.
PlanarPath MakePath(const DrivePlan& plan);

}  // namespace arfm_vo
