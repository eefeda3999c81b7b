#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "recordings/judged_run.h"
#include "recordings/recording_plan.h"
#include "recordings/rendered_drive.h"
#include "recordings/view_transform.h"

namespace arfm_vo {
namespace {

const StereoCamera kCamera{300, 300, 150.3, 118.6, 0.2, 320, 240};

/// Where a pixel (u_left, v, u_right) goes when the pictures are cropped, scaled, flipped: by the
/// pictures alone, without a camera.
Eigen::Vector3d Follow(const ViewTransform& transform, const Eigen::Vector3d& pixel) {
  Eigen::Vector3d moved =
      pixel - Eigen::Vector3d(transform.crop_left, transform.crop_top, transform.crop_left);
  const double width = kCamera.width - transform.crop_left - transform.crop_right;
  const double height = kCamera.height - transform.crop_top - transform.crop_bottom;
  const double new_width = std::lround(width * transform.scale);
  const double new_height = std::lround(height * transform.scale);
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5);
  moved = (moved + half)
              .cwiseProduct(
                  Eigen::Vector3d(new_width / width, new_height / height, new_width / width)) -
          half;
  if (transform.swap == ImageSwap::kNone) return moved;
  const double v = transform.swap == ImageSwap::kTurned ? new_height - 1 - moved.y() : moved.y();
  return {new_width - 1 - moved.z(), v, new_width - 1 - moved.x()};
}

std::vector<ViewTransform> AllTransforms() {
  std::vector<ViewTransform> all;
  for (const ImageSwap swap : {ImageSwap::kNone, ImageSwap::kMirrored, ImageSwap::kTurned}) {
    all.push_back({0, 0, 0, 0, 1, swap});
    all.push_back({11, 7, 21, 3, 1, swap});
    all.push_back({0, 0, 0, 0, 0.73, swap});
    all.push_back({5, 12, 2, 9, 0.61, swap});
  }
  return all;
}

/// World and pose changed alike give the pixels that the changed pictures have.
TEST(ViewTransform, CameraAndPoseAgreeWithPictures) {
  const Rigid3 world_from_left(ExpSO3({0.1, -0.4, 0.2}), Eigen::Vector3d(0.7, -0.3, 1.9));
  for (const ViewTransform& transform : AllTransforms()) {
    const StereoCamera view = transform.Apply(kCamera);
    const Rigid3 new_pose = transform.Apply(world_from_left, kCamera.baseline_m);
    Draw draw(3);
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector3d x_in_left(draw.Between(-1, 1), draw.Between(-1, 1), draw.Between(2, 9));
      const Eigen::Vector3d x_in_world = world_from_left * x_in_left;
      const Eigen::Vector3d new_point = transform.ApplyToPoint(x_in_world, kCamera.baseline_m);
      const Eigen::Vector3d expected = Follow(transform, kCamera.ProjectStereo(x_in_left));
      const Eigen::Vector3d projected = view.ProjectStereo(new_pose.Inverse() * new_point);
      EXPECT_LT((projected - expected).norm(), 1e-6)
          << ToString(transform.swap) << transform.CutName();
    }
  }
}

/// The centre of gravity of a bright spot.
Eigen::Vector2d FindSpot(const cv::Mat& image) {
  const cv::Moments moments = cv::moments(image);
  return {moments.m10 / moments.m00, moments.m01 / moments.m00};
}

TEST(ViewTransform, PicturesAreChangedAsPixelsAre) {
  const Eigen::Vector3d spot(170, 90, 140);
  StereoImages images{1, cv::Mat::zeros(240, 320, CV_8U), cv::Mat::zeros(240, 320, CV_8U)};
  cv::circle(images.left, {170, 90}, 8, 200, cv::FILLED);
  cv::circle(images.right, {140, 90}, 8, 200, cv::FILLED);
  for (const ViewTransform& transform : AllTransforms()) {
    const StereoImages view = transform.Apply(images, kCamera);
    const StereoCamera camera = transform.Apply(kCamera);
    EXPECT_EQ(view.left.size(), cv::Size(camera.width, camera.height));
    const Eigen::Vector3d expected = Follow(transform, spot);
    const Eigen::Vector2d left = FindSpot(view.left), right = FindSpot(view.right);
    EXPECT_NEAR(left.x(), expected.x(), 0.02) << ToString(transform.swap) << transform.CutName();
    EXPECT_NEAR(left.y(), expected.y(), 0.02) << ToString(transform.swap) << transform.CutName();
    EXPECT_NEAR(right.x(), expected.z(), 0.02) << ToString(transform.swap) << transform.CutName();
  }
}

TEST(ViewTransform, TwiceMirroredIsTheSame) {
  const Rigid3 pose(ExpSO3({0.1, -0.4, 0.2}), Eigen::Vector3d(0.7, -0.3, 1.9));
  for (const ImageSwap swap : {ImageSwap::kMirrored, ImageSwap::kTurned}) {
    const ViewTransform transform{0, 0, 0, 0, 1, swap};
    const Rigid3 same = transform.Apply(transform.Apply(pose, 0.2), 0.2);
    EXPECT_LT((same.Inverse() * pose).translation.norm(), 1e-12);
    EXPECT_LT((same.Inverse() * pose).Angle(), 1e-7);
    EXPECT_TRUE(transform.Apply(transform.Apply(kCamera)) == kCamera);
  }
}

