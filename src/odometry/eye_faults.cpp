#include "eye_faults.h"

namespace arfm_vo {
namespace {

/// An eye with fewer keypoints, against the other's, is dark or covered.
constexpr double kBlindShare = 0.1;

}  // namespace

void EyeFaults::Look(const StereoFrame& frame) {
  of_left_ = FindInLeft(frame);
  if (of_left_.empty()) rows_.Look(frame.row_agreement);
  of_right_ = of_left_.empty() ? FindInRight(frame) : of_left_;
}

std::string EyeFaults::FindInLeft(const StereoFrame& frame) const {
  if (frame.left_is_repeated) return "the left camera repeats its picture";
  // In a turn pictures of two moments look like swapped ones.
  if (frame.eyes_are_swapped && !rows_.IsSkewed()) return "left and right are swapped";
  return "";
}

std::string EyeFaults::FindInRight(const StereoFrame& frame) const {
  if (frame.right_is_repeated) return "the right camera repeats its picture";
  if (frame.num_right_keypoints < kBlindShare * frame.features.size()) {
    return "the right camera sees nothing";
  }
  if (rows_.IsSkewed()) {
    return "the rows of the two pictures do not agree (one late, or a camera moved?)";
  }
  return "";
}

}  // namespace arfm_vo
