#include "arfm_vo/simulation/kitti_folder_writer.h"

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/format.h"
#include "arfm_vo/base/number_rows.h"
#include "arfm_vo/base/whole_file.h"

namespace arfm_vo {
namespace {

namespace fs = std::filesystem;

/// A line of a 3 x 4 matrix, row by row.
std::string FormatMatrix(const Eigen::Matrix<double, 3, 4>& matrix) {
  std::string line;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      line += (line.empty() ? "" : " ") + FormatNumber(matrix(row, column));
    }
  }
  return line + "\n";
}

std::string FormatCalibration(const StereoCamera& camera) {
  Eigen::Matrix<double, 3, 4> projection;
  projection << camera.fx, 0, camera.cx, 0, 0, camera.fy, camera.cy, 0, 0, 0, 1, 0;
  const std::string left = "P0: " + FormatMatrix(projection);
  projection(0, 3) = -camera.fx * camera.baseline_m;
  return left + "P1: " + FormatMatrix(projection);
}

void WriteImage(const std::string& path, const cv::Mat& image) {
  if (!cv::imwrite(path, image)) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace

KittiFolderWriter::KittiFolderWriter(const std::string& folder, const StereoCamera& camera)
    : folder_(folder), unfinished_(folder + ".unfinished"), camera_(camera) {
  Require(!fs::exists(folder_), folder_ + ": exists already");
  Require(!fs::exists(unfinished_), unfinished_ + ": exists already");
  fs::create_directories(unfinished_ + "/image_0");
  fs::create_directories(unfinished_ + "/image_1");
}

KittiFolderWriter::~KittiFolderWriter() {
  std::error_code ignored;  // nothing more can be done about it
  fs::remove_all(unfinished_, ignored);
}

void KittiFolderWriter::Write(const StereoImages& images, const Rigid3& world_from_left) {
  images.Check();
  const std::string name = Format("/%06d.png", num_pairs_++);
  WriteImage(unfinished_ + "/image_0" + name, images.left);
  WriteImage(unfinished_ + "/image_1" + name, images.right);
  times_ += FormatNumber(images.stamp_s, true) + "\n";
  poses_ += FormatMatrix(world_from_left.Matrix());
}

void KittiFolderWriter::Close() {
  WriteWholeFile(unfinished_ + "/calib.txt", FormatCalibration(camera_));
  WriteWholeFile(unfinished_ + "/times.txt", times_);
  WriteWholeFile(unfinished_ + "/poses.txt", poses_);
  fs::rename(unfinished_, folder_);
}

}  // namespace arfm_vo
