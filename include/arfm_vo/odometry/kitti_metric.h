#pragma once

#include <limits>
#include <vector>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// Which sub-sequences are compared: from every `start_step`-th frame, of each length.
struct SegmentOptions {
  std::vector<double> lengths_m;
  int start_step = 1;
};

/// Those of the KITTI devkit (evaluate_odometry.cpp): 100, 200, .. 800 m from every 10th frame.
SegmentOptions KittiSegments();
/// For runs too short for them: 10, 20, .. 50 m from every frame.
SegmentOptions ShortSegments();

/// The mean errors over all sub-sequences; NaN where there is none.
struct SegmentError {
  double translation_percent = std::numeric_limits<double>::quiet_NaN();
  double rotation_deg_per_m = std::numeric_limits<double>::quiet_NaN();
  int num_segments = 0;
};

/// The KITTI error (Geiger et al., CVPR 2012): a sub-sequence of length L begins at a frame and
/// ends at the first one that is more than L further along the true path; its error is the motion
/// left between estimated and true relative pose, divided by L. Both hold world_from_camera of the
/// same frames, in any world. Throws std::invalid_argument where their lengths differ.
SegmentError ComputeSegmentError(const std::vector<Rigid3>& truth,
                                 const std::vector<Rigid3>& estimate,
                                 const SegmentOptions& options);

/// [N] metres along the path up to each frame, beginning with 0.
std::vector<double> ComputeDistances(const std::vector<Rigid3>& path);

}  // namespace arfm_vo
