#pragma once

#include <string>

namespace arfm_vo {

/// Follows the records of a bag of format 2.0 (wiki.ros.org/Bags/Format/2.0) from one to the next,
/// those within chunks that are not compressed too. By hand, as the fuzz target `bag` found that
/// rosbag::View takes the lengths and offsets in them at their word and reads beyond its buffers
/// where they are wrong. Throws std::invalid_argument with the byte of a record that does not fit.
/// A bag that was never closed is left to rosbag.
void CheckBagRecords(const std::string& path);

}  // namespace arfm_vo
