#include "synthetic/pair_changes.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <utility>

#include "arfm_vo/simulation/hash_noise.h"

namespace arfm_vo {
namespace {

cv::Mat ShiftedDown(const cv::Mat& image, int rows) {
  cv::Mat shifted;
  const cv::Matx23d map(1, 0, 0, 0, 1, rows);
  cv::warpAffine(image, shifted, map, image.size(), cv::INTER_NEAREST, cv::BORDER_REPLICATE);
  return shifted;
}

class Object {
 public:
  explicit Object(const ObjectOptions& options) : options_(options) {}

  void Paint(StereoImages& images, int age) const {
    PaintOne(images.left, age, 0);
    PaintOne(images.right, age, kDisparityPx);
  }

 private:
  static constexpr int kDisparityPx = 40, kGrainPx = 6;

  void PaintOne(cv::Mat& image, int age, int disparity_px) const {
    const double scale = 1 + options_.growth * age, side = std::sqrt(options_.share) * scale;
    const double swing = options_.swing_px * std::sin(age * M_PI / 10);
    const cv::Point2d centre(
        0.5 * image.cols + options_.step.x * age - scale * disparity_px + swing,
        0.5 * image.rows + options_.step.y * age);
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

  ObjectOptions options_;
};

/// `now`, whose content has come from `before`, so much of the way (0..1) back.
cv::Mat MovedBack(const cv::Mat& before, const cv::Mat& now, double part) {
  cv::Mat flow, moved;
  cv::calcOpticalFlowFarneback(before, now, flow, 0.5, 5, 21, 3, 7, 1.5, 0);
  for (int y = 0; y < flow.rows; ++y) {
    for (int x = 0; x < flow.cols; ++x) {
      auto& place = flow.at<cv::Vec2f>(y, x);
      place = cv::Vec2f(x, y) + static_cast<float>(part) * place;
    }
  }
  cv::remap(now, moved, flow, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return moved;
}

}  // namespace

PairChange Show(const ObjectOptions& options) {
  return [object = Object(options)](int index, StereoImages& images) {
    if (index >= kObjectFrom) object.Paint(images, index - kObjectFrom);
  };
}

PairChange Freeze(cv::Mat StereoImages::*side, const PairRange& pairs) {
  auto still = std::make_shared<cv::Mat>();
  return [=](int index, StereoImages& images) {
    if (index == pairs.first) *still = (images.*side).clone();
    if (index > pairs.first && pairs.Has(index)) images.*side = still->clone();
  };
}

PairChange Blacken(cv::Mat StereoImages::*side, const PairRange& pairs) {
  return [=](int index, StereoImages& images) {
    if (pairs.Has(index)) (images.*side).setTo(0);
  };
}

PairChange SwapImages(const PairRange& pairs) {
  return [=](int index, StereoImages& images) {
    if (pairs.Has(index)) std::swap(images.left, images.right);
  };
}

PairChange DelayRight(int num_pairs) {
  auto queue = std::make_shared<std::deque<cv::Mat>>();
  return [=](int, StereoImages& images) {
    queue->push_back(images.right);
    images.right = queue->front();
    if (static_cast<int>(queue->size()) > num_pairs) queue->pop_front();
  };
}

PairChange ShiftRows(int rows, const PairRange& pairs) {
  return [=](int index, StereoImages& images) {
    if (pairs.Has(index)) images.right = ShiftedDown(images.right, rows);
  };
}

PairChange AlternateExposure(double even, double odd) {
  return [=](int index, StereoImages& images) {
    OnEachImage(Multiply(index % 2 == 0 ? even : odd))(index, images);
  };
}

PairChange DriftExposure(double factor, int num_pairs) {
  return [=](int index, StereoImages& images) {
    OnEachImage(Multiply(std::pow(factor, std::min(1.0, 1. * index / num_pairs))))(index, images);
  };
}

PairChange Miss(int period) {
  return [=](int index, StereoImages& images) {
    if (index % period == period - 1) images.left.release();
  };
}

PairChange Miss(const PairRange& pairs) {
  return [=](int index, StereoImages& images) {
    if (pairs.Has(index)) images.left.release();
  };
}

PairChange MissUntimed(int num, int period) {
  auto stamps_s = std::make_shared<std::deque<double>>();
  return [=](int index, StereoImages& images) {
    stamps_s->push_back(images.stamp_s);
    if (index % period >= period - num) {
      images.left.release();
    } else {
      images.stamp_s = stamps_s->front();
      stamps_s->pop_front();
    }
  };
}

PairChange Skew(double skew_s) {
  auto before = std::make_shared<StereoImages>();
  return [=](int, StereoImages& images) {
    const cv::Mat now = images.right;
    if (!before->right.empty())
      images.right = MovedBack(before->right, now, skew_s / (images.stamp_s - before->stamp_s));
    before->right = now;
    before->stamp_s = images.stamp_s;
  };
}

void TurnView(cv::Mat& image, const cv::Matx33d& projection, const cv::Vec3d& turn,
              int interpolation) {
  cv::Matx33d rotation;
  cv::Rodrigues(turn, rotation);
  const cv::Mat before = image;
  image = cv::Mat();  // others may hold the same pixels
  cv::warpPerspective(before, image, projection * rotation * projection.inv(), before.size(),
                      interpolation, cv::BORDER_REPLICATE);
}

PairChange TurnRight(const cv::Vec3d& turn, const PairRange& pairs) {
  return [=](int index, StereoImages& images) {
    if (index <= pairs.first) return;
    const cv::Size size = images.right.size();
    // The turn moves the picture alike whatever the focal length is, but for its size: that of
    // KITTI's cameras, over the width.
    const double focal_px = 0.58 * size.width;
    const cv::Matx33d camera(focal_px, 0, 0.5 * size.width, 0, focal_px, 0.5 * size.height, 0, 0,
                             1);
    const double part = std::min(1., 1. * (index - pairs.first) / (pairs.last - pairs.first));
    TurnView(images.right, camera, turn * part, cv::INTER_LINEAR);
  };
}

}  // namespace arfm_vo
