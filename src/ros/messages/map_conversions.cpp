#include "arfm_vo/base/array_checks.h"
#include "arfm_vo/ros/messages/conversions.h"

namespace arfm_vo {
namespace {

constexpr int kDescriptorLength = 64;

LandmarkObservations ImportObservations(const KeyframeStamped& message) {
  const size_t size = message.observation_landmark.size();
  RequireNumbers(message.observation_pixels, 4 * size, "observation_pixels");
  RequireNumbers(message.observation_sigma, size, "observation_sigma");
  RequireSize(message.observation_has_right, size, "observation_has_right");
  RequireAscending(message.observation_landmark, "observation_landmark");
  const auto [width, height] = std::pair(message.camera.width, message.camera.height);
  LandmarkObservations observations(size);
  for (size_t i = 0; i < size; ++i) {
    observations[i].landmark = message.observation_landmark[i];
    observations[i].pixels =
        Eigen::Map<const Eigen::Vector4d>(&message.observation_pixels[4 * i]).cast<float>();
    observations[i].has_right = message.observation_has_right[i];
    observations[i].sigma_px = message.observation_sigma[i];
    RequireElement(observations[i].sigma_px > 0, "observation_sigma", i, "is not positive");
    const Eigen::Vector4f& seen = observations[i].pixels;
    RequireInImage(seen[0], seen[1], width, height, "observation_pixels", 4 * i);
    if (observations[i].has_right)
      RequireInImage(seen[2], seen[3], width, height, "observation_pixels", 4 * i + 2);
  }
  return observations;
}

Eigen::Matrix<double, 6, 6> ImportCovariance(const KeyframeStamped& message) {
  RequireFinite(message.step_covariance, "step_covariance");
  using RowMajor = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  const Eigen::Matrix<double, 6, 6> covariance =
      Eigen::Map<const RowMajor>(message.step_covariance.data());
  Require(covariance.diagonal().minCoeff() >= 0, "step_covariance has a negative variance");
  return (covariance + covariance.transpose()) / 2;
}

std::optional<RightTurn> ImportTurn(const KeyframeStamped& message) {
  const size_t size = message.right_turn.empty() ? 0 : 3;
  RequireNumbers(message.right_turn, size, "right_turn");
  RequireNumbers(message.right_turn_covariance, 3 * size, "right_turn_covariance");
  if (size == 0) return std::nullopt;
  RightTurn turn{Eigen::Map<const Eigen::Vector3d>(message.right_turn.data()),
                 Eigen::Map<const Eigen::Matrix3d>(message.right_turn_covariance.data())};
  Require(turn.covariance.diagonal().minCoeff() > 0,
          "right_turn_covariance has a variance that is not positive");
  return turn;
}

std::vector<Landmark> ImportLandmarks(const KeyframeStamped& message) {
  const size_t size = message.landmark_id.size();
  RequireNumbers(message.landmark_position, 3 * size, "landmark_position");
  RequireNumbers(message.landmark_descriptors, kDescriptorLength * size, "landmark_descriptors");
  RequireSize(message.landmark_laplacian_sign, size, "landmark_laplacian_sign");
  std::vector<Landmark> landmarks(size);
  for (size_t i = 0; i < size; ++i) {
    landmarks[i].id = message.landmark_id[i];
    landmarks[i].x_in_world = Eigen::Map<const Eigen::Vector3d>(&message.landmark_position[3 * i]);
    landmarks[i].keypoint.laplacian_sign = message.landmark_laplacian_sign[i];
    std::copy_n(message.landmark_descriptors.begin() + kDescriptorLength * i, kDescriptorLength,
                landmarks[i].descriptor.begin());
  }
  return landmarks;
}

CorrectionBelief ImportCorrection(const MapUpdateStamped& message) {
  constexpr size_t kSize = StereoCorrection::kSize;
  RequireNumbers(message.correction_px, kSize, "correction_px");
  RequireNumbers(message.correction_covariance, kSize * kSize, "correction_covariance");
  CorrectionBelief correction;
  correction.mean.coefficients_px =
      Eigen::Map<const StereoCorrection::Coefficients>(message.correction_px.data());
  correction.covariance =
      Eigen::Map<const CorrectionBelief::Matrix>(message.correction_covariance.data());
  Require(correction.covariance.diagonal().minCoeff() > 0,
          "correction_covariance has a variance that is not positive");
  return correction;
}

}  // namespace

KeyframeStamped ToMessage(const PlacedKeyframe& keyframe) {
  const Keyframe& seen = keyframe.keyframe;
  KeyframeStamped message;
  message.header.stamp.fromSec(seen.stamp_s);
  message.epoch = keyframe.epoch;
  message.camera = ToMessage(keyframe.camera);
  message.odom_from_world = ToTransformMessage(keyframe.odom_from_world);
  message.base_from_camera = ToTransformMessage(keyframe.base_from_camera);
  message.id = seen.id;
  message.camera_from_world = ToTransformMessage(seen.camera_from_world);
  message.step_covariance = ToCovarianceMessage(seen.step_covariance);
  if (const auto& turn = seen.right_turn) {
    message.right_turn.assign(turn->turn_rad.data(), turn->turn_rad.data() + 3);
    message.right_turn_covariance.assign(turn->covariance.data(), turn->covariance.data() + 9);
  }
  for (const LandmarkObservation& observation : seen.observations) {
    message.observation_landmark.push_back(observation.landmark);
    for (int i = 0; i < 4; ++i)
      message.observation_pixels.push_back(i < 2 || observation.has_right ? observation.pixels[i]
                                                                          : 0);
    message.observation_has_right.push_back(observation.has_right);
    message.observation_sigma.push_back(observation.sigma_px);
  }
  for (const Landmark& landmark : keyframe.landmarks) {
    message.landmark_id.push_back(landmark.id);
    for (int i = 0; i < 3; ++i) message.landmark_position.push_back(landmark.x_in_world[i]);
    message.landmark_laplacian_sign.push_back(landmark.keypoint.laplacian_sign);
    message.landmark_descriptors.insert(message.landmark_descriptors.end(),
                                        landmark.descriptor.begin(), landmark.descriptor.end());
  }
  return message;
}

PlacedKeyframe FromMessage(const KeyframeStamped& message) {
  PlacedKeyframe keyframe;
  keyframe.epoch = message.epoch;
  keyframe.camera = FromMessage(message.camera);
  keyframe.keyframe.id = message.id;
  keyframe.keyframe.stamp_s = message.header.stamp.toSec();
  Within("KeyframeStamped", [&] {
    keyframe.odom_from_world = FromMessage(message.odom_from_world, "odom_from_world");
    keyframe.base_from_camera = FromMessage(message.base_from_camera, "base_from_camera");
    keyframe.keyframe.camera_from_world =
        FromMessage(message.camera_from_world, "camera_from_world");
    keyframe.keyframe.step_covariance = ImportCovariance(message);
    keyframe.keyframe.right_turn = ImportTurn(message);
    keyframe.keyframe.observations = ImportObservations(message);
    keyframe.landmarks = ImportLandmarks(message);
  });
  return keyframe;
}

MapUpdateStamped ToMessage(const MapUpdate& update) {
  MapUpdateStamped message;
  for (const MapUpdate::KeyframePose& keyframe : update.keyframes) {
    message.keyframe_id.push_back(keyframe.id);
    message.camera_from_world.push_back(ToTransformMessage(keyframe.camera_from_world));
  }
  for (const MapUpdate::LandmarkPosition& landmark : update.landmarks) {
    message.landmark_id.push_back(landmark.id);
    for (int i = 0; i < 3; ++i) message.landmark_position.push_back(landmark.x_in_world[i]);
  }
  const auto& mean = update.correction.mean.coefficients_px;
  const auto& covariance = update.correction.covariance;
  message.correction_px.assign(mean.data(), mean.data() + mean.size());
  message.correction_covariance.assign(covariance.data(), covariance.data() + covariance.size());
  message.num_keyframes = update.num_keyframes;
  return message;
}

MapUpdate FromMessage(const MapUpdateStamped& message) {
  return Within("MapUpdateStamped", [&] {
    RequireSize(message.camera_from_world, message.keyframe_id.size(), "camera_from_world");
    RequireNumbers(message.landmark_position, 3 * message.landmark_id.size(), "landmark_position");
    RequireAscending(message.keyframe_id, "keyframe_id");
    RequireAscending(message.landmark_id, "landmark_id");
    MapUpdate update;
    for (size_t i = 0; i < message.keyframe_id.size(); ++i)
      update.keyframes.push_back(
          {message.keyframe_id[i], FromMessage(message.camera_from_world[i],
                                               "camera_from_world[" + std::to_string(i) + "]")});
    for (size_t i = 0; i < message.landmark_id.size(); ++i)
      update.landmarks.push_back({message.landmark_id[i], Eigen::Map<const Eigen::Vector3d>(
                                                              &message.landmark_position[3 * i])});
    update.correction = ImportCorrection(message);
    update.num_keyframes = message.num_keyframes;
    Require(!update.keyframes.empty(), "keyframe_id is empty");
    Require(update.num_keyframes > 0, "num_keyframes must be positive");
    return update;
  });
}

}  // namespace arfm_vo
