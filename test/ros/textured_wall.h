#pragma once

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/image/stereo_images.h"
#include "image/image_noise.h"

namespace arfm_vo {

/// A wall with blobs at z = 6 m of the world, seen by a stereo camera at any pose: the smallest
/// scene that the whole odometry can be run on.
class TexturedWall {
 public:
  /// `period_m`: after so much downwards it repeats itself; 0: it does not.
  explicit TexturedWall(int seed = 1, double period_m = 0) {
    cv::RNG random(seed);
    texture_.create(1600, 2400, CV_8UC1);
    texture_ = 110;
    for (int i = 0; i < 4000; ++i)
      cv::circle(texture_, {random.uniform(0, texture_.cols), random.uniform(0, texture_.rows)},
                 random.uniform(4, 24), cv::Scalar(random.uniform(20, 235)), cv::FILLED);
    cv::GaussianBlur(texture_, texture_, {}, 1.5);
    const int period = static_cast<int>(period_m * kTexelsPerMetre);
    for (int y = period; period > 0 && y < texture_.rows; ++y) {
      texture_.row(y - period).copyTo(texture_.row(y));
    }
  }

  const StereoCamera& camera() const { return camera_; }

  StereoImages Render(double stamp_s, const Rigid3& camera_from_world) const {
    const Rigid3 right_from_left(Eigen::Quaterniond::Identity(),
                                 Eigen::Vector3d(-camera_.baseline_m, 0, 0));
    StereoImages images{stamp_s, RenderSide(camera_from_world),
                        RenderSide(right_from_left * camera_from_world)};
    AddNoise(stamp_s, images);
    return images;
  }

  /// What pixels of a camera do: no two pictures are the same.
  static void AddNoise(double stamp_s, StereoImages& images) {
    cv::RNG random(static_cast<uint64_t>(1e6 * stamp_s) + 1);
    for (cv::Mat* image : {&images.left, &images.right}) arfm_vo::AddNoise(*image, 0.5, random);
  }

  /// What a covered lens sees.
  StereoImages RenderDark(double stamp_s) const {
    const cv::Mat dark = cv::Mat::zeros(camera_.height, camera_.width, CV_8UC1);
    return {stamp_s, dark, dark.clone()};
  }

 private:
  static constexpr double kTexelsPerMetre = 100;

  cv::Mat RenderSide(const Rigid3& camera_from_world) const {
    constexpr double kDistance_m = 6;
    // The homography from the wall's (x, y) to pixels, after that from texels to (x, y).
    Eigen::Matrix3d intrinsics;
    intrinsics << camera_.fx, 0, camera_.cx, 0, camera_.fy, camera_.cy, 0, 0, 1;
    Eigen::Matrix3d wall = camera_from_world.RotationMatrix();
    wall.col(2) = wall.col(2) * kDistance_m + camera_from_world.translation;
    Eigen::Matrix3d wall_from_texel;
    wall_from_texel << 1 / kTexelsPerMetre, 0, -texture_.cols / (2 * kTexelsPerMetre), 0,
        1 / kTexelsPerMetre, -texture_.rows / (2 * kTexelsPerMetre), 0, 0, 1;
    const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> pixel_from_texel =
        intrinsics * wall * wall_from_texel;
    cv::Mat image;
    cv::warpPerspective(texture_, image,
                        cv::Mat(3, 3, CV_64FC1, const_cast<double*>(pixel_from_texel.data())),
                        {camera_.width, camera_.height}, cv::INTER_LINEAR, cv::BORDER_REFLECT);
    return image;
  }

  StereoCamera camera_{300, 300, 240, 150, 0.3, 480, 300};
  cv::Mat texture_;
};

}  // namespace arfm_vo
