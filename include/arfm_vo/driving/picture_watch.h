#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "arfm_vo/driving/start_check.h"

namespace arfm_vo {

/// What the odometry tells of a stereo pair. Its time is that of the driving clock.
struct Picture {
  double taken_s = 0;
  double grey_mean = 0;                            ///< of the left picture, grey levels
  size_t num_landmarks = 0, num_seen_by_both = 0;  ///< the pose's; 0 where it was lost
};

/// Judges the camera by its pictures: whether they come, whether its automatic exposure has settled
/// since it was switched on, and whether both cameras see.
class PictureWatch {
 public:
  /// A camera that gave no picture for longer than `max_age_s` was switched on anew.
  explicit PictureWatch(double max_age_s) : max_age_s_(max_age_s) {}

  void Observe(const Picture& picture);

  /// True too where nobody tells of pictures. Once settled it stays so: when the rover drives, what
  /// it sees changes the grey as well.
  bool HasSettled() const { return pictures_.empty() || has_settled_; }
  /// Camera, exposure and both cameras.
  std::vector<CheckLine> Check(double now_s) const;

 private:
  bool IsSteady() const;
  double Span() const { return pictures_.back().taken_s - pictures_.front().taken_s; }

  double max_age_s_;
  std::deque<Picture> pictures_;  // of the last second, at least four
  bool has_settled_ = false;
};

}  // namespace arfm_vo
