#pragma once

#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "arfm_vo/features/surf.h"
#include "arfm_vo/matching/neighbours.h"

namespace arfm_vo {

/// Points of an image with a descriptor each.
struct DescribedPoints {
  std::vector<cv::Point2f> points;
  cv::Mat descriptors;
};

/// A way to find and describe points.
struct FeatureMethod {
  std::string name;
  int norm = cv::NORM_L2;  ///< that compares descriptors
  std::function<DescribedPoints(const cv::Mat& grey)> extract;
};

DescribedPoints Describe(const Features& features);

/// SURF that keeps the strongest points wherever they are, as cv::SIFT and cv::ORB do.
SurfOptions StrongestSurf(int num_points);
/// As published (Bay 2008): not smoothed, octaves apart, regions side by side.
SurfOptions PublishedSurf(int num_points);

/// Our SURF (strongest, spread over the image, as published) and cv::SIFT, cv::ORB, cv::AKAZE, with
/// at most `num_points` points an image.
std::vector<FeatureMethod> ListMethods(int num_points);

/// Two nearest neighbours both ways by cv::BFMatcher, the same for all methods.
TwoWayNeighbours FindNeighboursByOpenCv(const DescribedPoints& first, const DescribedPoints& second,
                                        int norm);

}  // namespace arfm_vo
