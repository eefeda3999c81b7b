#include "synthetic/observation_simulator.h"

#include <cmath>
#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/geometry/right_shift.h"
#include "base/random_normal.h"

namespace arfm_vo {
namespace {

constexpr double kCell = 25;              ///< m
constexpr int kMaxTriesPerLandmark = 50;  ///< to place one that both cameras see

int CellOf(double x) { return static_cast<int>(std::floor(x / kCell)); }

int64_t CellKey(int x, int y, int z) {
  const auto part = [](int i) { return static_cast<int64_t>(i + (1 << 20)) & 0x1fffff; };
  return part(x) << 42 | part(y) << 21 | part(z);
}

}  // namespace

ObservationSimulator::ObservationSimulator(const StereoCamera& camera,
                                           std::vector<Rigid3> world_from_camera,
                                           const ObservationSimulatorOptions& options)
    : camera_(camera),
      path_(std::move(world_from_camera)),
      options_(options),
      engine_(options.seed) {
  camera_.Check();
}

std::optional<SimulatedFrame> ObservationSimulator::Next() {
  if (frame_ == size()) return std::nullopt;
  world_from_camera_ = path_[frame_];
  camera_from_world_ = world_from_camera_.Inverse();
  if (frame_ + 1 < size()) {
    const Rigid3 next_from_now = path_[frame_ + 1].Inverse() * world_from_camera_;
    later_from_now_ = Interpolate({}, next_from_now, options_.right_delay);
  }
  SimulatedFrame frame;
  frame.world_from_camera = world_from_camera_;
  const auto is_full = [&] {
    return static_cast<int>(frame.observations.size()) >= options_.landmarks_in_view;
  };
  const auto add = [&](int id) {
    if (is_full()) return;
    if (const auto seen = Observe(id)) frame.observations.push_back(*seen);
  };
  std::vector<int> others;  // tracks that go on come first
  VisitNear([&](int id) { GoesOn(landmarks_[id]) ? add(id) : others.push_back(id); });
  for (const int id : others) add(id);
  for (int i = 0; !is_full() && i < kMaxTriesPerLandmark * options_.landmarks_in_view; ++i)
    add(PlaceLandmark());
  for (SimulatedObservation& observation : frame.observations) Disturb(observation);
  ++frame_;
  return frame;
}

std::array<float, 64> ObservationSimulator::Describe(int landmark_id, double noise) {
  RandomEngine own(2654435761u * (landmark_id + 1) + options_.seed);
  std::array<float, 64> descriptor;
  double squares = 0;
  for (float& x : descriptor) {
    const double own_part = RandomNormal(own);
    x = static_cast<float>((own_part + noise * RandomNormal(engine_)) / 8);
    squares += x * x;
  }
  for (float& x : descriptor) x = static_cast<float>(x / std::sqrt(squares));
  return descriptor;
}

/// Calls visit(id) for the landmarks around the camera, in an order that is always the same.
template <class Visit>
void ObservationSimulator::VisitNear(const Visit& visit) const {
  const Eigen::Vector3d& c = world_from_camera_.translation;
  const double reach = options_.max_depth_m * options_.max_range_ratio;
  for (int x = CellOf(c.x() - reach); x <= CellOf(c.x() + reach); ++x) {
    for (int y = CellOf(c.y() - reach); y <= CellOf(c.y() + reach); ++y) {
      for (int z = CellOf(c.z() - reach); z <= CellOf(c.z() + reach); ++z) {
        const auto cell = cells_.find(CellKey(x, y, z));
        if (cell == cells_.end()) continue;
        for (const int id : cell->second) visit(id);
      }
    }
  }
}

std::optional<Eigen::Vector3d> ObservationSimulator::Project(
    const Eigen::Vector3d& x_in_world) const {
  const Eigen::Vector3d x = camera_from_world_ * x_in_world;
  if (x.z() < 0.5 * options_.min_depth_m) return std::nullopt;
  const Eigen::Vector3d pixels = camera_.ProjectStereo(x);
  if (!camera_.Contains(pixels.head<2>()) || pixels.z() < 0) return std::nullopt;
  return pixels;
}

/// A new landmark on a random pixel's ray, above the ground.
int ObservationSimulator::PlaceLandmark() {
  const double u = Draw(0, camera_.width - 1), v = Draw(0, camera_.height - 1);
  const double right = (u - camera_.cx) / camera_.fx, down = (v - camera_.cy) / camera_.fy;
  double farthest = options_.max_depth_m;
  if (down > 0) farthest = std::min(farthest, options_.camera_height_m / down);
  farthest = std::max(farthest, 1.05 * options_.min_depth_m);
  const double z =
      options_.min_depth_m * std::pow(farthest / options_.min_depth_m, RandomUnit(engine_));
  Place place;
  place.x_in_world = world_from_camera_ * Eigen::Vector3d(right * z, down * z, z);
  const Eigen::Vector3d offset = place.x_in_world - world_from_camera_.translation;
  place.first_distance = offset.norm();
  place.first_direction = offset / place.first_distance;
  const int id = num_landmarks();
  const Eigen::Vector3d& x = place.x_in_world;
  cells_[CellKey(CellOf(x.x()), CellOf(x.y()), CellOf(x.z()))].push_back(id);
  landmarks_.push_back(place);
  return id;
}

/// The exact observation where the landmark is in view and its track goes on or begins.
std::optional<SimulatedObservation> ObservationSimulator::Observe(int id) {
  Place& place = landmarks_[id];
  if (frame_ < place.rests_until) return std::nullopt;
  const Eigen::Vector3d offset = place.x_in_world - world_from_camera_.translation;
  const double distance = offset.norm();
  const double cosine = std::cos(options_.max_view_change_deg * M_PI / 180);
  if (distance > options_.max_range_ratio * place.first_distance ||
      offset.dot(place.first_direction) < cosine * distance) {
    return std::nullopt;
  }
  const auto pixels = Project(place.x_in_world);
  if (!pixels) return std::nullopt;
  if (!GoesOn(place)) {
    place.track_id = num_tracks_++;
  } else if (RandomUnit(engine_) * options_.mean_track_frames < 1) {
    place.rests_until = frame_ + options_.rest_frames;
    return std::nullopt;
  }
  place.last_seen = frame_;
  const Eigen::Vector2d shift =
      ShiftOfRight(camera_, later_from_now_, camera_from_world_ * place.x_in_world);
  const Eigen::Vector3d seen = *pixels + Eigen::Vector3d(0, 0, shift.x());
  return SimulatedObservation{id, place.track_id, seen, pixels->y() + shift.y(), false};
}

/// Adds noise, or makes an outlier of it: half of them a wrong partner in the right image only,
/// half another place in both.
void ObservationSimulator::Disturb(SimulatedObservation& observation) {
  Eigen::Vector3d& pixels = observation.pixels;
  const Eigen::Vector2d right =
      options_.displacement.AtRight(camera_, {pixels.z(), observation.v_right});
  pixels.head<2>() += options_.displacement.AtLeft(camera_, pixels.head<2>());
  pixels.z() += right.x();
  observation.v_right += right.y();
  observation.is_outlier = RandomUnit(engine_) < options_.outlier_fraction;
  if (!observation.is_outlier) {
    for (int i = 0; i < 3; ++i) pixels[i] += options_.noise_px * RandomNormal(engine_);
    observation.v_right += options_.noise_px * RandomNormal(engine_);
    return;
  }
  if (RandomUnit(engine_) < 0.5) {
    pixels.x() = Draw(0, camera_.width - 1);
    pixels.y() = Draw(0, camera_.height - 1);
  }
  pixels.z() = pixels.x() - Draw(0.5, camera_.Disparity(options_.min_depth_m));
  observation.v_right = pixels.y() + options_.noise_px * RandomNormal(engine_);
}

}  // namespace arfm_vo
