#include "arfm_vo/datasets/kitti_calibration.h"

#include <Eigen/Core>
#include <optional>
#include <sstream>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/number_rows.h"
#include "arfm_vo/base/whole_file.h"

namespace arfm_vo {
namespace {

using Projection = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

/// The matrix of line `key: 12 numbers`; nothing where there is no such line.
std::optional<Projection> FindProjection(const std::string& path, const std::string& content,
                                         const std::string& key) {
  std::optional<Projection> found;
  std::istringstream file(content);
  for (std::string line; std::getline(file, line);) {
    if (line.compare(0, key.size() + 1, key + ":") != 0) continue;
    const std::string place = path + ": " + key;
    Require(!found, place + " stands twice");
    const auto values = ParseNumbers(line.substr(key.size() + 1), place);
    Require(values.size() == 12,
            place + " holds " + std::to_string(values.size()) + " numbers instead of 12");
    found = Eigen::Map<const Projection>(values.data());
  }
  return found;
}

}  // namespace

StereoCamera ReadKittiCalibration(const std::string& path, int left_camera, int width, int height) {
  const std::string content = ReadWholeFile(path);
  const bool is_raw = content.find("P_rect_00:") != std::string::npos;
  const std::string prefix = is_raw ? "P_rect_0" : "P";
  const std::string left_key = prefix + std::to_string(left_camera);
  const std::string right_key = prefix + std::to_string(left_camera + 1);
  const auto left = FindProjection(path, content, left_key);
  const auto right = FindProjection(path, content, right_key);
  Require(left.has_value(), path + ": has no " + left_key);
  Require(right.has_value(), path + ": has no " + right_key);
  Require((left->leftCols<3>() - right->leftCols<3>()).cwiseAbs().maxCoeff() < 1e-3,
          path + ": " + left_key + " and " + right_key +
              " differ in focal length or centre: not a rectified pair");

  StereoCamera camera;
  camera.fx = (*left)(0, 0);
  camera.fy = (*left)(1, 1);
  camera.cx = (*left)(0, 2);
  camera.cy = (*left)(1, 2);
  camera.baseline_m = ((*left)(0, 3) - (*right)(0, 3)) / camera.fx;
  camera.width = width;
  camera.height = height;
  try {
    camera.Check();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(path + ": " + left_key + ", " + right_key + ": " + error.what());
  }
  return camera;
}

}  // namespace arfm_vo
