#include "recordings/view_transform.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace arfm_vo {
namespace {

/// The axes of the camera that `swap` leaves: a reflection for kMirrored.
Eigen::Vector3d Axes(ImageSwap swap) {
  if (swap == ImageSwap::kMirrored) return {-1, 1, 1};
  if (swap == ImageSwap::kTurned) return {-1, -1, 1};
  return {1, 1, 1};
}

int Scaled(int size, double scale) { return static_cast<int>(std::lround(size * scale)); }

}  // namespace

StereoCamera ViewTransform::Apply(const StereoCamera& camera) const {
  StereoCamera view = camera;
  view.width -= crop_left + crop_right;
  view.height -= crop_top + crop_bottom;
  view.cx -= crop_left;
  view.cy -= crop_top;
  // The sizes are whole pixels: the true scale is theirs, another one along each side.
  const int width = Scaled(view.width, scale), height = Scaled(view.height, scale);
  const double scale_u = static_cast<double>(width) / view.width;
  const double scale_v = static_cast<double>(height) / view.height;
  view.width = width;
  view.height = height;
  view.fx *= scale_u;
  view.fy *= scale_v;
  view.cx = (view.cx + 0.5) * scale_u - 0.5;  // the outer border of the picture stays
  view.cy = (view.cy + 0.5) * scale_v - 0.5;
  if (swap != ImageSwap::kNone) view.cx = view.width - 1 - view.cx;
  if (swap == ImageSwap::kTurned) view.cy = view.height - 1 - view.cy;
  return view;
}

StereoImages ViewTransform::Apply(const StereoImages& images, const StereoCamera& camera) const {
  const cv::Rect kept(crop_left, crop_top, camera.width - crop_left - crop_right,
                      camera.height - crop_top - crop_bottom);
  const cv::Size size(Scaled(kept.width, scale), Scaled(kept.height, scale));
  const auto change = [&](const cv::Mat& image) {
    cv::Mat changed = image(kept).clone();
    if (size != changed.size()) cv::resize(changed, changed, size, 0, 0, cv::INTER_AREA);
    if (swap == ImageSwap::kMirrored) cv::flip(changed, changed, 1);
    if (swap == ImageSwap::kTurned) cv::flip(changed, changed, -1);
    return changed;
  };
  StereoImages view{images.stamp_s, change(images.left), change(images.right)};
  if (swap != ImageSwap::kNone) std::swap(view.left, view.right);
  return view;
}

Eigen::Vector3d ViewTransform::ApplyToPoint(const Eigen::Vector3d& x_in_left,
                                            double baseline_m) const {
  const double shift =
      swap == ImageSwap::kNone ? 0 : baseline_m;  // the right camera becomes the left
  return Axes(swap).cwiseProduct(x_in_left - Eigen::Vector3d(shift, 0, 0));
}

Rigid3 ViewTransform::Apply(const Rigid3& world_from_left, double baseline_m) const {
  // With A the axes and b the shift, x' = A (x - b): R' = A R A, t' = A (R b + t - b).
  const Eigen::Matrix3d axes = Axes(swap).asDiagonal();
  const Eigen::Vector3d shift(swap == ImageSwap::kNone ? 0 : baseline_m, 0, 0);
  return {Eigen::Matrix3d(axes * world_from_left.RotationMatrix() * axes),
          Eigen::Vector3d(axes * (world_from_left * shift - shift))};
}

std::string ToString(ImageSwap swap) {
  return swap == ImageSwap::kMirrored ? "mirrored" : swap == ImageSwap::kTurned ? "turned" : "none";
}

std::string ViewTransform::CutName() const {
  const bool is_cropped = crop_left + crop_right + crop_top + crop_bottom > 0;
  if (scale == 1) return is_cropped ? "crop" : "none";
  return is_cropped ? "crop+scale" : "scale";
}

}  // namespace arfm_vo
