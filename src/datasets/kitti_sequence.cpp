#include "arfm_vo/datasets/kitti_sequence.h"

#include <algorithm>
#include <filesystem>

#include "arfm_vo/base/format.h"
#include "arfm_vo/datasets/kitti_files.h"
#include "arfm_vo/geometry/kitti_poses.h"
#include "arfm_vo/image/png_image.h"

namespace arfm_vo {
namespace {

namespace fs = std::filesystem;

/// Where the parts of a sequence lie; `times` and `poses` may not exist.
struct Layout {
  fs::path left, right, calibration, times, poses;
  int left_camera = 0;  ///< 0: grey, 2: colour; the right one is the next
};

Layout FindLayout(const fs::path& folder) {
  Require(fs::is_directory(folder), folder.string() + ": no such folder");
  const fs::path full = fs::canonical(folder);
  Layout layout{folder / "image_0", folder / "image_1", folder / "calib.txt", folder / "times.txt",
                folder / "poses.txt"};
  for (const int camera : {2, 0}) {  // the grey ones go before
    const std::string left = std::to_string(camera), right = std::to_string(camera + 1);
    const fs::path raw = folder / ("image_0" + left);
    if (fs::exists(raw / "data")) {
      layout.left = raw / "data";
      layout.right = folder / ("image_0" + right) / "data";
      layout.times = raw / "timestamps.txt";
      layout.left_camera = camera;
    }
    if (fs::exists(folder / ("image_" + left))) {
      layout.left = folder / ("image_" + left);
      layout.right = folder / ("image_" + right);
      layout.times = folder / "times.txt";
      layout.left_camera = camera;
    }
  }
  if (!fs::exists(layout.calibration)) {
    for (const fs::path& place : {folder, full.parent_path()}) {
      const fs::path raw = place / "calib_cam_to_cam.txt";
      if (fs::exists(raw)) layout.calibration = raw;
    }
  }
  if (!fs::exists(layout.poses) && full.parent_path().filename() == "sequences") {
    layout.poses = full.parent_path().parent_path() / "poses" / (full.filename().string() + ".txt");
  }
  return layout;
}

/// The names of the PNG files of a folder, in order.
std::vector<std::string> ListImages(const fs::path& folder) {
  Require(fs::is_directory(folder), folder.string() + ": no such folder");
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".png") names.push_back(entry.path().filename().string());
  }
  Require(!names.empty(), folder.string() + ": holds no PNG images");
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> ListPairs(const Layout& layout) {
  const auto left = ListImages(layout.left), right = ListImages(layout.right);
  Require(left.size() == right.size(), Format("%s holds %zu images, %s %zu", layout.left.c_str(),
                                              left.size(), layout.right.c_str(), right.size()));
  for (size_t i = 0; i < left.size(); ++i) {
    Require(left[i] == right[i],
            (layout.left / left[i]).string() + ": has no partner in " + layout.right.string());
  }
  return left;
}

template <class Rows>
void RequireOneEach(const Rows& rows, size_t num_pairs, const fs::path& path) {
  Require(rows.size() == num_pairs, path.string() + ": holds " + std::to_string(rows.size()) +
                                        " lines for " + std::to_string(num_pairs) + " pairs");
}

}  // namespace

KittiSequence::KittiSequence(const std::string& folder, const PairSelection& selection) {
  selection.Check();
  const Layout layout = FindLayout(folder);
  const std::vector<std::string> names = ListPairs(layout);
  const cv::Size size = ReadGreyPng((layout.left / names[0]).string(), window_).size();
  camera_ = ReadKittiCalibration(layout.calibration.string(), layout.left_camera, size.width,
                                 size.height);

  std::vector<double> stamps;
  if (fs::exists(layout.times)) {
    stamps = ReadKittiTimes(layout.times.string());
    RequireOneEach(stamps, names.size(), layout.times);
  } else {
    for (size_t i = 0; i < names.size(); ++i) stamps.push_back(static_cast<double>(i) / 10);
  }
  std::vector<Rigid3> poses;
  if (fs::exists(layout.poses)) {
    poses = ReadKittiPoses(layout.poses.string());
    RequireOneEach(poses, names.size(), layout.poses);
  }
  for (size_t i = 0; i < names.size(); i += selection.stride) {
    if (size_t(selection.max_pairs) == frames_.size()) break;
    frames_.push_back({(layout.left / names[i]).string(), (layout.right / names[i]).string(),
                       stamps[i], poses.empty() ? std::nullopt : std::optional<Rigid3>(poses[i])});
  }
}

SequencePair KittiSequence::Load(const Frame& frame) {
  SequencePair pair;
  pair.true_world_from_camera = frame.true_world_from_camera;
  pair.images = {frame.stamp_s, ReadGreyPng(frame.left_path, window_),
                 ReadGreyPng(frame.right_path, window_)};
  const cv::Size expected(camera_.width, camera_.height);
  const auto check_size = [&](const cv::Mat& image, const std::string& path) {
    Require(image.size() == expected, path + Format(": is %dx%d, the first image %dx%d", image.cols,
                                                    image.rows, expected.width, expected.height));
  };
  check_size(pair.images.left, frame.left_path);
  check_size(pair.images.right, frame.right_path);
  return pair;
}

std::optional<SequencePair> KittiSequence::Next() {
  if (num_given_ == frames_.size()) return std::nullopt;
  return Load(frames_[num_given_++]);
}

}  // namespace arfm_vo
