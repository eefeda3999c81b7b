// Maps of clips, and drives that wake up on them: how many find their place, and how many a wrong
// one. Usage: recognise_places DATA_DIR
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "arfm_vo/mapping/map_file.h"
#include "arfm_vo/odometry/session.h"
#include "arfm_vo/odometry/stereo_frontend.h"
#include "recordings/clip.h"

namespace arfm_vo {
namespace {

constexpr double kMaxWait_s = 3;
constexpr size_t kMaxPoints = 1000000;

/// What arfm_node, pose_node and ba_node do, one after the other.
class Drive {
 public:
  explicit Drive(const StereoCamera& camera)
      : camera_(camera), frontend_(camera, {}), session_(LocalOdometryOptions()), map_({}) {}

  /// odom_from_camera.
  SessionUpdate Process(const StereoImages& images) {
    SessionUpdate update =
        session_.Process(frontend_.Process(images), camera_, images, Rigid3());
    if (update.keyframe) {
      map_.Add(*update.keyframe);
      if (map_.IsAdjustmentDue())
        if (auto result = map_.Adjust()) session_.Offer(std::move(*result), map_.epoch());
    }
    return update;
  }
  PlacedMap& map() { return map_; }

 private:
  StereoCamera camera_;
  StereoFrontend frontend_;
  Session session_;
  PlacedMap map_;
};

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
    values.convertTo(*image, CV_8U);
    const int dx = image->cols / 20, dy = image->rows / 20;
    cv::Mat inner = (*image)(cv::Rect(dx, dy, image->cols - 2 * dx, image->rows - 2 * dy)).clone();
    image->setTo(0);
    inner.copyTo((*image)(cv::Rect(dx, dy, inner.cols, inner.rows)));
  }
  return changed;
}

KnownMap MakeMap(const Pairs& pairs) {
  Drive drive(pairs.camera);
  drive.map().Keep({}, kMaxPoints);
  for (size_t i = 0; i < pairs.images.size(); i += 2) drive.Process(pairs.images[i]);
  drive.map().Adjust();
  return drive.map().MakeKnownMap();
}

/// The place is right within 5 cm and 5 % of the way to the nearest place of the map, and 1 degree.
struct Result {
  int starts = 0, found = 0, wrong = 0;
  double wait_s = 0, worst_m = 0, worst_deg = 0;
};

Result WakeUp(const KnownMap& map, const Pairs& pairs, bool is_foreign, int step) {
  Result result;
  for (size_t start = 1; start + 6 < pairs.images.size(); start += step) {
    Drive drive(pairs.camera);
    drive.map().Keep(map, kMaxPoints);
    ++result.starts;
    const double start_s = pairs.images[start].stamp_s;
    for (size_t i = start; i < pairs.images.size(); i += 2) {
      const double waited_s = pairs.images[i].stamp_s - start_s;
      if (waited_s > kMaxWait_s && !is_foreign) break;
      const auto update = drive.Process(Changed(pairs.images[i], static_cast<int>(i)));
      if (drive.map().localiser().state() != MapState::kLocalised) continue;
      ++result.found;
      if (is_foreign) break;
      result.wait_s += waited_s;
      size_t nearest = 0;
      for (size_t k = 0; k < map.keyframes.size(); ++k)
        if (std::abs(map.keyframes[k].stamp_s - pairs.images[i].stamp_s) <
            std::abs(map.keyframes[nearest].stamp_s - pairs.images[i].stamp_s))
          nearest = k;
      size_t place = 0;
      for (size_t k = 0; k < pairs.images.size(); ++k)
        if (pairs.images[k].stamp_s == map.keyframes[nearest].stamp_s) place = k;
      const Rigid3 found = map.keyframes[nearest].map_from_camera.Inverse() *
                           drive.map().map_from_odom() * update.odom_from_base;
      const Rigid3 truth = pairs.reference[place].Inverse() * pairs.reference[i];
      const Rigid3 error = truth.Inverse() * found;
      const double error_m = error.translation.norm(), error_deg = error.Angle() * 180 / M_PI;
      result.worst_m = std::max(result.worst_m, error_m);
      result.worst_deg = std::max(result.worst_deg, error_deg);
      if (error_m > 0.05 + 0.05 * truth.translation.norm() || error_deg > 1) {
        ++result.wrong;
        std::printf("  wrong: pair %zu, %.3f m, %.2f deg: %s\n", i, error_m, error_deg,
                    drive.map().localiser().found().c_str());
      }
      break;
    }
  }
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

void Run(const std::string& data) {
  std::vector<Clip> clips = FindClips(data);
  std::vector<Pairs> pairs;
  std::vector<KnownMap> maps;
  for (const Clip& clip : clips) {
    pairs.push_back(Load(clip));
    maps.push_back(MakeMap(pairs.back()));
    const std::string bytes = FormatMap(maps.back(), 200000000);
    maps.back() = ParseMap(bytes, clip.name);
    const Result own = WakeUp(maps.back(), pairs.back(), false, 2);
    std::printf("%s: %zu keyframes, %zu points, %.2f MB; %d starts, %d found, %d wrong, mean wait "
                "%.2f s, worst %.3f m, %.2f deg\n",
                clip.name.c_str(), maps.back().keyframes.size(), NumPoints(maps.back().keyframes),
                bytes.size() / 1e6, own.starts, own.found, own.wrong,
                own.wait_s / std::max(1, own.found), own.worst_m, own.worst_deg);
    std::fflush(stdout);
  }
  for (size_t i = 0; i < clips.size(); ++i) {
    for (size_t k = 0; k < clips.size(); ++k) {
      if (i == k) continue;
      const Result foreign =
          WakeUp(maps[i], Resample(pairs[k], maps[i].camera), true,
                 static_cast<int>(pairs[k].images.size()));
      std::printf("%s on the map of %s: %d starts, %d found\n", clips[k].name.c_str(),
                  clips[i].name.c_str(), foreign.starts, foreign.found);
      std::fflush(stdout);
    }
  }
}

}  // namespace
}  // namespace arfm_vo

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  arfm_vo::Run(argv[1]);
  return 0;
}
