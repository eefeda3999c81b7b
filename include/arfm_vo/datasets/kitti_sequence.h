#pragma once

#include <string>
#include <vector>

#include "arfm_vo/datasets/stereo_sequence.h"
#include "arfm_vo/image/grey_window.h"

namespace arfm_vo {

/// A folder of a KITTI stereo sequence, in one of the layouts
///   odometry   image_0/000000.png.. image_1/.. calib.txt [times.txt] [poses.txt]
///              (of the official sequences/NN also ../../poses/NN.txt)
///   raw, sync  image_00/data/0000000000.png.. image_01/data/.. [image_00/timestamps.txt]
///              calib_cam_to_cam.txt, here or in the folder above
/// Where the grey cameras 0 and 1 are not there, the colour cameras 2 and 3 (image_2, image_02 ..).
/// Without times the pairs are 0.1 s apart.
class KittiSequence : public StereoSequence {
 public:
  /// Reads everything but the images after the first. Throws std::invalid_argument naming file or
  /// key for: a missing folder, images without partner, a wrong calibration, times that do not
  /// increase, numbers of times or poses other than that of the pairs, anything not finite.
  explicit KittiSequence(const std::string& folder, const PairSelection& selection = {});

  const StereoCamera& camera() const override { return camera_; }
  int size() const override { return static_cast<int>(frames_.size()); }
  /// Throws std::invalid_argument naming the file where an image cannot be read, is truncated or
  /// differs in size from the first.
  std::optional<SequencePair> Next() override;

 private:
  struct Frame {
    std::string left_path, right_path;
    double stamp_s = 0;
    std::optional<Rigid3> true_world_from_camera;
  };
  SequencePair Load(const Frame& frame);

  StereoCamera camera_;
  GreyWindow window_;
  std::vector<Frame> frames_;
  size_t num_given_ = 0;
};

}  // namespace arfm_vo
