#include "arfm_vo/odometry/stereo_frontend.h"

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/stopwatch.h"

namespace arfm_vo {

StereoFrontend::StereoFrontend(const StereoCamera& camera, const FrontendOptions& options)
    : camera_(camera),
      options_(options),
      left_mask_(options.left_mask, {camera.width, camera.height}),
      left_surf_(options.surf),
      right_surf_(options.surf),
      reconstructor_(camera, options.stereo) {
  camera.Check();
}

StereoFrame StereoFrontend::Look(const StereoImages& images) {
  images.Check();
  Require(images.left.cols == camera_.width && images.left.rows == camera_.height,
          "stereo frontend: images are " + std::to_string(images.left.cols) + "x" +
              std::to_string(images.left.rows) + ", the camera is " +
              std::to_string(camera_.width) + "x" + std::to_string(camera_.height));
  StereoFrame frame;
  frame.stamp_s = images.stamp_s;
  frame.left_is_repeated = left_repeated_.Look(images.left);
  frame.right_is_repeated = right_repeated_.Look(images.right);
  frame.grey = ComputeGreyStatistics(images.left);
  return frame;
}

StereoFrame StereoFrontend::Complete(StereoFrame frame, const StereoImages& images,
                                     StageTimes* stage_ms) {
  Stopwatch stopwatch;
  Features right_features;
  TaskThread::Task right =
      right_thread_.Start([&] { right_features = right_surf_.Extract(images.right); });
  frame.features = left_mask_.WithoutHidden(left_surf_.Extract(images.left));
  right.Get();
  frame.num_right_keypoints = right_features.size();
  const double features_ms = stopwatch.LapMs();
  frame.ratio_threshold = reconstructor_.RatioThreshold(frame.grey);
  if (!frame.right_is_repeated) {
    frame.points = reconstructor_.Reconstruct(frame.features, right_features, images);
    frame.row_agreement = reconstructor_.row_agreement();
    frame.images_are_swapped = reconstructor_.images_are_swapped();
  }
  if (stage_ms != nullptr) {
    stage_ms->emplace_back("features", features_ms);
    stage_ms->emplace_back("stereo", stopwatch.LapMs());
  }
  return frame;
}

}  // namespace arfm_vo
