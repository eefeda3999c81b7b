#include <cstdio>
#include <map>

#include "arfm_vo/configuration/program.h"
#include "arfm_vo/evaluation/trajectory_plot.h"
#include "arfm_vo/mapping/map_file.h"

namespace {

using namespace arfm_vo;

struct Frame {
  size_t num_keyframes = 0, num_places = 0, num_points = 0;
  double path_m = 0;
  std::vector<Rigid3> first_from_base;  ///< axes as a picture from above has them: x right, z ahead
  double first_s = 0, last_s = 0;
};

std::map<int, Frame> Summarise(const KnownMap& map) {
  const Rigid3 picture_from_map(Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5).conjugate(),
                                Eigen::Vector3d::Zero());
  std::map<int, Frame> frames;
  for (const KnownKeyframe& keyframe : map.keyframes) {
    Frame& frame = frames[keyframe.frame];
    const Rigid3 base =
        picture_from_map * keyframe.map_from_camera * keyframe.base_from_camera.Inverse();
    if (frame.num_keyframes++ == 0) frame.first_s = keyframe.stamp_s;
    if (!frame.first_from_base.empty() && keyframe.stamp_s > frame.last_s)  // of one drive
      frame.path_m += (base.translation - frame.first_from_base.back().translation).norm();
    frame.first_from_base.emplace_back(Eigen::Quaterniond::Identity(), base.translation);
    frame.last_s = keyframe.stamp_s;
    frame.num_places += !keyframe.points.empty();
    frame.num_points += keyframe.points.size();
  }
  return frames;
}

void Tell(const std::string& path, const std::string& picture) {
  const KnownMap map = ReadMap(path);
  std::printf("frame: %s\ncamera: %dx%d px, fx %.3f, fy %.3f, cx %.3f, cy %.3f, baseline %.4f m\n",
              map.frame_id.c_str(), map.camera.width, map.camera.height, map.camera.fx,
              map.camera.fy, map.camera.cx, map.camera.cy, map.camera.baseline_m);
  if (map.correction)
    std::printf("learnt calibration: columns known to %.3f px\n",
                map.correction->MaxColumnSigma(map.camera));
  const std::map<int, Frame> frames = Summarise(map);
  std::printf("map frames: %zu\n", frames.size());
  for (const auto& [number, frame] : frames)
    std::printf(
        "frame %d: %zu keyframes, %zu of them places to be found at, %zu points, %.2f m of path, "
        "stamps %.3f to %.3f\n",
        number, frame.num_keyframes, frame.num_places, frame.num_points, frame.path_m,
        frame.first_s, frame.last_s);
  if (picture.empty() || frames.empty()) return;
  PlotTrajectory({frames.begin()->second.first_from_base, {}, {}}, picture);
}

}  // namespace

int main(int argc, char** argv) {
  std::string path, picture;
  Program program;
  program.name = "map_info";
  program.description =
      "Prints what is in a map of ba_node: camera, and for each map frame its keyframes, points "
      "and\n"
      "path.";
  program.inputs = {{"FILE", &path}};
  program.Add("picture", picture, "PNG", "draw the path of the oldest frame from above");
  program.run = [&] { Tell(path, picture); };
  return RunProgram(argc, argv, program);
}
