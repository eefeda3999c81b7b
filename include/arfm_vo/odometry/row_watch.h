#pragma once

#include "arfm_vo/reconstruction/stereo_frame.h"

namespace arfm_vo {

/// Whether the two pictures of a pair are of one moment and one rig, by the share of what both see
/// that lies on the rows it should: nearly all of it. Pictures of two moments may agree now and
/// then, so that it takes some pairs in a row that agree well to be trusted again.
class RowWatch {
 public:
  /// The next pair's StereoFrame::row_agreement.
  void Look(double row_agreement) {
    if (row_agreement < kMinRowAgreement) {
      num_to_prove_ = kProof;
    } else if (num_to_prove_ > 0) {
      num_to_prove_ = row_agreement < kGood ? kProof : num_to_prove_ - 1;
    }
  }
  bool IsSkewed() const { return num_to_prove_ > 0; }

 private:
  static constexpr double kGood = 0.7;
  static constexpr int kProof = 3;
  int num_to_prove_ = 0;
};

}  // namespace arfm_vo