/// A small rendered recording with the fault asked for.
RecordingPlan SmallPlan(uint32_t seed, const std::string& fault) {
  RecordingPlan plan = DrawRecording(seed, {}, 16);
  const double scale = 160.0 / plan.drive.camera.width;
  StereoCamera& camera = plan.drive.camera;
  camera = {camera.fx * scale, camera.fy * scale, 79.5, 59.5, camera.baseline_m, 160, 120};
  Draw draw(seed);
  plan.fault = DrawFaultPlan(fault, plan.num_pairs(), draw);
  return plan;
}

Recording Render(const RecordingPlan& plan) {
  return {plan, std::make_unique<RenderedDrive>(plan.drive)};
}

TEST(Recording, SameSeedGivesSamePairs) {
  for (const uint32_t seed : {1u, 2u}) {
    Recording first = Render(SmallPlan(seed, "object")), second = Render(SmallPlan(seed, "object"));
    for (int i = 0; i < 2; ++i) {
      const Recording::Pair a = first.Take(i), b = second.Take(i);
      EXPECT_EQ(cv::norm(a.images.left, b.images.left, cv::NORM_INF), 0);
      EXPECT_EQ(cv::norm(a.images.right, b.images.right, cv::NORM_INF), 0);
    }
  }
}

TEST(Recording, AnotherSeedGivesAnotherPlan) {
  const RecordingPlan a = DrawRecording(1, {}, 60), b = DrawRecording(2, {}, 60);
  EXPECT_NE(a.drive.camera.fx, b.drive.camera.fx);
}

TEST(Recording, FaultChangesPicturesFromItsBeginOnly) {
  for (const std::string& kind : FaultKinds()) {
    RecordingPlan plan = SmallPlan(14, kind);
    plan.light = {};
    plan.fault.begin = std::min(plan.fault.begin, 1);
    Recording recording = Render(plan);
    bool is_changed = false;
    for (int i = 0; i < 3; ++i) {
      const Recording::Pair pair = recording.Take(i);
      const double change = cv::norm(pair.clean.images.left, pair.images.left, cv::NORM_L1) +
                            cv::norm(pair.clean.images.right, pair.images.right, cv::NORM_L1);
      if (i < plan.fault.begin) {
        EXPECT_EQ(change, 0) << kind;
      }
      is_changed |= change > 0;
    }
    EXPECT_EQ(is_changed, kind != "none") << kind;
  }
}

/// What is seen at a point of known depth in one pair is seen where the truth says in the next.
TEST(RenderedDrive, DepthAndPosesAgreeWithPictures) {
  RecordingPlan plan = SmallPlan(7, "none");
  plan.drive.scene = "rocks";
  plan.drive.motion = "straight";
  plan.drive.noise_grey_levels = 0;
  const RenderedDrive drive(plan.drive);
  const TruePair first = drive.Take(0), second = drive.Take(3);
  const Rigid3 second_from_first = drive.WorldFromLeft(3).Inverse() * drive.WorldFromLeft(0);
  const StereoCamera& camera = drive.camera();
  cv::Mat moved_u(camera.height, camera.width, CV_32F), moved_v = moved_u.clone();
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double z = std::min(1e5f, first.depth_m.at<float>(v, u));
      const Eigen::Vector3d x((u - camera.cx) / camera.fx * z, (v - camera.cy) / camera.fy * z, z);
      const Eigen::Vector2d pixel = camera.Project(second_from_first * x);
      moved_u.at<float>(v, u) = static_cast<float>(pixel.x());
      moved_v.at<float>(v, u) = static_cast<float>(pixel.y());
    }
  }
  cv::Mat warped;
  // Smooth, so that the detail that warping loses does not count.
  for (const cv::Mat& image : {first.images.left, second.images.left}) {
    cv::GaussianBlur(image, image, {7, 7}, 0);
  }
  cv::remap(second.images.left, warped, moved_u, moved_v, cv::INTER_LINEAR);
  const cv::Rect middle(40, 50, 80, 50);
  const double by_truth = cv::norm(warped(middle), first.images.left(middle), cv::NORM_L1);
  const double unmoved =
      cv::norm(second.images.left(middle), first.images.left(middle), cv::NORM_L1);
  EXPECT_LT(by_truth, 0.5 * unmoved);
}

TEST(SharedView, OppositeViewsShareNothing) {
  RecordingPlan plan = SmallPlan(7, "none");
  const RenderedDrive drive(plan.drive);
  const TruePair pair = drive.Take(0);
  const cv::Mat& left = pair.images.left;
  EXPECT_GT(CompareViews(drive.camera(), pair, pair, {}, {left, {}, 0}).share, 0.95);
  const Rigid3 turned(ExpSO3({0, M_PI, 0}), Eigen::Vector3d::Zero());
  EXPECT_EQ(CompareViews(drive.camera(), pair, pair, turned, {left, {}, 0}).share, 0);
}

}  // namespace
}  // namespace arfm_vo
