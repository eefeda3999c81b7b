#include "experiments/feature_method.h"

#include <algorithm>
#include <opencv2/features2d.hpp>

namespace arfm_vo {
namespace {

FeatureMethod SurfMethod(const std::string& name, const SurfOptions& options) {
  return {name, cv::NORM_L2,
          [options](const cv::Mat& grey) { return Describe(Surf(options).Extract(grey)); }};
}

FeatureMethod OpenCvMethod(const std::string& name, int norm, const cv::Ptr<cv::Feature2D>& feature,
                           int num_points) {
  return {name, norm, [feature, num_points](const cv::Mat& grey) {
            std::vector<cv::KeyPoint> keypoints;
            feature->detect(grey, keypoints);
            cv::KeyPointsFilter::retainBest(keypoints, num_points);
            keypoints.resize(std::min<size_t>(keypoints.size(), num_points));
            DescribedPoints described;
            feature->compute(grey, keypoints, described.descriptors);
            cv::KeyPoint::convert(keypoints, described.points);
            return described;
          }};
}

std::vector<Neighbours> FindNeighbours(const DescribedPoints& from, const DescribedPoints& to,
                                       int norm) {
  std::vector<Neighbours> all(from.points.size());
  if (from.points.empty() || to.points.empty()) return all;
  std::vector<std::vector<cv::DMatch>> found;
  cv::BFMatcher(norm).knnMatch(from.descriptors, to.descriptors, found, 2);
  float largest = 1e-6f;  // Neighbours holds distances of descriptors of unit length
  for (const auto& nearest : found) largest = std::max(largest, nearest.back().distance);
  for (const auto& nearest : found) {
    for (const cv::DMatch& match : nearest) {
      const float distance = match.distance / largest;
      all[match.queryIdx].Add(match.trainIdx, distance * distance);
    }
  }
  return all;
}

}  // namespace

DescribedPoints Describe(const Features& features) {
  DescribedPoints described;
  for (const Keypoint& keypoint : features.keypoints) {
    described.points.emplace_back(keypoint.x, keypoint.y);
  }
  described.descriptors = features.descriptors;
  return described;
}

SurfOptions StrongestSurf(int num_points) {
  SurfOptions options;
  options.detector.target_keypoints = num_points;
  options.detector.bucket_px = 0;
  return options;
}

SurfOptions PublishedSurf(int num_points) {
  SurfOptions options = StrongestSurf(num_points);
  options.smooth = false;
  options.detector.octaves = 3;
  options.detector.merge_octaves = false;
  options.descriptor.overlapping_regions = false;
  return options;
}

std::vector<FeatureMethod> ListMethods(int num_points) {
  SurfOptions spread;
  spread.detector.target_keypoints = num_points;
  return {SurfMethod("SURF", StrongestSurf(num_points)),
          SurfMethod("SURF spread", spread),
          SurfMethod("SURF as published", PublishedSurf(num_points)),
          OpenCvMethod("cv::SIFT", cv::NORM_L2, cv::SIFT::create(num_points), num_points),
          OpenCvMethod("cv::ORB", cv::NORM_HAMMING, cv::ORB::create(num_points), num_points),
          OpenCvMethod("cv::AKAZE", cv::NORM_HAMMING, cv::AKAZE::create(), num_points)};
}

TwoWayNeighbours FindNeighboursByOpenCv(const DescribedPoints& first, const DescribedPoints& second,
                                        int norm) {
  return {FindNeighbours(first, second, norm), FindNeighbours(second, first, norm)};
}

}  // namespace arfm_vo
