#include "arfm_vo/datasets/kitti_files.h"

#include <Eigen/Core>
#include <ctime>
#include <iomanip>
#include <optional>
#include <sstream>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/number_rows.h"
#include "arfm_vo/base/whole_file.h"

namespace arfm_vo {
namespace {

/// Seconds since 1970-01-01 of a line of the raw data, split so that no digit is lost.
struct RawTime {
  std::time_t whole_s = 0;
  double fraction_s = 0;
};

RawTime ParseRawTime(const std::string& line, const std::string& place) {
  std::tm date = {};
  double second = 0;
  std::istringstream text(line);
  text >> std::get_time(&date, "%Y-%m-%d %H:%M:") >> second;
  Require(!text.fail() && second >= 0 && second < 61,
          place + ": '" + line + "' is not a time such as 2011-09-26 13:02:25.964389445");
  return {timegm(&date), second};
}

std::vector<double> ReadRawTimes(const std::string& path, const std::string& content) {
  std::vector<double> stamps;
  RawTime first;
  std::istringstream file(content);
  for (std::string line; std::getline(file, line);) {
    const std::string place = path + ":" + std::to_string(stamps.size() + 1);
    const RawTime time = ParseRawTime(line, place);
    if (stamps.empty()) first = time;
    stamps.push_back(static_cast<double>(time.whole_s - first.whole_s) +
                     (time.fraction_s - first.fraction_s));
  }
  return stamps;
}

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
  Within(path + ": " + left_key + ", " + right_key, [&] { camera.Check(); });
  return camera;
}

std::vector<double> ReadKittiTimes(const std::string& path) {
  const std::string content = ReadWholeFile(path);
  std::vector<double> stamps;
  if (content.find(':') != std::string::npos) {
    stamps = ReadRawTimes(path, content);
  } else {
    for (const NumberRow& row : ReadNumberRows(path, 1)) stamps.push_back(row.values[0]);
  }
  for (size_t i = 1; i < stamps.size(); ++i) {
    Require(stamps[i] > stamps[i - 1],
            path + ": time " + std::to_string(i + 1) + " is not later than the one before");
  }
  return stamps;
}

}  // namespace arfm_vo
