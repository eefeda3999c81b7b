#include "arfm_vo/ros/replay/truth_path.h"

#include <tf2/exceptions.h>

#include <stdexcept>

#include "arfm_vo/ros/messages/conversions.h"

namespace arfm_vo {

TruthAlignment::TruthAlignment(const tf2::BufferCore& buffer, std::string reference_frame,
                               std::string base_frame, std::string camera_frame)
    : buffer_(buffer),
      reference_frame_(std::move(reference_frame)),
      base_frame_(std::move(base_frame)),
      camera_frame_(std::move(camera_frame)) {}

std::optional<Rigid3> TruthAlignment::Align(const ros::Time& stamp,
                                            const Rigid3& truth_from_camera) {
  const auto look_up = [&](const std::string& target) {
    return FromMessage(buffer_.lookupTransform(target, camera_frame_, stamp).transform,
                       "tf " + target + " <- " + camera_frame_);
  };
  try {
    const Rigid3 base_from_camera = look_up(base_frame_);
    if (!reference_from_truth_)
      reference_from_truth_ = look_up(reference_frame_) * truth_from_camera.Inverse();
    return *reference_from_truth_ * truth_from_camera * base_from_camera.Inverse();
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  } catch (const std::invalid_argument&) {  // a transform that is not one
    return std::nullopt;
  }
}

}  // namespace arfm_vo
