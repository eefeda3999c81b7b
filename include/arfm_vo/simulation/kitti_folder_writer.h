#pragma once

#include <string>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/image/stereo_images.h"

namespace arfm_vo {

/// Writes a KITTI odometry folder: image_0/000000.png.., image_1/.., calib.txt (P0, P1), times.txt,
/// poses.txt. The folder has its name only when all is written.
class KittiFolderWriter {
 public:
  /// Throws std::invalid_argument where `folder` exists, std::filesystem::filesystem_error where it
  /// cannot be made.
  KittiFolderWriter(const std::string& folder, const StereoCamera& camera);
  /// Removes what was written unless Close() was called.
  ~KittiFolderWriter();
  KittiFolderWriter(const KittiFolderWriter&) = delete;
  KittiFolderWriter& operator=(const KittiFolderWriter&) = delete;

  /// Throws std::runtime_error naming the file where it cannot be written.
  void Write(const StereoImages& images, const Rigid3& world_from_left);
  void Close();

 private:
  std::string folder_, unfinished_;
  StereoCamera camera_;
  int num_pairs_ = 0;
  std::string times_, poses_;
};

}  // namespace arfm_vo
