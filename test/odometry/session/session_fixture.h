#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "arfm_vo/odometry/session.h"
#include "arfm_vo/odometry/stereo_frontend.h"
#include "ros/textured_wall.h"

namespace arfm_vo {

constexpr double kDegree = M_PI / 180;
constexpr double kInterval_s = 0.1;

/// A rover in front of a wall: base x forward, camera 1 m up on a pan axis.
class SessionTest : public testing::Test {
 protected:
  static Rigid3 BaseFromCamera(double pan_rad) {
    const Eigen::Quaterniond forward_from_optical(0.5, -0.5, 0.5, -0.5);
    return Rigid3(ExpSO3({0, 0, pan_rad}), Eigen::Vector3d(0.2, 0, 1)) *
           Rigid3(forward_from_optical, Eigen::Vector3d(0.1, 0.15, 0));
  }

  /// The next pair of a base at `x_m` on its way to the wall; `spoil` changes its pictures.
  SessionUpdate Step(double x_m, double pan_rad = 0, bool is_dark = false,
                     const std::function<void(StereoImages&)>& spoil = {}) {
    stamp_s_ += kInterval_s;
    const Rigid3 start_from_base(Eigen::Quaterniond::Identity(), Eigen::Vector3d(x_m, 0, 0));
    const Rigid3 wall_from_camera =
        BaseFromCamera(0).Inverse() * start_from_base * BaseFromCamera(pan_rad);
    StereoImages images =
        is_dark ? wall_.RenderDark(stamp_s_) : wall_.Render(stamp_s_, wall_from_camera.Inverse());
    if (spoil) spoil(images);
    return session_.Process(frontend_.Process(images), wall_.camera(), images,
                            BaseFromCamera(pan_rad));
  }

  /// The next pair of a base that sees another wall, as from `camera_from_wall`.
  SessionUpdate StepBefore(const TexturedWall& other, const Rigid3& camera_from_wall = {}) {
    return Step(0, 0, false, [&](StereoImages& images) {
      images = other.Render(images.stamp_s, camera_from_wall);
    });
  }

  /// The same as Step with a thing that moves with the camera before 40 % of the picture.
  SessionUpdate StepWithObject(double x_m) {
    const cv::Mat texture = object_.left(cv::Rect(0, 0, 300, 190));
    return Step(x_m, 0, false, [&](StereoImages& images) {
      const cv::Rect place(150, 60, 300, 190);
      texture.copyTo(images.left(place));
      texture.copyTo(images.right(place - cv::Point(40, 0)));
      TexturedWall::AddNoise(stamp_s_, images);
    });
  }

  /// Of the first keyframe, which lies a metre further ahead.
  MapUpdate MoveAhead(const SessionUpdate& first, int num_keyframes) const {
    MapUpdate update;
    update.correction = CorrectionBelief::OfCalibration(wall_.camera());
    update.num_keyframes = num_keyframes;
    const Rigid3 moved(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, -1));
    update.keyframes.push_back(
        {first.keyframe->keyframe.id, moved * first.keyframe->keyframe.camera_from_world});
    return update;
  }

  static LocalOdometryOptions Options() {
    LocalOdometryOptions options;
    options.restart_after_lost_s = 0.5;
    return options;
  }

  TexturedWall wall_;
  const StereoImages object_ = TexturedWall(5).Render(0, Rigid3());
  StereoFrontend frontend_{wall_.camera(), {}};
  Session session_{Options()};
  double stamp_s_ = 100;
};

}  // namespace arfm_vo
