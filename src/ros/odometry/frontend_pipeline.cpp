#include "arfm_vo/ros/odometry/frontend_pipeline.h"

#include <algorithm>
#include <boost/make_shared.hpp>

#include "arfm_vo/image/grey_window.h"
#include "arfm_vo/ros/messages/conversions.h"
#include "arfm_vo/ros/messages/image_conversion.h"
#include "arfm_vo/ros/messages/stereo_camera_model.h"
#include "arfm_vo/ros/node/parameters.h"
#include "arfm_vo/ros/odometry/arfm_node_options.h"

namespace arfm_vo {

void ArfmNodeOptions::Check() const {
  algorithm.Check();
  Require(max_waiting_pairs >= 1, "max_waiting_pairs must be at least 1");
}

namespace {

class StereoPipeline : public FrontendPipeline {
 public:
  StereoPipeline(const ArfmNodeOptions& options, const StereoTopics& topics)
      : options_(options), topics_(topics), learned_(options.learned) {}

  StereoFrameStampedPtr Process(const StereoMessagePair& pair) override;
  void Reset() override { frontend_.reset(); }
  int max_waiting_pairs() const override { return options_.max_waiting_pairs; }

 private:
  void CheckNotRaw(const StereoMessagePair& pair) const;
  void PrepareFrontend(const StereoMessagePair& pair);

  const ArfmNodeOptions options_;
  const StereoTopics topics_;
  StereoCamera camera_;
  GreyWindow window_;
  std::unique_ptr<StereoFrontend> frontend_;
  LearnedCalibration learned_;
};

StereoFrameStampedPtr StereoPipeline::Process(const StereoMessagePair& pair) {
  PrepareFrontend(pair);
  CheckSize(*pair.left, *pair.left_info, topics_.left_image);
  CheckSize(*pair.right, *pair.right_info, topics_.right_image);
  const StereoImages images{pair.left->header.stamp.toSec(),
                            ToGrey(pair.left, topics_.left_image, window_),
                            ToGrey(pair.right, topics_.right_image, window_)};
  StageTimes stages;
  const StereoFrame frame = frontend_->Process(images, &stages);
  const auto message = boost::make_shared<StereoFrameStamped>(ToMessage(frame, camera_));
  message->header = pair.left->header;
  for (const auto& [name, ms] : stages) {
    message->stage_names.push_back(name);
    message->stage_ms.push_back(ms);
  }
  return message;
}

void StereoPipeline::PrepareFrontend(const StereoMessagePair& pair) {
  const StereoCamera camera = MakeStereoCamera(*pair.left_info, *pair.right_info);
  if (frontend_ && camera == camera_) return;
  frontend_ = std::make_unique<StereoFrontend>(camera, options_.algorithm.frontend);
  if (const auto known = learned_.ReadFor(camera)) frontend_->SetCorrection(*known);
  camera_ = camera;
  CheckNotRaw(pair);
  ROS_INFO("stereo camera %dx%d, focal length %.1f px, baseline %.4f m", camera.width,
           camera.height, camera.fx, camera.baseline_m);
}

void StereoPipeline::CheckNotRaw(const StereoMessagePair& pair) const {
  const std::vector<double>& distortion = pair.left_info->D;
  const bool is_distorted =
      std::any_of(distortion.begin(), distortion.end(), [](double d) { return d != 0; });
  if (is_distorted && topics_.left_image.find("image_raw") != std::string::npos)
    ROS_WARN(
        "%s is raw by its name, and its camera_info has distortion: where it is not rectified, "
        "give "
        "odometry.launch rectify:=true",
        topics_.left_image.c_str());
}

}  // namespace

std::unique_ptr<FrontendPipeline> MakeFrontendPipeline(const ros::NodeHandle& private_node,
                                                       const StereoTopics& topics) {
  return std::make_unique<StereoPipeline>(ReadParameters<ArfmNodeOptions>(private_node), topics);
}

}  // namespace arfm_vo
