#include "synthetic/disturbances.h"

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "arfm_vo/simulation/hash_noise.h"
#include "image/image_noise.h"

namespace arfm_vo {
namespace {

/// The first pair that is disturbed where a disturbance begins during the drive.
constexpr int kObjectFrom = 15, kFrom = 20;
constexpr int kBlackPairs = 10, kFrozenPairs = 20, kRowPairs = 5;
constexpr double kNoiseLevels = 15, kDarker = 0.5, kBrighter = 2;
constexpr int kBlurPx = 11, kJpegQuality = 25, kRowShiftPx = 2;

using Apply = std::function<void(int, StereoImages&)>;

void CompressAsJpeg(cv::Mat& image) {
  std::vector<uchar> bytes;
  cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
  image = cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
}

cv::Mat ShiftedDown(const cv::Mat& image, int rows) {
  cv::Mat shifted;
  const cv::Matx23d map(1, 0, 0, 0, 1, rows);
  cv::warpAffine(image, shifted, map, image.size(), cv::INTER_NEAREST, cv::BORDER_REPLICATE);
  return shifted;
}

/// A textured rectangle before everything else, in both images.
class Object {
 public:
  /// `share` of the picture; moves by `step` px a pair; `growth` is its size's part a pair.
  Object(double share, cv::Point2d step, double growth = 0)
      : share_(share), step_(step), growth_(growth) {}

  void Paint(StereoImages& images, int age) const {
    PaintOne(images.left, age, 0);
    PaintOne(images.right, age, kDisparityPx);
  }

 private:
  static constexpr int kDisparityPx = 40, kGrainPx = 6;

  void PaintOne(cv::Mat& image, int age, int disparity_px) const {
    const double scale = 1 + growth_ * age, side = std::sqrt(share_) * scale;
    const cv::Point2d centre(0.5 * image.cols + step_.x * age - scale * disparity_px,
                             0.5 * image.rows + step_.y * age);
    const double half_width = 0.5 * side * image.cols, half_height = 0.5 * side * image.rows;
    for (int y = 0; y < image.rows; ++y) {
      const double up = y - centre.y;
      if (std::abs(up) > half_height) continue;
      for (int x = 0; x < image.cols; ++x) {
        const double along = x - centre.x;
        if (std::abs(along) <= half_width) image.at<uchar>(y, x) = Texture(along, up, scale);
      }
    }
  }
  static uchar Texture(double x, double y, double scale) {
    const double grain = kGrainPx * scale;
    const double noise = FractalNoise(x / grain + 500, y / grain + 500, 2, 0.6, 7);
    return cv::saturate_cast<uchar>(120 + 280 * noise);
  }

  double share_;
  cv::Point2d step_;
  double growth_;
};

Apply Show(const Object& object) {
  return [object](int index, StereoImages& images) {
    if (index >= kObjectFrom) object.Paint(images, index - kObjectFrom);
  };
}

/// Repeats the picture of `eye` at pair kFrom for `num_pairs`.
Apply Freeze(cv::Mat StereoImages::*eye, int num_pairs) {
  auto still = std::make_shared<cv::Mat>();
  return [=](int index, StereoImages& images) {
    if (index == kFrom) *still = (images.*eye).clone();
    if (index > kFrom && index - kFrom < num_pairs) images.*eye = still->clone();
  };
}

Apply Both(const Apply& a, const Apply& b) {
  return [=](int index, StereoImages& images) {
    a(index, images);
    b(index, images);
  };
}

Apply OnEachImage(const std::function<void(cv::Mat&)>& change) {
  return [=](int, StereoImages& images) {
    change(images.left);
    change(images.right);
  };
}

/// The right image comes `num_pairs` late.
Apply DelayRight(int num_pairs) {
  auto queue = std::make_shared<std::deque<cv::Mat>>();
  return [=](int, StereoImages& images) {
    queue->push_back(images.right);
    images.right = queue->front();
    if (static_cast<int>(queue->size()) > num_pairs) queue->pop_front();
  };
}

Apply ShiftRows(int first, int last) {
  return [=](int index, StereoImages& images) {
    if (index >= first && index < last) images.right = ShiftedDown(images.right, kRowShiftPx);
  };
}

Apply Blacken(bool left) {
  return [=](int index, StereoImages& images) {
    if (index < kFrom) return;
    if (left && index >= kFrom + kBlackPairs) return;
    images.right.setTo(0);
    if (left) images.left.setTo(0);
  };
}

Apply Noise() {
  auto random = std::make_shared<cv::RNG>(1);
  return OnEachImage([=](cv::Mat& image) { AddNoise(image, kNoiseLevels, *random); });
}

Apply AlternateExposure() {
  return [](int index, StereoImages& images) {
    for (cv::Mat* image : {&images.left, &images.right}) {
      image->convertTo(*image, CV_8U, index % 2 == 0 ? kDarker : kBrighter);
    }
  };
}

}  // namespace

std::vector<Disturbance> MakeDisturbances() {
  constexpr int kAlways = 1 << 30;
  return {
      {"none", [](int, StereoImages&) {}},
      {"noise", Noise()},
      {"blur", OnEachImage([](cv::Mat& image) {
         cv::GaussianBlur(image, image, cv::Size(kBlurPx, kBlurPx), 0);
       })},
      {"jpeg", OnEachImage(CompressAsJpeg)},
      {"rows", ShiftRows(0, kAlways)},
      {"rows-5-pairs", ShiftRows(kFrom, kFrom + kRowPairs)},
      {"exposure", AlternateExposure()},
      {"object-40", Show(Object(0.4, {0, 0}))},
      {"object-60", Show(Object(0.6, {0, 0}))},
      {"object-40-sideways", Show(Object(0.4, {4, 0}))},
      {"object-40-approaching", Show(Object(0.4, {0, 0}, 0.01))},
      {"black-10-pairs", Blacken(true)},
      {"right-black", Blacken(false)},
      {"right-frozen", Freeze(&StereoImages::right, kAlways)},
      {"right-late", DelayRight(1)},
      {"frozen-20-pairs",
       Both(Freeze(&StereoImages::left, kFrozenPairs), Freeze(&StereoImages::right, kFrozenPairs))},
      {"eyes-swapped", [](int, StereoImages& images) { std::swap(images.left, images.right); }},
  };
}

}  // namespace arfm_vo
