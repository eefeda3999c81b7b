#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "arfm_vo/features/features.h"

namespace arfm_vo {

/// Determinants of the Hessian (eq 3) of box filters of growing size. 0 where a filter does not fit
/// into the image.
struct ScaleSpace {
  int initial_step = 1;                              ///< px between samples of the first octave
  std::vector<std::vector<cv::Mat_<float>>> layers;  ///< [octave][layer]; columns may be padded

  int Step(int octave) const { return initial_step << octave; }  ///< px
  /// At a pixel that is sampled in this octave.
  float At(int octave, int layer, int x, int y) const {
    return layers[octave][layer](y / Step(octave), x / Step(octave));
  }
};

/// A sample of the scale space whose determinant is greater than those of its 26 neighbours.
struct ScaleSpaceMaximum {
  int x = 0, y = 0;    ///< px
  int octave = 0;      ///< from 0
  int layer = 0;       ///< of its octave, 1 .. layers - 2
  float response = 0;  ///< determinant of the Hessian
};

/// The keypoint at the top of the quadratic function through the maximum and its neighbours (Brown
/// and Lowe, BMVC 2002); its Laplacian's sign is not set. Nothing where the top lies beyond the
/// neighbours.
std::optional<Keypoint> InterpolateMaximum(const ScaleSpace& space,
                                           const ScaleSpaceMaximum& maximum);

/// Whether the octave below has a larger determinant at the place of this maximum, between its
/// filter and the next ones: then the same blob is found there too.
bool RepeatsFinerOctave(const ScaleSpace& space, const ScaleSpaceMaximum& maximum);

}  // namespace arfm_vo
