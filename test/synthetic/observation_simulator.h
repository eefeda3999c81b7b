#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "arfm_vo/base/random.h"
#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/geometry/stereo_correction.h"

namespace arfm_vo {

struct ObservationSimulatorOptions {
  int seed = 1;
  int landmarks_in_view = 300;  ///< observed in each frame, outliers among them
  double min_depth_m = 4, max_depth_m = 100;
  double camera_height_m = 1.65;  ///< nothing is seen below a plane so far under the camera
  double noise_px = 0.5;          ///< standard deviation of each coordinate
  double outlier_fraction = 0.2;
  StereoCorrection displacement;  ///< of the images, as calibration would leave it
  double right_delay = 0;         ///< of the right picture, as a share of the frames' interval
  double mean_track_frames = 12;  ///< a track ends by chance, with equal probability in each frame
  int rest_frames = 50;           ///< after its track a landmark is not seen for so long
  double max_view_change_deg = 40;  ///< how far round a landmark can be seen from
  double max_range_ratio = 1.5;     ///< how far off it can be seen, over the first distance
};

struct SimulatedObservation {
  int landmark_id = 0;     ///< index of ObservationSimulator::Landmark
  int track_id = 0;        ///< new each time the landmark comes back
  Eigen::Vector3d pixels;  ///< (u_left, v, u_right), noisy; of something else where an outlier
  double v_right = 0;      ///< with noise of its own
  bool is_outlier = false;
};

struct SimulatedFrame {
  Rigid3 world_from_camera;  ///< truth
  std::vector<SimulatedObservation> observations;
};

/// What a perfect front end would see along a path, but for noise, outliers and the ends of tracks:
/// random landmarks, log-uniform in depth, put where the camera is short of them; they stay and are
/// seen again when the camera comes back. No images; thousands of frames in seconds; the same seed
/// gives the same numbers.
class ObservationSimulator {
 public:
  ObservationSimulator(const StereoCamera& camera, std::vector<Rigid3> world_from_camera,
                       const ObservationSimulatorOptions& options = {});

  int size() const { return static_cast<int>(path_.size()); }
  int num_landmarks() const { return static_cast<int>(landmarks_.size()); }
  const Eigen::Vector3d& Landmark(int id) const { return landmarks_.at(id).x_in_world; }

  /// The next frame; nothing after the last pose.
  std::optional<SimulatedFrame> Next();
  /// A unit vector of 64 numbers, the landmark's own, with Gaussian noise of deviation `noise` / 8
  /// on each (0.3: much alike) drawn anew at each call.
  std::array<float, 64> Describe(int landmark_id, double noise);

 private:
  struct Place {
    Eigen::Vector3d x_in_world;
    Eigen::Vector3d first_direction;  ///< from the camera, unit, world
    double first_distance = 0;
    int track_id = -1;
    int last_seen = -1;    ///< frame
    int rests_until = -1;  ///< frame
  };

  template <class Visit>
  void VisitNear(const Visit& visit) const;
  bool GoesOn(const Place& place) const { return place.last_seen == frame_ - 1 && frame_ > 0; }
  std::optional<Eigen::Vector3d> Project(const Eigen::Vector3d& x_in_world) const;
  std::optional<SimulatedObservation> Observe(int id);
  int PlaceLandmark();
  void Disturb(SimulatedObservation& observation);
  double Draw(double low, double high) { return low + (high - low) * RandomUnit(engine_); }

  StereoCamera camera_;
  std::vector<Rigid3> path_;
  ObservationSimulatorOptions options_;
  RandomEngine engine_;
  int frame_ = 0, num_tracks_ = 0;
  Rigid3 world_from_camera_, camera_from_world_;  ///< of the current frame
  Rigid3 later_from_now_;  ///< the camera's motion from the left picture to the right one
  std::vector<Place> landmarks_;
  std::unordered_map<int64_t, std::vector<int>> cells_;  ///< landmark ids by place
};

}  // namespace arfm_vo
