#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "arfm_vo/base/format.h"
#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/configuration/program.h"
#include "arfm_vo/evaluation/progress_bar.h"
#include "arfm_vo/simulation/board_set.h"

namespace {

using namespace arfm_vo;
namespace fs = std::filesystem;

struct BoardSet {
  Chessboard board;
  SensorOptions sensor;
  int num_pairs = 63, width = 1624, seed = 1, num_threads = 1;
  double max_tilt_deg = 40;
};

void WriteImage(const std::string& folder, const char* side, int pair, const cv::Mat& image) {
  const std::string path = folder + Format("/%s%03d.png", side, pair);
  if (!cv::imwrite(path, image)) throw std::runtime_error(path + ": cannot be written");
}

void RenderBoardSet(const std::string& folder, const BoardSet& set) {
  Require(!fs::exists(folder), folder + ": exists already");
  Require(set.num_pairs >= 1 && set.num_pairs <= 999, "pairs must be in 1..999");
  Require(set.width >= 64 && set.width <= 8192, "width must be in 64..8192");
  set.sensor.Check();
  const BoardRig rig = BoardRig::Make(set.width);
  const std::vector<Rigid3> poses =
      DrawBoardPoses(rig, set.board, set.num_pairs, set.max_tilt_deg, set.seed);
  const BoardRenderer left(rig.left, rig.image_size, set.board);
  const BoardRenderer right(rig.right, rig.image_size, set.board);
  const std::string unfinished = folder + ".unfinished";
  fs::create_directories(unfinished);
  ProgressBar bar(stderr);
  for (int i = 0; i < set.num_pairs; ++i) {
    WriteImage(unfinished, "left", i, left.Render(poses[i], set.sensor, 2 * i, set.num_threads));
    WriteImage(
        unfinished, "right", i,
        right.Render(rig.right_from_left * poses[i], set.sensor, 2 * i + 1, set.num_threads));
    bar.Show(i + 1, set.num_pairs);
  }
  WriteWholeFile(unfinished + "/truth.yaml", FormatTruth(rig, set.board));
  fs::rename(unfinished, folder);
}

}  // namespace

int main(int argc, char** argv) {
  std::string folder;
  BoardSet set;
  set.sensor.blur_px = 0.8;
  set.sensor.noise_grey_levels = 2;
  Program program;
  program.name = "render_board_set";
  program.description =
      "Renders stereo pairs of a chessboard with known truth: left000.png.., right000.png..,\n"
      "truth.yaml. The same options give the same bytes.";
  program.inputs = {{"OUTPUT_DIR", &folder}};
  program.Add("pairs", set.num_pairs, "N", "number of pairs, 63 if not given");
  program.Add("columns", set.board.columns, "N", "of inner corners");
  program.Add("rows", set.board.rows, "N", "of inner corners");
  program.Add("square", set.board.square_m, "M", "side of a square");
  program.Add("width", set.width, "PX", "of the images, with the same view");
  program.Add("max-tilt", set.max_tilt_deg, "DEG", "of the board");
  program.Add("blur", set.sensor.blur_px, "PX", "of the lens, standard deviation");
  program.Add("noise", set.sensor.noise_grey_levels, "LEVELS",
              "standard deviation of the grey values");
  program.Add("seed", set.seed, "S", "of the poses");
  program.Add("threads", set.num_threads, "N", "does not change the result");
  program.run = [&] { RenderBoardSet(folder, set); };
  return RunProgram(argc, argv, program);
}
