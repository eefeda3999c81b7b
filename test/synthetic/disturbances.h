#pragma once

#include <functional>
#include <string>
#include <vector>

#include "arfm_vo/image/stereo_images.h"

namespace arfm_vo {

/// Changes pair `index` in place, from 0 one after the other; its images are not shared with
/// anyone. May keep what it needs of earlier pairs. An empty left image: the pair has not come.
using PairChange = std::function<void(int index, StereoImages& images)>;

/// Spoils the pairs of a recording as cameras, weather and traffic do. For one run: make a new one
/// for each.
struct Disturbance {
  std::string name;
  PairChange apply;
};

/// "none", and sixteen for a quick look.
std::vector<Disturbance> MakeDisturbances();
/// 45 others: the same in other strengths, and further kinds.
std::vector<Disturbance> MakeMoreDisturbances();

}  // namespace arfm_vo
