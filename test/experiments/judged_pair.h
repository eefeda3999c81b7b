#pragma once

#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace arfm_vo {

/// Two images and what tells a right match from a wrong one.
struct JudgedPair {
  std::string set, name;
  bool is_stereo = false;  ///< rectified
  cv::Mat first, second;   ///< CV_8UC1
  std::function<bool(cv::Point2f, cv::Point2f)> is_correct;
};

/// The first image of a folder img1.png .. img6.png with each other one, judged by the homographies
/// H1to2p .. H1to6p (Mikolajczyk et al., IJCV 2005): 3 px. Throws std::runtime_error naming the
/// file that can't be read.
std::vector<JudgedPair> ReadHomographyPairs(const std::string& folder);

/// `max_pairs` pairs, evenly taken, of a KITTI folder: right where rows agree to 2 px, the
/// disparity is not negative and, where dense stereo (cv::StereoSGBM) sees one, agrees with it to 3
/// px.
std::vector<JudgedPair> ReadStereoPairs(const std::string& folder, int max_pairs);

/// By what lies in the folder. Throws std::runtime_error where it is neither.
std::vector<JudgedPair> ReadJudgedPairs(const std::string& folder, int max_pairs);

}  // namespace arfm_vo
