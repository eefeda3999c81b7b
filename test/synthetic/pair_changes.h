#pragma once

#include <opencv2/core.hpp>

#include "synthetic/disturbances.h"

namespace arfm_vo {

/// The pairs that a change which does not last all the time begins with, and ends before.
struct PairRange {
  int first = 0, last = 1 << 30;
  bool Has(int index) const { return index >= first && index < last; }
};

using ImageChange = std::function<void(cv::Mat&)>;
PairChange OnEachImage(const ImageChange& change);
PairChange OnSide(cv::Mat StereoImages::*side, const ImageChange& change);
PairChange Both(const PairChange& a, const PairChange& b);

// Of an image.
ImageChange Blur(int size_px);
ImageChange SmearSideways(int size_px);  ///< as motion does
ImageChange CompressAsJpeg(int quality);
ImageChange AddNoiseOf(double grey_levels);
ImageChange Multiply(double factor);
ImageChange Flatten(double factor);         ///< its contrast, about the mean
ImageChange KillRows(double share);         ///< rows that stay black, the same always
ImageChange KillColumns(double share);      ///< columns that stay white
ImageChange Dirty(double share, int seed);  ///< blurred, greyish patches that stay where they are
ImageChange DrawGlare(double radius);       ///< of the picture's height: white in the upper middle
ImageChange DrawRain(int num_streaks);      ///< others in each image

// Of the pairs.
PairChange Freeze(cv::Mat StereoImages::*side, const PairRange& pairs);
PairChange Blacken(cv::Mat StereoImages::*side, const PairRange& pairs);
PairChange SwapImages(const PairRange& pairs);
PairChange DelayRight(int num_pairs);
PairChange ShiftRows(int rows, const PairRange& pairs);  ///< of the right image, down
PairChange AlternateExposure(double even, double odd);
/// The factor goes from 1 to `factor` within `num_pairs`.
PairChange DriftExposure(double factor, int num_pairs);
/// Of each `period` pairs the last one does not come.
PairChange Miss(int period);
PairChange Miss(const PairRange& pairs);
/// Of each `period` pairs the last `num` do not come, and the stamps know nothing of it.
PairChange MissUntimed(int num, int period);
/// The right image is taken so much before the left one: what moved between this pair and the one
/// before is moved back by its part of the time, by dense optical flow.
PairChange Skew(double skew_s);
/// The image becomes what a camera with this projection sees once it has turned: rotation vector in
/// its optical frame, rad.
void TurnView(cv::Mat& image, const cv::Matx33d& projection, const cv::Vec3d& turn,
              int interpolation);
/// The right camera turns by so much from the first of `pairs` to the last, and stays so: rotation
/// vector in its optical frame, rad.
PairChange TurnRight(const cv::Vec3d& turn, const PairRange& pairs);

/// A textured rectangle before everything else, in both images, from pair kObjectFrom on.
struct ObjectOptions {
  double share = 0.4;      ///< of the picture
  cv::Point2d step{0, 0};  ///< px a pair
  double growth = 0;       ///< of its size, a pair
  double swing_px = 0;     ///< to and fro sideways, in 20 pairs
};
PairChange Show(const ObjectOptions& object);

/// The first pair that is disturbed where a disturbance begins during the drive.
constexpr int kObjectFrom = 15, kFrom = 20;

}  // namespace arfm_vo
