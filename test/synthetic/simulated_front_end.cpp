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
  const double row_residual_px = seen.v_right - seen.pixels.y();
  return StereoPoint{keypoint, seen.pixels, row_residual_px, sigma_px,
                     camera.TriangulateMeasured(seen.pixels.x(), seen.pixels.y(), disparity)};
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
    const Eigen::Vector3f pixels = seen.pixels.cast<float>();
    frame.features.keypoints.push_back({pixels.x(), pixels.y(), 1, 0, 1});
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
