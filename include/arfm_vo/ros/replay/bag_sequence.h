#pragma once

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Image.h>

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "arfm_vo/datasets/stamp_pairing.h"
#include "arfm_vo/datasets/stereo_sequence.h"
#include "arfm_vo/image/grey_window.h"
#include "arfm_vo/ros/messages/stereo_messages.h"

namespace arfm_vo {

/// The stereo pairs of a bag. Left and right belong together where their stamps differ by at most
/// `max_skew_s`; images without partner, and images not later than the one before, are left out and
/// counted. The truth of a pair is that of its left stamp, interpolated over at most 0.25 s.
class BagSequence : public StereoSequence {
 public:
  /// Reads camera_info and truth. Throws std::invalid_argument naming file and topic for: a
  /// missing, truncated or unindexed bag, missing topics or such of another type, a wrong camera.
  BagSequence(const std::string& path, const StereoTopics& topics,
              const PairSelection& selection = {}, double max_skew_s = 0.001);

  const StereoCamera& camera() const override { return camera_; }
  int size() const override { return size_; }
  /// Throws std::invalid_argument naming file and topic for an image that does not fit the camera,
  /// cannot be read as grey, or lies in a damaged part of the bag.
  std::optional<SequencePair> Next() override;
  /// unpaired_images, late_images.
  std::string FormatSummary() const override;

 private:
  using Image = sensor_msgs::ImageConstPtr;

  void Open();
  void ReadTruth();
  std::optional<std::pair<Image, Image>> ReadPair();
  std::optional<SequencePair> ReadSelectedPair();
  cv::Mat MakeGrey(const Image& image, const std::string& topic);
  std::optional<Rigid3> FindTruth(double stamp_s) const;

  std::string path_;
  StereoTopics topics_;
  PairSelection selection_;
  rosbag::Bag bag_;
  StereoCamera camera_;
  GreyWindow window_;
  std::map<double, Rigid3> truth_;  ///< world_from_camera by stamp
  std::unique_ptr<rosbag::View> images_;
  rosbag::View::iterator next_;
  StampPairing<Image> pairing_;
  int size_ = 0, num_read_ = 0, num_given_ = 0;
};

}  // namespace arfm_vo
