#pragma once

#include <string>

#include "arfm_vo/geometry/stereo_camera.h"
#include "recordings/draw.h"
#include "synthetic/pair_changes.h"

namespace arfm_vo {

/// What light and sensor do to the pictures of a whole recording.
struct LightPlan {
  double gain = 1, gamma = 1;
  double last_gain = 1;  ///< times `gain` at the last pair; in between evenly in its logarithm
  double noise_grey_levels = 0;  ///< standard deviation

  bool IsChanged() const { return gain != 1 || gamma != 1 || last_gain != 1; }
};

LightPlan DrawLightPlan(Draw& draw);
/// Without the noise.
PairChange ChangeLight(const LightPlan& plan, int num_pairs);

/// A fault that is put in, from pair `begin` to before `end`.
struct FaultPlan {
  std::string kind = "none";
  int begin = 0, end = 1 << 30;
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();  ///< rad, rotation vector of the right camera
  int ramp_pairs = 1;                              ///< within which the right camera turns so
  ObjectOptions object;
  int blur_px = 0;
  bool is_left = false;  ///< the camera that is blurred
  double share = 0;      ///< of the picture that is covered
  int num_dots = 0;
  int seed = 0;

  /// Whether the right camera shows nothing of use while the fault lasts.
  bool IsRightUseless() const { return kind == "right_black" || kind == "right_frozen"; }
  /// Whether the fault is something in the picture, before what else is seen there.
  bool HidesView() const { return kind == "object" || kind == "cover" || kind == "dots"; }
};

/// The kinds there are, "none" first.
const std::vector<std::string>& FaultKinds();
FaultPlan DrawFaultPlan(const std::string& kind, int num_pairs, Draw& draw);
PairChange MakeFault(const FaultPlan& plan, const StereoCamera& camera);

}  // namespace arfm_vo
