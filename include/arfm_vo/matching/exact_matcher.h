#pragma once

#include "arfm_vo/features/features.h"
#include "arfm_vo/matching/neighbours.h"

namespace arfm_vo {

struct ExactMatcherOptions {
  /// Compare only blobs of the same kind (dark on bright or bright on dark): twice as fast, and two
  /// blobs of different kind are never the same point (Bay 2008, section 4.3).
  bool use_laplacian_sign = true;
  bool use_simd = true;  ///< false: the portable kernel even where the CPU has a better one

  void Check() const {}
};

/// Finds the two nearest neighbours of every descriptor in both directions by exhaustive search:
/// one blocked pass over the matrix of scores a . b serves both directions, squared distance =
/// 2 - 2 a . b. Descriptors must be of unit length; those that are not finite have no neighbours
/// and are nobody's. Throws std::invalid_argument where descriptors are not [N x 64] CV_32FC1.
TwoWayNeighbours FindNeighboursExactly(const Features& first, const Features& second,
                                       const ExactMatcherOptions& options = {});

}  // namespace arfm_vo
