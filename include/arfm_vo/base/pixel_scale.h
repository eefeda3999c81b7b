#pragma once

#include <algorithm>

namespace arfm_vo {

/// What distances of options in px that belong to the picture as a whole (searches, cells) are to
/// be multiplied with: 1 for pictures up to 1280 px wide, more for wider ones.
constexpr double PixelScale(int picture_width) { return std::max(1.0, picture_width / 1280.0); }

}  // namespace arfm_vo
