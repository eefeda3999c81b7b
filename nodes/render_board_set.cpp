#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/configuration/program.h"
#include "arfm_vo/evaluation/progress_bar.h"
#include "arfm_vo/simulation/board_set.h"

namespace {

using namespace arfm_vo;
namespace fs = std::filesystem;

struct BoardSet {
  BoardPattern pattern;
  SensorOptions sensor;
  int num_pairs = 63, width = 1624, seed = 1, num_threads = 1;
  double max_tilt_deg = 40;
};

void WriteImage(const std::string& folder, const char* eye, int pair, const cv::Mat& image) {
  char name[32];
  std::snprintf(name, sizeof(name), "/%s%03d.png", eye, pair);
  if (!cv::imwrite(folder + name, image)) {
    throw std::runtime_error(folder + name + ": cannot be written");
  }
}

void RenderBoardSet(const std::string& folder, const BoardSet& set) {
  Require(!fs::exists(folder), folder + ": exists already");
  Require(set.num_pairs >= 1 && set.num_pairs <= 999, "pairs must be in 1..999");
  Require(set.width >= 64 && set.width <= 8192, "width must be in 64..8192");
  set.sensor.Check();
  const BoardRig rig = BoardRig::Make(set.width);
  const std::vector<Rigid3> poses =
      DrawBoardPoses(rig, set.pattern, set.num_pairs, set.max_tilt_deg, set.seed);
  const BoardRenderer left(rig.left, set.pattern), right(rig.right, set.pattern);
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
  WriteWholeFile(unfinished + "/truth.yaml", FormatTruth(rig, set.pattern));
  fs::rename(unfinished, folder);
}

}  // namespace

int main(int argc, char** argv) {
  namespace po = boost::program_options;
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
  program.options.add_options()("pairs", po::value(&set.num_pairs)->value_name("N"),
                                "number of pairs, 63 if not given")(
      "columns", po::value(&set.pattern.columns)->value_name("N"), "of inner corners")(
      "rows", po::value(&set.pattern.rows)->value_name("N"), "of inner corners")(
      "square", po::value(&set.pattern.square_m)->value_name("M"), "side of a square")(
      "width", po::value(&set.width)->value_name("PX"), "of the images, with the same view")(
      "max-tilt", po::value(&set.max_tilt_deg)->value_name("DEG"), "of the board")(
      "blur", po::value(&set.sensor.blur_px)->value_name("PX"), "of the lens, standard deviation")(
      "noise", po::value(&set.sensor.noise_grey_levels)->value_name("LEVELS"),
      "standard deviation of the grey values")("seed", po::value(&set.seed)->value_name("S"),
                                               "of the poses")(
      "threads", po::value(&set.num_threads)->value_name("N"), "does not change the result");
  program.run = [&] { RenderBoardSet(folder, set); };
  return RunProgram(argc, argv, program);
}
