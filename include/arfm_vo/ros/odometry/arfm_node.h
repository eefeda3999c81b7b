#pragma once

#include <arfm_vo/FeaturesRequest.h>
#include <arfm_vo/StereoFrameStamped.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <deque>
#include <memory>
#include <string>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/base/worker.h"
#include "arfm_vo/datasets/pair_order.h"
#include "arfm_vo/odometry/visual_odometry.h"
#include "arfm_vo/ros/input/stereo_input.h"
#include "arfm_vo/ros/node/health.h"
#include "arfm_vo/ros/odometry/learned_calibration.h"

namespace arfm_vo {

struct ArfmNodeOptions {
  OdometryOptions algorithm;  ///< its keys stand beside those of the node; `frontend` is used
  int max_waiting_pairs = 4;  ///< older ones are dropped
  /// Whether the features of every pair are computed, not only of those that pose_node asks for.
  bool features_always = false;
  int max_kept_pairs = 10;            ///< that may be asked for; older ones are forgotten
  bool remember_calibration = false;  ///< from drive to drive, a file a camera

  void Check() const {
    algorithm.Check();
    Require(max_waiting_pairs >= 1, "max_waiting_pairs must be at least 1");
    Require(max_kept_pairs >= 1, "max_kept_pairs must be at least 1");
  }
  ARFM_FIELDS((algorithm), max_waiting_pairs, features_always, max_kept_pairs, remember_calibration)
};

/// Rectified stereo pairs in, `features` out: layers image to reconstruction. Pairs are announced,
/// and their features are computed where they are asked for. Subscribes to the pairs only while
/// somebody subscribes to `features`, so that a player which waits for subscribers waits for the
/// whole chain.
class ArfmNode {
 public:
  /// Throws std::invalid_argument naming a wrong parameter (ArfmNodeOptions).
  ArfmNode(ros::NodeHandle node, ros::NodeHandle private_node);
  /// Tells how many pairs came on the console.
  ~ArfmNode();

 private:
  /// How the pairs since the start fared.
  struct Figures {
    uint32_t num_published = 0, num_with_features = 0, num_strays = 0;
    Refusals refusals{"pair"};
    size_t num_left = 0, num_right = 0, num_points = 0;
    PairTimes times;
    bool is_idle = true;         ///< nobody subscribes to features
    StereoInputCounts input;     ///< of all topics
    std::string input_obstacle;  ///< what keeps messages from making pairs; empty: nothing
  };

  void Connect();
  void ReportFigures();
  void TellDrops();
  // On the worker's thread:
  void Process(const StereoMessagePair& pair);
  void Answer(const FeaturesRequest& request);
  /// A pair as it was announced.
  struct Announced {
    StereoMessagePair messages;  ///< own the pixels of `images`
    StereoImages images;
    StereoFrameStamped message;
    StereoFrame frame;
    StereoFrameStampedConstPtr whole;  ///< with features; null: nobody has asked for them
  };
  void PublishFeatures(Announced& pair);
  StereoFrameStampedConstPtr Complete(const Announced& pair);
  /// Says whether the pair is to be worked on; begins anew where time has jumped.
  bool AcceptStamp(const ros::Time& stamp);
  void PrepareFrontend(const StereoMessagePair& pair);
  void Report(Diagnostics& status);

  ros::NodeHandle node_, private_node_;
  const ArfmNodeOptions options_;
  const StereoTopics topics_;
  // Of the thread that calls back:
  ConsoleWatch drop_watch_;
  uint32_t num_dropped_before_ = 0;
  // Of the worker's thread:
  StereoCamera camera_;
  GreyWindow window_;
  std::unique_ptr<StereoFrontend> frontend_;
  std::deque<Announced> announced_;  // the newest
  LearnedCalibration learned_;
  StampOrder<ros::Time> stamps_;
  Figures figures_;
  diagnostic_updater::Updater diagnostics_;
  Worker worker_;
  std::unique_ptr<StereoInput> input_;
  ros::Publisher features_;
  ros::Subscriber requests_;
  ros::WallTimer timer_;
};

}  // namespace arfm_vo
