#pragma once

#include <string>

#include "arfm_vo/odometry/row_watch.h"
#include "arfm_vo/reconstruction/stereo_frame.h"

namespace arfm_vo {

/// Tells the pictures of a pair that are not to be used.
class EyeFaults {
 public:
  /// Takes the next pair.
  void Look(const StereoFrame& frame);
  /// Why the pair's left picture is not to be used; empty where it is. Then the right one is
  /// neither.
  const std::string& of_left() const { return of_left_; }
  const std::string& of_right() const { return of_right_; }

 private:
  std::string FindInLeft(const StereoFrame& frame) const;
  std::string FindInRight(const StereoFrame& frame) const;

  RowWatch rows_;
  std::string of_left_, of_right_;
};

}  // namespace arfm_vo
