#include "arfm_vo/datasets/kitti_sequence.h"
#include "arfm_vo/evaluation/odometry_program.h"

int main(int argc, char** argv) {
  using namespace arfm_vo;
  Program program;
  program.name = "kitti_odometry";
  program.description =
      "Stereo visual odometry on a KITTI folder (image_0, image_1, calib.txt, optionally "
      "times.txt\n"
      "and poses.txt; or raw data), in process and repeatable.";
  const auto open = [](const std::string& folder, const PairSelection& selection) {
    return std::make_unique<KittiSequence>(folder, selection);
  };
  return RunOdometryProgram(argc, argv, program, "SEQUENCE_DIR", open);
}
