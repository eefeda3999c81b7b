#pragma once

#include <optional>

#include "arfm_vo/features/features.h"
#include "arfm_vo/image/integral_image.h"

namespace arfm_vo {

/// A sample of the scale space whose determinant is greater than those of its 26 neighbours.
struct ScaleSpaceMaximum {
  int x = 0, y = 0;    ///< px
  int octave = 0;      ///< from 0
  int layer = 0;       ///< of its octave, 1 .. layers - 2
  float response = 0;  ///< determinant of the Hessian
};

/// The keypoint at the top of the quadratic function through the maximum and its neighbours (Brown
/// and Lowe, BMVC 2002), `step` px apart. Nothing where the top lies beyond the neighbours.
std::optional<Keypoint> InterpolateMaximum(const IntegralImage& integral,
                                           const ScaleSpaceMaximum& maximum, int step);

/// Whether an octave below, sampled every `step` px, has a larger determinant at the place of this
/// maximum, between its filter and the next ones: then the same blob is found there too.
bool RepeatsFinerOctave(const IntegralImage& integral, const ScaleSpaceMaximum& maximum, int step,
                        int layers);

}  // namespace arfm_vo
