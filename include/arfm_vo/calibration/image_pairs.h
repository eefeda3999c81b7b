#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace arfm_vo {

/// The files of one stereo pair, not yet read.
struct ImagePair {
  std::string name;  ///< what the two file names share, such as "07"
  std::filesystem::path left, right;
};

/// The pairs of a folder, in the order of their names: either files left*.EXT and right*.EXT, or
/// the sub-folders left/ and right/ with files of the same names, a leading left or right not
/// counting; where no name is in both, of the same last number (L_7, R_7). Throws
/// std::invalid_argument naming the file that has no partner, and where there is no pair at all.
std::vector<ImagePair> FindImagePairs(const std::filesystem::path& folder);

}  // namespace arfm_vo
