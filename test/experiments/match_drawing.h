#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "arfm_vo/features/features.h"
#include "arfm_vo/matching/match.h"
#include "arfm_vo/reconstruction/stereo_point.h"
#include "experiments/judged_pair.h"

namespace arfm_vo {

/// Both images side by side (stereo pairs one above the other), right matches as green lines, wrong
/// ones as red lines on top.
cv::Mat DrawMatches(const JudgedPair& pair, const Features& first, const Features& second,
                    const Matches& matches);

/// The points on their image, coloured by the logarithm of their depth from near (red) to far
/// (blue).
cv::Mat DrawDepths(const cv::Mat& grey, const StereoPoints& points);

}  // namespace arfm_vo
