#pragma once

#include <memory>
#include <string>
#include <vector>

#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/simulation/drive_path.h"
#include "arfm_vo/simulation/terrain_renderer.h"

namespace arfm_vo {

struct SceneOptions {
  /// straight, curve, turn (in place), slopes (to 15 degrees), loop (driven twice), rest, shadow
  /// (at rest, something large and its shadow move through a third of the picture) or wide_turn (a
  /// road, 98 degrees within 15 m, mostly far points).
  std::string path = "curve";
  int num_pairs = 40;
  double step_m = 0.1;
  double turn_step_deg = 4;
  int seed = 1;
  int num_threads = 1;
  int width = 0, height = 0;  ///< px; 0: as the path's camera has it
  double noise_grey_levels = 1;
  double margin_m = 40;  ///< of ground with rocks and full detail around the path
  /// A fault of rectification: what the right camera sees is turned by this rotation vector, mrad.
  double right_x_mrad = 0, right_y_mrad = 0, right_z_mrad = 0;
  /// The head sweeps through so much: pan once to the left and the right, tilt twice down and up.
  double sweep_pan_deg = 0, sweep_tilt_deg = 0;

  void Check() const;
};

/// A drive through a rendered world: the terrain, the camera, and where it was at each pair.
class Scene {
 public:
  explicit Scene(const SceneOptions& options);

  /// The kinds of path there are.
  static const std::vector<std::string>& PathNames();

  int num_pairs() const { return static_cast<int>(world_from_left_.size()); }
  const StereoCamera& camera() const { return camera_; }
  const Terrain& terrain() const { return *terrain_; }
  double Stamp(int pair) const { return 0.1 * pair; }
  /// The left camera in the terrain's frame.
  const Rigid3& WorldFromLeft(int pair) const { return world_from_left_.at(pair); }
  /// The left camera in the frame of the first pair's left camera: the ground truth.
  Rigid3 FirstFromLeft(int pair) const {
    return world_from_left_.front().Inverse() * world_from_left_.at(pair);
  }
  /// The left camera on the base, at any time; the head moves in between the pairs too.
  Rigid3 BaseFromLeft(double stamp_s) const;
  /// The base in its own frame at the first pair: the ground truth.
  Rigid3 FirstFromBase(int pair) const {
    return BaseFromLeft(Stamp(0)) * FirstFromLeft(pair) * BaseFromLeft(Stamp(pair)).Inverse();
  }
  StereoImages RenderPair(int pair) const;
  /// The moving things at a pair.
  std::vector<Solid> Bodies(int pair) const;

 private:
  Rigid3 WorldFromRight(int pair) const;
  void ChooseCamera();
  TerrainOptions ChooseTerrain(const PlanarPath& path) const;
  Corridor ChooseCorridor(const PlanarPath& path) const;
  PlanarPath ChoosePath() const;

  SceneOptions options_;
  StereoCamera camera_;
  RoverShape shape_;
  std::unique_ptr<Terrain> terrain_;
  std::unique_ptr<TerrainRenderer> renderer_;
  std::vector<Rigid3> world_from_left_;
};

}  // namespace arfm_vo
