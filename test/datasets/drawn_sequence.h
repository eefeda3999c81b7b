#pragma once

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "arfm_vo/base/random.h"
#include "datasets/sequence_folder.h"

namespace arfm_vo {

/// Smooth random grey texture, the same for the same seed.
inline cv::Mat DrawTexture(cv::Size size, int seed) {
  RandomEngine engine(seed);
  cv::Mat noise(size, CV_32FC1);
  for (float& value : cv::Mat_<float>(noise)) value = static_cast<float>(RandomUnit(engine));
  cv::GaussianBlur(noise, noise, {}, 2.5);
  cv::normalize(noise, noise, 0, 255, cv::NORM_MINMAX, CV_8U);
  return noise;
}

/// Draws into `folder` what a stereo camera (fx 350 px, baseline 0.5 m, 480x240) sees that moves by
/// 0.25 m a pair to its right along textured bands at different depths (exact: whole pixels).
inline void DrawSequence(const SequenceFolder& folder, int num_pairs) {
  constexpr int kWidth = 480, kBandHeight = 40, kNumBands = 6;
  std::string poses;
  for (int i = 0; i < num_pairs; ++i) {
    cv::Mat left(kBandHeight * kNumBands, kWidth, CV_8UC1), right = left.clone();
    for (int band = 0; band < kNumBands; ++band) {
      const int disparity_px = 8 + 8 * band, shift_px = disparity_px / 2 * i;
      const cv::Mat texture = DrawTexture({2 * kWidth, kBandHeight}, 100 + band);
      const cv::Range rows(band * kBandHeight, (band + 1) * kBandHeight);
      texture.colRange(shift_px, shift_px + kWidth).copyTo(left.rowRange(rows));
      texture.colRange(shift_px + disparity_px, shift_px + disparity_px + kWidth)
          .copyTo(right.rowRange(rows));
    }
    cv::imwrite(folder.Left(i), left);
    cv::imwrite(folder.Right(i), right);
    poses += "1 0 0 " + std::to_string(0.25 * i) + " 0 1 0 0 0 0 1 0\n";
  }
  folder.Write("calib.txt",
               "P0: 350 0 240 0 0 350 120 0 0 0 1 0\nP1: 350 0 240 -175 0 350 120 0 0 0 1 0\n");
  folder.Write("poses.txt", poses);
}

}  // namespace arfm_vo
