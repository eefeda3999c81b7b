#include "arfm_vo/matching/flann_matcher.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/flann/miniflann.hpp>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

/// FLANN draws from OpenCV's generator of this thread: seeds it, and puts it back at the end.
class SeededGenerator {
 public:
  explicit SeededGenerator(int seed) : before_(cv::theRNG()) { cv::theRNG() = cv::RNG(seed); }
  ~SeededGenerator() { cv::theRNG() = before_; }
  SeededGenerator(const SeededGenerator&) = delete;
  SeededGenerator& operator=(const SeededGenerator&) = delete;

 private:
  cv::RNG before_;
};

std::vector<Neighbours> FindOneWay(const cv::Mat& queries, const cv::Mat& train,
                                   const FlannMatcherOptions& options) {
  std::vector<Neighbours> neighbours(queries.rows);
  if (queries.empty() || train.empty()) return neighbours;
  const SeededGenerator generator(options.seed);
  cv::flann::Index index(train, cv::flann::KDTreeIndexParams(options.trees));
  cv::Mat indices, squared_distances;
  index.knnSearch(queries, indices, squared_distances, std::min(2, train.rows),
                  cv::flann::SearchParams(options.checks));
  for (int i = 0; i < queries.rows; ++i) {
    for (int k = 0; k < indices.cols; ++k) {
      const int candidate = indices.at<int>(i, k);
      if (candidate >= 0) neighbours[i].Add(candidate, squared_distances.at<float>(i, k));
    }
  }
  return neighbours;
}

void CheckDescriptors(const Features& features) {
  Require(features.descriptors.rows == features.size() &&
              (features.size() == 0 ||
               (features.descriptors.type() == CV_32FC1 && features.descriptors.cols == 64)),
          "FLANN matcher: descriptors must be [N x 64] CV_32FC1, one a keypoint");
}

}  // namespace

void FlannMatcherOptions::Check() const {
  Require(trees >= 1 && trees <= 64, "flann.trees must be in 1..64");
  Require(checks >= 1, "flann.checks must be at least 1");
}

TwoWayNeighbours FindNeighboursByFlann(const Features& first, const Features& second,
                                       const FlannMatcherOptions& options) {
  options.Check();
  CheckDescriptors(first);
  CheckDescriptors(second);
  return {FindOneWay(first.descriptors, second.descriptors, options),
          FindOneWay(second.descriptors, first.descriptors, options)};
}

}  // namespace arfm_vo
