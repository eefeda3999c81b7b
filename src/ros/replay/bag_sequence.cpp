#include "arfm_vo/ros/replay/bag_sequence.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <vector>

#include "arfm_vo/base/format.h"
#include "arfm_vo/datasets/bag_records.h"
#include "arfm_vo/ros/messages/conversions.h"

namespace arfm_vo {
namespace {

constexpr double kMaxTruthGap_s = 0.25;

/// `read()`, with whatever the bag library throws as std::invalid_argument naming the file.
template <class Read>
auto ReadBag(const std::string& path, Read&& read) {
  try {
    return read();
  } catch (const rosbag::BagUnindexedException&) {
    throw std::invalid_argument(path +
                                ": has no index: the bag is truncated or was never closed "
                                "(rosbag reindex may save the rest)");
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(path + ": " + error.what());
  } catch (const std::exception& error) {  // rosbag, roscpp and lz4 have no common base
    throw std::invalid_argument(path + ": the bag is truncated or damaged: " + error.what());
  }
}

template <class Message>
boost::shared_ptr<Message> Instantiate(const rosbag::MessageInstance& instance) {
  const auto message = instance.instantiate<Message>();
  Require(message != nullptr, "topic " + instance.getTopic() + ": holds " + instance.getDataType() +
                                  " instead of " + ros::message_traits::datatype<Message>());
  return message;
}

/// The number of messages of a topic, at least 1.
int RequireTopic(const rosbag::Bag& bag, const std::string& topic) {
  const int count = static_cast<int>(rosbag::View(bag, rosbag::TopicQuery(topic)).size());
  if (count > 0) return count;
  std::string others;
  rosbag::View everything(bag);
  for (const auto* connection : everything.getConnections()) others += " " + connection->topic;
  throw std::invalid_argument("no messages on topic " + topic + "; the bag holds" +
                              (others.empty() ? " nothing" : others));
}

sensor_msgs::CameraInfo ReadInfo(const rosbag::Bag& bag, const std::string& topic) {
  RequireTopic(bag, topic);
  rosbag::View messages(bag, rosbag::TopicQuery(topic));
  return *Instantiate<sensor_msgs::CameraInfo>(*messages.begin());
}

}  // namespace

BagSequence::BagSequence(const std::string& path, const StereoTopics& topics,
                         const PairSelection& selection, double max_skew_s)
    : path_(path), topics_(topics), selection_(selection), pairing_(max_skew_s) {
  selection.Check();
  Require(max_skew_s >= 0, "max_skew_s must not be negative");
  Require(std::filesystem::exists(path), path + ": no such file");
  ReadBag(path_, [&] { Open(); });
}

void BagSequence::Open() {
  CheckBagRecords(path_);
  bag_.open(path_, rosbag::bagmode::Read);
  const int num_images =
      std::min(RequireTopic(bag_, topics_.left_image), RequireTopic(bag_, topics_.right_image));
  size_ = std::min((num_images - 1) / selection_.stride + 1, selection_.max_pairs);
  const sensor_msgs::CameraInfo left_info = ReadInfo(bag_, topics_.left_info);
  camera_ = MakeStereoCamera(left_info, ReadInfo(bag_, topics_.right_info));
  ReadTruth();
  images_ = std::make_unique<rosbag::View>(
      bag_, rosbag::TopicQuery(std::vector<std::string>{topics_.left_image, topics_.right_image}));
  next_ = images_->begin();
}

void BagSequence::ReadTruth() {
  for (const auto& instance : rosbag::View(bag_, rosbag::TopicQuery(topics_.ground_truth))) {
    const auto message = Instantiate<geometry_msgs::PoseStamped>(instance);
    truth_.emplace(message->header.stamp.toSec(),
                   FromMessage(message->pose, "topic " + topics_.ground_truth));
  }
}

std::optional<Rigid3> BagSequence::FindTruth(double stamp_s) const {
  const auto after = truth_.lower_bound(stamp_s);
  if (after == truth_.end()) return std::nullopt;
  if (after->first == stamp_s) return after->second;
  if (after == truth_.begin()) return std::nullopt;
  const auto before = std::prev(after);
  const double gap_s = after->first - before->first;
  if (gap_s > kMaxTruthGap_s) return std::nullopt;
  return Interpolate(before->second, after->second, (stamp_s - before->first) / gap_s);
}

cv::Mat BagSequence::MakeGrey(const Image& image, const std::string& topic) {
  const cv::Mat grey = ToGrey(image, "topic " + topic, window_);
  Require(grey.cols == camera_.width && grey.rows == camera_.height,
          Format("topic %s: an image is %dx%d, camera_info says %dx%d", topic.c_str(), grey.cols,
                 grey.rows, camera_.width, camera_.height));
  return grey.clone();  // the message goes
}

std::optional<std::pair<BagSequence::Image, BagSequence::Image>> BagSequence::ReadPair() {
  auto pair = pairing_.Take();
  for (; !pair && next_ != images_->end(); ++next_) {
    const Image image = Instantiate<sensor_msgs::Image>(*next_);
    const double stamp_s = image->header.stamp.toSec();
    if (next_->getTopic() == topics_.left_image) {
      pairing_.AddLeft(stamp_s, image);
    } else {
      pairing_.AddRight(stamp_s, image);
    }
    pair = pairing_.Take();
  }
  return pair;
}

std::optional<SequencePair> BagSequence::ReadSelectedPair() {
  if (num_given_ == selection_.max_pairs) return std::nullopt;
  auto images = ReadPair();
  for (; images && num_read_ % selection_.stride != 0; images = ReadPair()) ++num_read_;
  if (!images) return std::nullopt;
  ++num_read_;
  ++num_given_;
  SequencePair pair;
  pair.images = {images->first->header.stamp.toSec(), MakeGrey(images->first, topics_.left_image),
                 MakeGrey(images->second, topics_.right_image)};
  pair.true_world_from_camera = FindTruth(pair.images.stamp_s);
  return pair;
}

std::optional<SequencePair> BagSequence::Next() {
  return ReadBag(path_, [&] { return ReadSelectedPair(); });
}

std::string BagSequence::FormatSummary() const {
  return "unpaired_images: " + std::to_string(pairing_.CountUnpaired()) +
         "\nlate_images: " + std::to_string(pairing_.num_late()) + "\n";
}

}  // namespace arfm_vo
