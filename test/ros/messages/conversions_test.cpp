#include "arfm_vo/ros/messages/conversions.h"

#include <gmock/gmock.h>

#include <functional>
#include <limits>
#include <opencv2/core.hpp>
#include <utility>
#include <vector>

#include "base/refusal.h"

namespace arfm_vo {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const StereoCamera kCamera{700.25, 710.5, 600.125, 180.75, 0.54, 1226, 370};
const Rigid3 kMotion(ExpSO3({0.1, -0.2, 0.3}), Eigen::Vector3d(1, -2, 3));

StereoFrame MakeFrame() {
  StereoFrame frame;
  frame.stamp_s = 12.5;
  frame.features.descriptors.create(3, 64, CV_32FC1);
  for (int i = 0; i < 3; ++i) {
    frame.features.keypoints.push_back(
        {10.5f + i, 20.25f + i, 2.5f, 0.125f * i, 99.5f, int8_t(i == 1 ? -1 : 1)});
    for (int j = 0; j < 64; ++j) frame.features.descriptors.at<float>(i, j) = 100.f * i + j;
  }
  frame.points.push_back({0, {10.5, 20.25, 3.0}, 0.25, 0.5, {1, 2, 30}, {0.125, 0.25}});
  frame.points.push_back({2, {12.5, 22.25, 4.0}, -0.75, 1.5, {4, 5, 60}, {0, 0.5}});
  frame.num_right_keypoints = 7;
  frame.right_is_repeated = true;
  frame.images_are_swapped = true;
  frame.grey = {101.5, 2500.25};
  frame.ratio_threshold = 0.8125;
  return frame;
}

PlacedKeyframe MakeKeyframe() {
  PlacedKeyframe keyframe;
  keyframe.keyframe.id = 4;
  keyframe.keyframe.stamp_s = 12.5;
  keyframe.keyframe.camera_from_world = kMotion;
  keyframe.keyframe.step_covariance.setConstant(0.25);
  keyframe.keyframe.observations.push_back({{{1, 2, 3, 4}, true, 0.5}, 1});
  keyframe.keyframe.observations.push_back({{{5, 6, kNaN, kNaN}, false, 1}, int64_t(1) << 40});
  Landmark landmark;
  landmark.id = int64_t(1) << 40;
  landmark.x_in_world = {7, 8, 9};
  landmark.keypoint.laplacian_sign = -1;
  for (int i = 0; i < 64; ++i) landmark.descriptor[i] = 0.5f * i;
  keyframe.landmarks.push_back(landmark);
  keyframe.epoch = 3;
  keyframe.camera = kCamera;
  keyframe.odom_from_world = kMotion.Inverse();
  keyframe.base_from_camera = kMotion * kMotion;
  return keyframe;
}

MapUpdate MakeUpdate() {
  MapUpdate update;
  update.keyframes = {{2, kMotion}, {5, kMotion.Inverse()}};
  update.landmarks = {{7, {1, 2, 3}}, {9, {4, 5, 6}}};
  update.correction = CorrectionBelief::Isotropic(0.5);
  update.correction.mean.coefficients_px.setLinSpaced(0.1, 0.9);
  update.num_keyframes = 6;
  return update;
}

void ExpectEqual(const Rigid3& a, const Rigid3& b) {
  EXPECT_EQ(a.translation, b.translation);
  EXPECT_EQ(a.rotation.coeffs(), b.rotation.coeffs());
}

TEST(Conversions, AStereoFrameSurvivesTheRoundTripToTheLastBit) {
  const StereoFrame frame = MakeFrame();
  const StereoFrame back = FromMessage(ToMessage(frame, kCamera));
  EXPECT_EQ(back.stamp_s, frame.stamp_s);
  ASSERT_EQ(back.features.size(), 3);
  for (int i = 0; i < 3; ++i) {
    const Keypoint &a = back.features.keypoints[i], &b = frame.features.keypoints[i];
    EXPECT_EQ(std::tie(a.x, a.y, a.scale, a.angle, a.response, a.laplacian_sign),
              std::tie(b.x, b.y, b.scale, b.angle, b.response, b.laplacian_sign));
  }
  EXPECT_EQ(cv::norm(back.features.descriptors, frame.features.descriptors, cv::NORM_INF), 0);
  ASSERT_EQ(back.points.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(back.points[i].keypoint, frame.points[i].keypoint);
    EXPECT_EQ(back.points[i].observation, frame.points[i].observation);
    EXPECT_EQ(back.points[i].row_residual_px, frame.points[i].row_residual_px);
    EXPECT_EQ(back.points[i].sigma_px, frame.points[i].sigma_px);
    EXPECT_EQ(back.points[i].x_in_camera, frame.points[i].x_in_camera);
    EXPECT_EQ(back.points[i].disparity_gradient, frame.points[i].disparity_gradient);
  }
  EXPECT_EQ(back.num_right_keypoints, 7);
  EXPECT_TRUE(!back.left_is_repeated && back.right_is_repeated && back.images_are_swapped);
  EXPECT_EQ(std::tie(back.grey.mean, back.grey.variance), std::make_tuple(101.5, 2500.25));
  EXPECT_EQ(back.ratio_threshold, 0.8125);
  EXPECT_EQ(FromMessage(ToMessage(StereoFrame{}, kCamera)).features.size(), 0);
}

TEST(Conversions, ACameraSurvives) { EXPECT_TRUE(FromMessage(ToMessage(kCamera)) == kCamera); }

TEST(Conversions, AKeyframeSurvives) {
  const PlacedKeyframe keyframe = MakeKeyframe();
  const PlacedKeyframe back = FromMessage(ToMessage(keyframe));
  EXPECT_EQ(back.epoch, 3u);
  EXPECT_EQ(back.keyframe.id, 4);
  EXPECT_EQ(back.keyframe.stamp_s, 12.5);
  ExpectEqual(back.keyframe.camera_from_world, keyframe.keyframe.camera_from_world);
  EXPECT_EQ(back.keyframe.step_covariance, keyframe.keyframe.step_covariance);
  ExpectEqual(back.odom_from_world, keyframe.odom_from_world);
  ExpectEqual(back.base_from_camera, keyframe.base_from_camera);
  ASSERT_EQ(back.keyframe.observations.size(), 2u);
  EXPECT_EQ(back.keyframe.observations[0].pixels, Eigen::Vector4f(1, 2, 3, 4));
  EXPECT_TRUE(back.keyframe.observations[0].has_right);
  EXPECT_EQ(back.keyframe.observations[0].sigma_px, 0.5);
  EXPECT_EQ(back.keyframe.observations[1].landmark, int64_t(1) << 40);
  EXPECT_FALSE(back.keyframe.observations[1].has_right);
  ASSERT_EQ(back.landmarks.size(), 1u);
  EXPECT_EQ(back.landmarks[0].id, int64_t(1) << 40);
  EXPECT_EQ(back.landmarks[0].x_in_world, Eigen::Vector3d(7, 8, 9));
  EXPECT_EQ(back.landmarks[0].keypoint.laplacian_sign, -1);
  EXPECT_EQ(back.landmarks[0].descriptor, keyframe.landmarks[0].descriptor);
}

TEST(Conversions, AMapUpdateSurvives) {
  const MapUpdate update = MakeUpdate();
  const MapUpdate back = FromMessage(ToMessage(update));
  ASSERT_EQ(back.keyframes.size(), 2u);
  EXPECT_EQ(back.keyframes[1].id, 5);
  ExpectEqual(back.keyframes[1].camera_from_world, kMotion.Inverse());
  ASSERT_EQ(back.landmarks.size(), 2u);
  EXPECT_EQ(back.landmarks[1].id, 9);
  EXPECT_EQ(back.landmarks[1].x_in_world, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(back.correction.mean.coefficients_px, update.correction.mean.coefficients_px);
  EXPECT_EQ(back.correction.covariance, update.correction.covariance);
  EXPECT_EQ(back.num_keyframes, 6);
}

/// Spoils a good message in each way; its conversion is to complain of it so.
template <class Message>
void ExpectRefused(
    const Message& good,
    const std::vector<std::pair<const char*, std::function<void(Message&)>>>& complaints) {
  FromMessage(good);
  for (const auto& [complaint, spoil] : complaints) {
    Message message = good;
    spoil(message);
    EXPECT_INVALID(FromMessage(message), complaint);
  }
}

TEST(Conversions, AMalformedStereoFrameIsRefusedByName) {
  ExpectRefused(
      ToMessage(MakeFrame(), kCamera),
      {{"keypoint_y holds 2 values, 3 expected", [](auto& m) { m.keypoint_y.pop_back(); }},
       {"descriptors holds 191 values, 192 expected", [](auto& m) { m.descriptors.pop_back(); }},
       {"keypoint_x[1] is not a finite number", [](auto& m) { m.keypoint_x[1] = kNaN; }},
       {"keypoint_x[1] lies outside the image", [](auto& m) { m.keypoint_x[1] = -1e9f; }},
       {"keypoint_y[2] lies outside the image", [](auto& m) { m.keypoint_y[2] = 1e9f; }},
       {"keypoint_scale[0] must be positive", [](auto& m) { m.keypoint_scale[0] = 0; }},
       {"point_position[5] is behind the camera", [](auto& m) { m.point_position[5] = -1; }},
       {"point_sigma[0] is not positive", [](auto& m) { m.point_sigma[0] = 0; }},
       {"descriptors[70] is not a finite number", [](auto& m) { m.descriptors[70] = kNaN; }},
       {"point_keypoint[0] is the number of no keypoint", [](auto& m) { m.point_keypoint[0] = 3; }},
       {"point_keypoint[1] is the number of no keypoint",
        [](auto& m) { m.point_keypoint[1] = -1; }},
       {"point_position holds 5 values, 6 expected", [](auto& m) { m.point_position.pop_back(); }},
       {"point_observation[3] lies outside the image",
        [](auto& m) { m.point_observation[4] = -2; }},
       {"point_observation[5] lies outside the image",
        [](auto& m) { m.point_observation[5] = 1e6; }},
       {"point_observation[2] is not a finite number",
        [](auto& m) { m.point_observation[2] = 1 / 0.0; }}});
}

TEST(Conversions, AStereoFrameWhoseSummaryIsWrongIsRefusedByName) {
  ExpectRefused(
      ToMessage(MakeFrame(), kCamera),
      {{"row_agreement must be in 0..1", [](auto& m) { m.row_agreement = kNaN; }},
       {"row_agreement must be in 0..1", [](auto& m) { m.row_agreement = 1.01; }},
       {"ratio_threshold must be in 0..1", [](auto& m) { m.ratio_threshold = -0.1; }},
       {"grey_mean must be in 0..255", [](auto& m) { m.grey_mean = 256; }},
       {"grey_variance must be in 0..65025", [](auto& m) { m.grey_variance = kNaN; }},
       {"num_right_keypoints is larger", [](auto& m) { m.num_right_keypoints = 0xFFFFFFFF; }},
       {"stage_ms[0] is not a finite number", [](auto& m) { m.stage_ms = {kNaN}; }},
       {"stage_names holds 0 values, 1 expected", [](auto& m) { m.stage_ms = {1}; }}});
}

TEST(Conversions, AMalformedKeyframeIsRefusedByName) {
  ExpectRefused(
      ToMessage(MakeKeyframe()),
      {{"observation_pixels holds 7 values, 8 expected",
        [](auto& m) { m.observation_pixels.pop_back(); }},
       {"observation_pixels[4] lies outside the image",
        [](auto& m) { m.observation_pixels[5] = 1e6; }},
       {"observation_pixels[2] lies outside the image",
        [](auto& m) { m.observation_pixels[2] = -2; }},
       {"observation_landmark[1] does not rise", [](auto& m) { m.observation_landmark[1] = 1; }},
       {"observation_sigma[0] is not positive", [](auto& m) { m.observation_sigma[0] = 0; }},
       {"step_covariance[7] is not", [](auto& m) { m.step_covariance[7] = kNaN; }},
       {"step_covariance has a neg", [](auto& m) { m.step_covariance[7] = -1; }},
       {"right_turn holds 1 values, 3 expected", [](auto& m) { m.right_turn = {1}; }},
       {"right_turn_covariance holds 0 values, 9 expected",
        [](auto& m) {
          m.right_turn = {0, 0, 0};
        }},
       {"right_turn_covariance has a variance that is not positive",
        [](auto& m) {
          m.right_turn = {0, 0, 0};
          m.right_turn_covariance.assign(9, 0);
        }},
       {"landmark_descriptors holds 63 values, 64 expected",
        [](auto& m) { m.landmark_descriptors.pop_back(); }},
       {"base_from_camera is not finite", [](auto& m) { m.base_from_camera.translation.y = kNaN; }},
       {"odom_from_world: the rotation is no unit quaternion",
        [](auto& m) { m.odom_from_world.rotation = {}; }},
       {"baseline", [](auto& m) { m.camera.baseline_m = 540; }}});
}

TEST(Conversions, AMalformedMapUpdateIsRefusedByName) {
  ExpectRefused(
      ToMessage(MakeUpdate()),
      {{"camera_from_world holds 1 values, 2 expected",
        [](auto& m) { m.camera_from_world.pop_back(); }},
       {"camera_from_world[1]: the rotation",
        [](auto& m) { m.camera_from_world[1].rotation.w = 2; }},
       {"keyframe_id[1] does not rise", [](auto& m) { m.keyframe_id[1] = 2; }},
       {"landmark_position[5] is not a finite number",
        [](auto& m) { m.landmark_position[5] = kNaN; }},
       {"correction_px[3] is not a finite number", [](auto& m) { m.correction_px[3] = kNaN; }}});
}

TEST(Conversions, ACovarianceMessageIsRowByRow) {
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  covariance(1, 3) = 7;
  EXPECT_EQ(ToCovarianceMessage(covariance)[9], 7);
}

}  // namespace
}  // namespace arfm_vo
