#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "arfm_vo/image/stereo_images.h"

namespace arfm_vo {

/// Spoils the pairs of a recording one after the other, as cameras and traffic do.
struct Disturbance {
  std::string name;
  /// Changes pair `index` in place; its images are not shared with anyone. Keeps what it needs of
  /// earlier pairs, so make a new one for each run.
  std::function<void(int index, StereoImages& images)> apply;
};

/// All that there are, each fresh.
std::vector<Disturbance> MakeDisturbances();

}  // namespace arfm_vo
