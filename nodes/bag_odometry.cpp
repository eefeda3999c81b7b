#include "arfm_vo/evaluation/odometry_program.h"
#include "arfm_vo/ros/replay/bag_sequence.h"

int main(int argc, char** argv) {
  using namespace arfm_vo;
  namespace po = boost::program_options;
  StereoTopics topics;
  double max_skew_s = 0.001;
  OdometryProgram program;
  program.name = "bag_odometry";
  program.description =
      "Stereo visual odometry on a bag of rectified pairs, in process and repeatable.";
  program.input_name = "BAG";
  const auto topic = [](std::string& name) { return po::value(&name)->value_name("TOPIC"); };
  program.options.add_options()("left", topic(topics.left_image), "left image_rect")(
      "right", topic(topics.right_image), "right image_rect")("left-info", topic(topics.left_info),
                                                              "left camera_info")(
      "right-info", topic(topics.right_info), "right camera_info")(
      "ground-truth", topic(topics.ground_truth), "true poses of the left optical frame")(
      "max-skew", po::value(&max_skew_s)->value_name("S"),
      "most time between left and right of a pair, s");
  program.open = [&](const std::string& bag, const PairSelection& selection) {
    return std::make_unique<BagSequence>(bag, topics, selection, max_skew_s);
  };
  return RunOdometryProgram(argc, argv, program);
}
