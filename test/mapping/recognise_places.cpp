// Maps of clips, and drives that wake up on them: how many find their place, and how many a wrong
// one. Usage: recognise_places DATA_DIR own|foreign
#include <algorithm>
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "arfm_vo/mapping/map_file.h"
#include "mapping/odometry_chain.h"
#include "recordings/clip.h"

namespace arfm_vo {
namespace {

constexpr double kMaxWait_s = 3;

struct Pairs {
  StereoCamera camera;
  std::vector<StereoImages> images;
  std::vector<Rigid3> reference;  ///< world_from_left, of the odometry on all pairs
};

Pairs Load(const Clip& clip) {
  const ClipWindow window(clip, {0, 0, clip.num_pairs, 1, false, {}},
                          std::vector<Rigid3>(clip.num_pairs));
  Pairs pairs{window.camera(), {}, {}};
  VisualOdometry odometry(window.camera(), OdometryOptions());
  for (int i = 0; i < window.size(); ++i) {
    pairs.images.push_back(window.Images(i));
    odometry.Process(window.Images(i));
  }
  for (const TrajectoryPose& pose : odometry.Finish())
    pairs.reference.push_back(pose.world_from_camera);
  return pairs;
}

/// Another day: 5 % less on each side, darker, with less contrast and more noise.
StereoImages Changed(const StereoImages& images, int seed) {
  StereoImages changed = images;
  cv::RNG random(seed);
  for (cv::Mat* image : {&changed.left, &changed.right}) {
    cv::Mat noise(image->size(), CV_32F), values;
    random.fill(noise, cv::RNG::NORMAL, 0, 4);
    image->convertTo(values, CV_32F, 0.6, 30);
    values += noise;
    image->release();  // the pair as it was keeps its pixels
    values.convertTo(*image, CV_8U);
    const int dx = image->cols / 20, dy = image->rows / 20;
    cv::Mat inner = (*image)(cv::Rect(dx, dy, image->cols - 2 * dx, image->rows - 2 * dy)).clone();
    image->setTo(0);
    inner.copyTo((*image)(cv::Rect(dx, dy, inner.cols, inner.rows)));
  }
  return changed;
}

KnownMap MakeMap(const Pairs& pairs) {
  OdometryChain drive(pairs.camera);
  drive.map().Keep({}, kMaxPoints);
  for (size_t i = 0; i < pairs.images.size(); i += 2) drive.Process(pairs.images[i]);
  drive.map().Adjust();
  return drive.map().MakeKnownMap();
}

/// A drive that begins at pair `start`, on every `step`th, until it is found or its time is over.
void WakeUp(const KnownMap& map, const Pairs& pairs, int start, int step, double max_wait_s,
            Result& result) {
  OdometryChain drive(pairs.camera);
  drive.map().Keep(map, kMaxPoints);
  ++result.starts;
  for (int i = start; i >= 0 && i < static_cast<int>(pairs.images.size()); i += step) {
    StereoImages images = Changed(pairs.images[i], i);
    const double waited_s = std::abs(images.stamp_s - pairs.images[start].stamp_s);
    if (waited_s > max_wait_s) return;
    images.stamp_s = 1 + waited_s;
    const auto update = drive.Process(images);
    // After a loss it may be found in what it has seen itself.
    const Localiser& localiser = drive.map().localiser();
    if (localiser.state() != MapState::kLocalised || localiser.own_frame() != 0) continue;
    ++result.found;
    result.wait_s += waited_s;
    if (pairs.reference.empty()) std::printf("  %s\n", localiser.found().c_str());
    if (pairs.reference.empty()) return;
    const auto away_s = [&](const KnownKeyframe& keyframe) {
      return std::abs(keyframe.stamp_s - pairs.images[i].stamp_s);
    };
    const auto nearest = std::min_element(
        map.keyframes.begin(), map.keyframes.end(),
        [&](const KnownKeyframe& a, const KnownKeyframe& b) { return away_s(a) < away_s(b); });
    size_t place = 0;
    while (pairs.images[place].stamp_s != nearest->stamp_s) ++place;
    const Rigid3 found =
        nearest->map_from_camera.Inverse() * drive.map().map_from_odom() * update.odom_from_base;
    const Rigid3 truth = pairs.reference[place].Inverse() * pairs.reference[i];
    double distance_m = 0;
    for (const KnownKeyframe& keyframe : map.keyframes)
      distance_m = std::max(distance_m, keyframe.distance_m);
    result.Judge(truth.Inverse() * found, distance_m, localiser.found());
    return;
  }
}

/// From every second pair on, which the map was not made of; in the second half backward.
Result WakeUpEverywhere(const KnownMap& map, const Pairs& pairs) {
  Result result;
  const int size = static_cast<int>(pairs.images.size());
  for (int start = 1; start < size; start += 2)
    WakeUp(map, pairs, start, 2 * start < size ? 2 : -2, kMaxWait_s, result);
  return result;
}

/// The pairs as the other camera would show them, nearly: its size, by scaling.
Pairs Resample(const Pairs& pairs, const StereoCamera& camera) {
  Pairs resampled{camera, {}, {}};
  for (StereoImages images : pairs.images) {
    for (cv::Mat* image : {&images.left, &images.right})
      cv::resize(image->clone(), *image, {camera.width, camera.height}, 0, 0, cv::INTER_AREA);
    resampled.images.push_back(images);
  }
  return resampled;
}

void Run(const std::string& data, bool is_foreign) {
  std::vector<Clip> clips = FindClips(data);
  std::vector<Pairs> pairs;
  std::vector<KnownMap> maps;
  for (const Clip& clip : clips) {
    pairs.push_back(Load(clip));
    maps.push_back(MakeMap(pairs.back()));
    const std::string bytes = FormatMap(maps.back(), 200000000);
    maps.back() = ParseMap(bytes, clip.name);
    if (is_foreign) continue;
    const Result own = WakeUpEverywhere(maps.back(), pairs.back());
    std::printf(
        "%s: %zu keyframes, %zu points, %.2f MB; %d starts, %d found, %d wrong, mean wait "
        "%.2f s, worst %.3f m, %.2f deg\n",
        clip.name.c_str(), maps.back().keyframes.size(), NumPoints(maps.back().keyframes),
        bytes.size() / 1e6, own.starts, own.found, own.wrong, own.wait_s / std::max(1, own.found),
        own.worst_m, own.worst_deg);
    std::fflush(stdout);
  }
  for (size_t i = 0; is_foreign && i < clips.size(); ++i) {
    for (size_t k = 0; k < clips.size(); ++k) {
      if (i == k) continue;
      Result foreign;
      WakeUp(maps[i], Resample(pairs[k], maps[i].camera), 1, 1, 1e9, foreign);
      std::printf("%s on the map of %s: %d starts, %d found\n", clips[k].name.c_str(),
                  clips[i].name.c_str(), foreign.starts, foreign.found);
      std::fflush(stdout);
    }
  }
}

}  // namespace
}  // namespace arfm_vo

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  arfm_vo::Run(argv[1], std::string(argv[2]) == "foreign");
  return 0;
}
