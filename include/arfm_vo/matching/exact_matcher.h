#pragma once

#include "arfm_vo/features/features.h"
#include "arfm_vo/matching/neighbours.h"

namespace arfm_vo {

/// Finds the two nearest neighbours of every descriptor in both directions by exhaustive search,
/// among blobs of the same kind (dark on bright or bright on dark; two of different kind are never
/// the same point, Bay 2008, section 4.3): one blocked pass over the matrix of scores a . b serves
/// both directions, squared distance = 2 - 2 a . b. Descriptors must be of unit length; those that
/// are not finite have no neighbours and are nobody's. Throws std::invalid_argument where
/// descriptors are not [N x 64] CV_32FC1.
TwoWayNeighbours FindNeighboursExactly(const Features& first, const Features& second);

}  // namespace arfm_vo
