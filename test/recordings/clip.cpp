#include "recordings/clip.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <filesystem>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/datasets/kitti_sequence.h"
#include "arfm_vo/geometry/kitti_poses.h"
#include "arfm_vo/odometry/trajectory_files.h"

namespace arfm_vo {
namespace {

namespace fs = std::filesystem;

constexpr double kHeldShare = 0.01;  ///< of the places' weight, that holds a rotation
constexpr int kMatchedWidth = 640;   ///< px, of the pictures that block matching is done on

/// Depth of the left image by block matching at a lower resolution; 0 where there is none.
cv::Mat MatchBlocks(const StereoImages& images, const StereoCamera& camera) {
  const double scale = std::min(1.0, static_cast<double>(kMatchedWidth) / images.left.cols);
  cv::Mat left, right, disparity;
  cv::resize(images.left, left, {}, scale, scale, cv::INTER_AREA);
  cv::resize(images.right, right, {}, scale, scale, cv::INTER_AREA);
  const int num_disparities = std::max(16, left.cols / 6 / 16 * 16);
  cv::StereoBM::create(num_disparities, 15)->compute(left, right, disparity);
  cv::Mat depth = cv::Mat::zeros(images.left.size(), CV_32FC1);
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const int x = std::min(static_cast<int>(u * scale), disparity.cols - 1);
      const int y = std::min(static_cast<int>(v * scale), disparity.rows - 1);
      const double disparity_px = disparity.at<short>(y, x) / 16.0 / scale;
      if (disparity_px > 0.5) depth.at<float>(v, u) = camera.Depth(disparity_px);
    }
  }
  return depth;
}

/// What the odometry has after the whole clip. Kept in a file.
std::vector<Rigid3> ReadReference(const Clip& clip, const OdometryOptions& options,
                                  const std::string& cache_folder) {
  const std::string path = cache_folder + "/" + clip.name + ".txt";
  if (!fs::exists(path)) {
    const ClipWindow whole(clip, {0, 0, clip.num_pairs, 1, false, {}},
                           std::vector<Rigid3>(clip.num_pairs));
    VisualOdometry odometry(whole.camera(), options);
    for (int i = 0; i < whole.size(); ++i) odometry.Process(whole.Images(i));
    fs::create_directories(cache_folder);
    WriteWholeFile(path, FormatKitti(odometry.Finish()));
  }
  return ReadKittiPoses(path);
}

/// The places of `truth`, with the directions of `reference` in its world.
std::vector<Rigid3> WithDirections(const std::vector<Rigid3>& reference,
                                   std::vector<Rigid3> truth) {
  const int size = static_cast<int>(truth.size());
  Eigen::Vector4d turn = Eigen::Vector4d::Zero();
  Eigen::Vector3d center = turn.head<3>(), true_center = center;
  const Eigen::Quaterniond about = truth[0].rotation * reference.at(0).rotation.conjugate();
  for (int i = 0; i < size; ++i) {
    const Eigen::Vector4d one = (truth[i].rotation * reference.at(i).rotation.conjugate()).coeffs();
    turn += one.dot(about.coeffs()) < 0 ? Eigen::Vector4d(-one) : one;
    center += reference[i].translation / size;
    true_center += truth[i].translation / size;
  }
  // The mean rotation, turned further so that the places agree best; held where they do not tell,
  // as about a straight way.
  Eigen::Quaterniond world_from_reference(turn.normalized());
  Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  for (int i = 0; i < size; ++i) {
    const Eigen::Vector3d place = world_from_reference * (reference[i].translation - center);
    const Eigen::Matrix3d jacobian = -Skew(place);
    normal_matrix += jacobian.transpose() * jacobian;
    right_side += jacobian.transpose() * (truth[i].translation - true_center - place);
  }
  normal_matrix.diagonal().array() += kHeldShare * normal_matrix.trace();
  world_from_reference = ExpSO3(normal_matrix.ldlt().solve(right_side)) * world_from_reference;
  for (int i = 0; i < size; ++i) {
    truth[i].rotation = (world_from_reference * reference[i].rotation).normalized();
  }
  return truth;
}

}  // namespace

