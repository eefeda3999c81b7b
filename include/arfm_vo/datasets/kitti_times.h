#pragma once

#include <string>
#include <vector>

namespace arfm_vo {

/// The stamps of a times.txt (seconds, one a line) or of a timestamps.txt of the raw data (lines as
/// 2011-09-26 13:02:25.964389445; made relative to the first). Throws std::invalid_argument naming
/// file and line where one cannot be read, is not finite or not later than the one before.
std::vector<double> ReadKittiTimes(const std::string& path);

}  // namespace arfm_vo
