#pragma once

#include <vector>

#include "arfm_vo/features/features.h"

namespace arfm_vo {

/// Keypoints of one and the same place are no further from one another than this, px.
inline double StillReach(const Keypoint& keypoint) { return 3 * kKeypointSigma * keypoint.scale; }

/// [now] which keypoints look as one of `before` at the same place of the picture, within what
/// keypoints err: what is fixed to the camera, or all that a resting camera sees.
std::vector<char> FindStill(const Features& before, const Features& now, int width, int height);

/// How much likelier it is by these flags that the camera rests than that it has moved, while
/// something fixed before it may cover a part of the picture; in logarithms. Each of 4 x 3 regions
/// counts once. Without keypoints of before (all flags 0) it is as likely.
double RestLogRatio(const Features& now, const std::vector<char>& is_still, int width, int height);

}  // namespace arfm_vo