std::vector<Clip> FindClips(const std::string& data) {
  // KITTI's official places are good to about 1 % of short ways and jump by some 3 cm from pair to
  // pair, those of the raw drive to 1.5 %. Forward and backward the odometry differs by up to
  // .6 % within 20 pairs of the backyard, and by up to 3 % within 18 of the library.
  const std::vector<Clip> known{
      {"kitti_06", "kitti/odometry_06_000-050", "drive", "street", true, 1, 0.03, 0, {}},
      {"kitti_04", "kitti/odometry_04_000-050", "drive", "street", true, 1, 0.03, 0, {}},
      {"kitti_05", "kitti/odometry_05_100-159", "drive_bend", "street", true, 1, 0.03, 0, {}},
      {"kitti_0001", "kitti/raw_2011_09_26_drive_0001", "drive", "street", true, 1.5, 0.03, 0, {}},
      {"backyard", "handheld/boofcv_backyard", "walk", "leaves", false, 1.5, 0.002, 0, {}},
      {"library", "handheld/boofcv_library", "walk", "indoors", false, 2.5, 0.002, 0, {}},
      {"room1", "handheld/tumvi_room1", "turning", "indoors_dark", true, 1.5, 0.002, 0, {}},
  };
  std::vector<Clip> clips;
  for (Clip clip : known) {
    clip.folder = data + "/" + clip.folder;
    if (!fs::is_directory(clip.folder)) continue;
    const KittiSequence sequence(clip.folder);
    clip.num_pairs = sequence.size();
    clip.camera = sequence.camera();
    clips.push_back(clip);
  }
  return clips;
}

ClipPlan DrawClipPlan(const std::vector<Clip>& clips, int max_pairs, Draw& draw) {
  ClipPlan plan;
  plan.clip = draw.Integer(0, static_cast<int>(clips.size()) - 1);
  const int all = clips[plan.clip].num_pairs;
  plan.stride = draw.OneOf<int>({1, 1, 1, 2, 2, 3, 5});
  plan.num_pairs =
      std::min(draw.Integer(max_pairs * 2 / 3, max_pairs), 1 + (all - 1) / plan.stride);
  plan.first = draw.Integer(0, all - 1 - (plan.num_pairs - 1) * plan.stride);
  plan.is_backward = draw.Chance(0.4);
  plan.transform.swap = draw.OneOf<ImageSwap>({ImageSwap::kNone, ImageSwap::kNone, ImageSwap::kNone,
                                               ImageSwap::kMirrored, ImageSwap::kTurned});
  const double crop = draw.Between(0, 0.2), aside = draw.Between(0, 1);
  const double scale = draw.Between(0.5, 1);
  if (draw.Chance(0.25)) {  // at most a fifth of the width and a tenth of the height
    const double columns = crop * clips[plan.clip].camera.width;
    const double rows = 0.5 * crop * clips[plan.clip].camera.height;
    plan.transform.crop_left = static_cast<int>(columns * aside);
    plan.transform.crop_right = static_cast<int>(columns * (1 - aside));
    plan.transform.crop_top = static_cast<int>(rows * (1 - aside));
    plan.transform.crop_bottom = static_cast<int>(rows * aside);
  }
  if (draw.Chance(0.25)) plan.transform.scale = scale;
  return plan;
}

std::vector<Rigid3> ReadClipTruth(const Clip& clip, const OdometryOptions& options,
                                  const std::string& cache_folder) {
  const auto reference = ReadReference(clip, options, cache_folder);
  if (!clip.has_truth) return reference;
  return WithDirections(reference, ReadKittiPoses(clip.folder + "/poses.txt"));
}

ClipWindow::ClipWindow(const Clip& clip, const ClipPlan& plan, const std::vector<Rigid3>& truth) {
  KittiSequence sequence(clip.folder);
  const StereoCamera& whole = sequence.camera();
  camera_ = plan.transform.Apply(whole);
  const int last = plan.first + (plan.num_pairs - 1) * plan.stride;
  for (int i = 0; i <= last; ++i) {
    const auto pair = sequence.Next();
    if (i < plan.first || (i - plan.first) % plan.stride != 0) continue;
    pairs_.push_back(plan.transform.Apply(pair->images, whole));
    world_from_left_.push_back(plan.transform.Apply(truth.at(i), whole.baseline_m));
  }
  if (!plan.is_backward) return;
  std::reverse(pairs_.begin(), pairs_.end());
  std::reverse(world_from_left_.begin(), world_from_left_.end());
  const double latest_s = pairs_.front().stamp_s;
  for (StereoImages& pair : pairs_) pair.stamp_s = latest_s - pair.stamp_s;
}

TruePair ClipWindow::Take(int pair) const {
  const StereoImages& images = pairs_.at(pair);
  return {{images.stamp_s, images.left.clone(), images.right.clone()},
          MatchBlocks(images, camera_)};
}

}  // namespace arfm_vo
