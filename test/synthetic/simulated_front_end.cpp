#include "synthetic/simulated_front_end.h"

#include <algorithm>
#include <optional>

namespace arfm_vo {
namespace {

constexpr double kMinDisparity_px = -2;

std::optional<StereoPoint> MakePoint(const StereoCamera& camera, const SimulatedObservation& seen,
                                     int keypoint, double sigma_px) {
  const double disparity = seen.pixels.x() - seen.pixels.z();
  if (disparity < kMinDisparity_px) return std::nullopt;
  StereoPoint point;
  point.keypoint = keypoint;
  point.observation = seen.pixels;
  point.row_residual_px = seen.v_right - seen.pixels.y();
  point.sigma_px = sigma_px;
  point.x_in_camera = camera.TriangulateMeasured(seen.pixels.x(), seen.pixels.y(), disparity);
  return point;
}

}  // namespace

StereoFrame MakeStereoFrame(const StereoCamera& camera, const SimulatedFrame& simulated,
                            double stamp_s, double sigma_px, double descriptor_noise,
                            ObservationSimulator& simulator) {
  StereoFrame frame;
  frame.stamp_s = stamp_s;
  const int count = static_cast<int>(simulated.observations.size());
  frame.num_right_keypoints = count;
  frame.features.descriptors.create(count, 64, CV_32F);
  for (int i = 0; i < count; ++i) {
    const SimulatedObservation& seen = simulated.observations[i];
    Keypoint keypoint;
    keypoint.x = static_cast<float>(seen.pixels.x());
    keypoint.y = static_cast<float>(seen.pixels.y());
    keypoint.scale = 1;
    keypoint.response = 1;
    frame.features.keypoints.push_back(keypoint);
    const auto descriptor = simulator.Describe(seen.landmark_id, descriptor_noise);
    std::copy(descriptor.begin(), descriptor.end(), frame.features.descriptors.ptr<float>(i));

    if (const auto point = MakePoint(camera, seen, i, sigma_px)) frame.points.push_back(*point);
  }
  return frame;
}

LocalOdometryOptions WithoutImages(LocalOdometryOptions options, double sigma_px) {
  options.tracker.align_patches = false;
  options.tracker.matching.keypoint_sigma = sigma_px;
  options.tracker.matching.max_scale_ratio = 1e6;
  return options;
}

}  // namespace arfm_vo
