
#include "arfm_vo/configuration/program.h"
#include "arfm_vo/datasets/kitti_sequence.h"
#include "arfm_vo/evaluation/progress_bar.h"
#include "arfm_vo/ros/replay/stereo_outputs.h"

namespace {

using namespace arfm_vo;

void WriteBag(const std::string& folder, const PairSelection& selection,
              const std::string& frame_id, const std::string& bag) {
  KittiSequence sequence(folder, selection);
  StereoBagWriter writer(bag, StereoTopics{});
  ProgressBar bar(stderr);
  for (int done = 0; const auto pair = sequence.Next();) {
    writer.Write(ToMessages(*pair, sequence.camera(), frame_id));
    bar.Show(++done, sequence.size());
  }
  writer.Close();
}

}  // namespace

int main(int argc, char** argv) {
  std::string folder, bag, frame_id = "left_camera_optical";
  PairSelection selection;
  Program program;
  program.name = "kitti_to_bag";
  program.description =
      "Writes a KITTI folder as an lz4 bag with /stereo/left|right/image_rect, camera_info and\n"
      "/stereo/ground_truth. Stamps are those of times.txt + 1000 s.";
  program.inputs = {{"SEQUENCE_DIR", &folder}, {"BAG", &bag}};
  program.Add("pairs", selection.max_pairs, "N", "stop after N pairs (counted after --stride)");
  program.Add("stride", selection.stride, "K", "take every K-th pair");
  program.Add("frame-id", frame_id, "NAME", "frame_id of the messages");
  program.run = [&] { WriteBag(folder, selection, frame_id, bag); };
  return RunProgram(argc, argv, program);
}
