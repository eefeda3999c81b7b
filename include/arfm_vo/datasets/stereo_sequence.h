#pragma once

#include <limits>
#include <optional>
#include <string>

#include "arfm_vo/base/check.h"
#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/image/stereo_images.h"

namespace arfm_vo {

/// Which pairs of a recording are taken: every `stride`-th, beginning with the first, and of these
/// at most `max_pairs`.
struct PairSelection {
  int stride = 1;
  int max_pairs = std::numeric_limits<int>::max();

  void Check() const {
    Require(stride >= 1, "stride must be at least 1, is " + std::to_string(stride));
    Require(max_pairs >= 1, "pairs must be at least 1, is " + std::to_string(max_pairs));
  }
};

/// A pair and, where the recording has it, the true pose of its left camera.
struct SequencePair {
  StereoImages images;
  std::optional<Rigid3> true_world_from_camera;
};

/// A recording of rectified stereo pairs, read one after the other.
class StereoSequence {
 public:
  virtual ~StereoSequence() = default;

  virtual const StereoCamera& camera() const = 0;
  /// Number of pairs that Next() will give; for recordings whose pairs are only known in the end an
  /// upper bound.
  virtual int size() const = 0;
  /// The next pair, with a later stamp than the one before; nothing at the end. Throws
  /// std::invalid_argument naming what is wrong where it cannot be read.
  virtual std::optional<SequencePair> Next() = 0;
  /// Lines `key: value` that say what was found on the way.
  virtual std::string FormatSummary() const { return ""; }
};

}  // namespace arfm_vo
