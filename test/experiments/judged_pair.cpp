#include "experiments/judged_pair.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "arfm_vo/datasets/kitti_sequence.h"

namespace arfm_vo {
namespace {

namespace fs = std::filesystem;

constexpr double kHomographyErrorPx = 3, kRowErrorPx = 2, kDisparityErrorPx = 3;
constexpr int kNumImages = 6;  ///< of a set with homographies

std::string NameOf(const std::string& folder) {
  const fs::path path = fs::path(folder).lexically_normal();
  return path.has_filename() ? path.filename() : path.parent_path().filename();
}

cv::Mat ReadGrey(const std::string& path) {
  cv::Mat image = cv::imread(path, cv::IMREAD_GRAYSCALE);
  if (image.empty()) throw std::runtime_error(path + ": cannot be read as an image");
  return image;
}

cv::Matx33d ReadHomography(const std::string& path) {
  std::ifstream stream(path);
  cv::Matx33d homography;
  for (double& value : homography.val) stream >> value;
  if (!stream) throw std::runtime_error(path + ": must hold 9 numbers");
  return homography;
}

bool AgreesWithHomography(const cv::Matx33d& second_from_first, cv::Point2f first,
                          cv::Point2f second) {
  const cv::Vec3d p = second_from_first * cv::Vec3d(first.x, first.y, 1);
  return std::hypot(p[0] / p[2] - second.x, p[1] / p[2] - second.y) < kHomographyErrorPx;
}

/// [rows x cols] CV_32FC1, px; negative where dense stereo sees none.
cv::Mat_<float> ComputeDenseDisparity(const cv::Mat& left, const cv::Mat& right) {
  constexpr int kBlock = 5, kSubPixels = 16, kSmoothness = 8 * kBlock * kBlock;
  const int num_disparities = (left.cols / 8 + 15) / 16 * 16;
  const auto matcher =
      cv::StereoSGBM::create(0, num_disparities, kBlock, kSmoothness, 4 * kSmoothness, 1, 0, 10,
                             100, 2, cv::StereoSGBM::MODE_SGBM_3WAY);
  cv::Mat fixed;
  matcher->compute(left, right, fixed);
  cv::Mat_<float> disparity;
  fixed.convertTo(disparity, CV_32F, 1.0 / kSubPixels);
  return disparity;
}

bool AgreesWithStereo(const cv::Mat_<float>& dense, cv::Point2f left, cv::Point2f right) {
  const float disparity = left.x - right.x;
  if (std::abs(left.y - right.y) > kRowErrorPx || disparity < 0) return false;
  const int x = std::min(cvRound(left.x), dense.cols - 1);
  const int y = std::min(cvRound(left.y), dense.rows - 1);
  return dense(y, x) <= 0 || std::abs(dense(y, x) - disparity) <= kDisparityErrorPx;
}

}  // namespace

std::vector<JudgedPair> ReadHomographyPairs(const std::string& folder) {
  const cv::Mat first = ReadGrey(folder + "/img1.png");
  std::vector<JudgedPair> pairs;
  for (int i = 2; i <= kNumImages; ++i) {
    const std::string number = std::to_string(i);
    const cv::Matx33d homography = ReadHomography(folder + "/H1to" + number + "p");
    pairs.push_back({NameOf(folder), "1-" + number, false, first,
                     ReadGrey(folder + "/img" + number + ".png"),
                     [homography](cv::Point2f a, cv::Point2f b) {
                       return AgreesWithHomography(homography, a, b);
                     }});
  }
  return pairs;
}

std::vector<JudgedPair> ReadStereoPairs(const std::string& folder, int max_pairs) {
  const int num = KittiSequence(folder).size();
  const int stride = std::max(1, (num + max_pairs - 1) / max_pairs);
  KittiSequence sequence(folder, {stride, max_pairs});
  std::vector<JudgedPair> pairs;
  while (const auto pair = sequence.Next()) {
    const cv::Mat left = pair->images.left.clone(), right = pair->images.right.clone();
    const cv::Mat_<float> dense = ComputeDenseDisparity(left, right);
    const int frame = static_cast<int>(pairs.size()) * stride;
    pairs.push_back(
        {NameOf(folder), std::to_string(frame), true, left, right,
         [dense](cv::Point2f a, cv::Point2f b) { return AgreesWithStereo(dense, a, b); }});
  }
  return pairs;
}

std::vector<JudgedPair> ReadJudgedPairs(const std::string& folder, int max_pairs) {
  if (fs::exists(folder + "/H1to2p")) return ReadHomographyPairs(folder);
  if (fs::exists(folder)) return ReadStereoPairs(folder, max_pairs);
  throw std::runtime_error(folder + ": no such folder");
}

}  // namespace arfm_vo
