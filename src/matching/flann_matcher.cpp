#include "arfm_vo/matching/flann_matcher.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/flann/miniflann.hpp>

namespace arfm_vo {
namespace {

constexpr int kTrees = 4;  ///< randomised kd-trees
constexpr int kChecks =
    32;                   ///< leaves looked at for a query: more find more of the true neighbours
constexpr int kSeed = 1;  ///< of the trees

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

std::vector<Neighbours> FindOneWay(const cv::Mat& queries, const cv::Mat& train) {
  std::vector<Neighbours> neighbours(queries.rows);
  if (queries.empty() || train.empty()) return neighbours;
  const SeededGenerator generator(kSeed);
  cv::flann::Index index(train, cv::flann::KDTreeIndexParams(kTrees));
  cv::Mat indices, squared_distances;
  index.knnSearch(queries, indices, squared_distances, std::min(2, train.rows),
                  cv::flann::SearchParams(kChecks));
  for (int i = 0; i < queries.rows; ++i) {
    for (int k = 0; k < indices.cols; ++k) {
      const int candidate = indices.at<int>(i, k);
      if (candidate >= 0) neighbours[i].Add(candidate, squared_distances.at<float>(i, k));
    }
  }
  return neighbours;
}

}  // namespace

TwoWayNeighbours FindNeighboursByFlann(const Features& first, const Features& second) {
  CheckDescriptors(first.descriptors, first.keypoints.size(), "the first image");
  CheckDescriptors(second.descriptors, second.keypoints.size(), "the second image");
  return {FindOneWay(first.descriptors, second.descriptors),
          FindOneWay(second.descriptors, first.descriptors)};
}

}  // namespace arfm_vo
