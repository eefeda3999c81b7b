#include "arfm_vo/evaluation/odometry_program.h"
#include "arfm_vo/ros/replay/bag_sequence.h"

int main(int argc, char** argv) {
  using namespace arfm_vo;
  StereoTopics topics;
  double max_skew_s = 0.001;
  Program program;
  program.name = "bag_odometry";
  program.description =
      "Stereo visual odometry on a bag of rectified pairs, in process and repeatable.";
  program.Add("left", topics.left_image, "TOPIC", "left image_rect");
  program.Add("right", topics.right_image, "TOPIC", "right image_rect");
  program.Add("left-info", topics.left_info, "TOPIC", "left camera_info");
  program.Add("right-info", topics.right_info, "TOPIC", "right camera_info");
  program.Add("ground-truth", topics.ground_truth, "TOPIC", "true poses of the left optical frame");
  program.Add("max-skew", max_skew_s, "S", "most time between left and right of a pair, s");
  const auto open = [&](const std::string& bag, const PairSelection& selection) {
    return std::make_unique<BagSequence>(bag, topics, selection, max_skew_s);
  };
  return RunOdometryProgram(argc, argv, program, "BAG", open);
}
