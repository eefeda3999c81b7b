#include "recordings/recording_plan.h"

#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "arfm_vo/simulation/hash_noise.h"

namespace arfm_vo {
namespace {

constexpr double kRenderedShare = 1.0 / 3, kFaultShare = 0.5;

std::string Format(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof(text), format, value);
  return text;
}

std::string FovClass(const StereoCamera& camera) {
  const double fov = 2 * std::atan(camera.width / (2 * camera.fx)) * 180 / M_PI;
  return fov < 60 ? "narrow" : fov < 85 ? "medium" : "wide";
}

std::string BaselineClass(double baseline_m) {
  return baseline_m < 0.1 ? "below_0.1" : baseline_m < 0.25 ? "0.1-0.25" : "from_0.25";
}

std::string SizeClass(const StereoCamera& camera) {
  return camera.width <= 330 ? "to_330" : camera.width <= 700 ? "to_700" : "wider";
}

std::string LightClass(const LightPlan& light) {
  if (light.last_gain != 1) return "drifting";
  if (light.gain < 0.6) return "dark";
  return light.IsChanged() ? "other" : "as_taken";
}

}  // namespace

double RecordingPlan::NoiseGreyLevels() const {
  const double sensor = kind == Kind::kRendered ? drive.noise_grey_levels : 0;
  return std::hypot(sensor, light.noise_grey_levels);
}

Kind KindOfSeed(uint32_t seed) {
  return HashUnit(HashWord(seed) + 17) < kRenderedShare ? Kind::kRendered : Kind::kReal;
}

bool IsForTuning(uint32_t seed) { return HashWord(HashWord(seed) + 29) % 2 == 0; }

RecordingPlan DrawRecording(uint32_t seed, const std::vector<Clip>& clips, int max_pairs) {
  Draw draw(HashWord(seed) + 1);
  RecordingPlan plan;
  plan.seed = seed;
  plan.kind = clips.empty() ? Kind::kRendered : KindOfSeed(seed);
  if (plan.kind == Kind::kReal) {
    plan.clip = DrawClipPlan(clips, max_pairs, draw);
  } else {
    plan.drive = DrawDrivePlan(max_pairs, draw);
  }
  plan.light = DrawLightPlan(draw);
  std::vector<std::string> faults(FaultKinds().begin() + 1, FaultKinds().end());
  const std::string fault = draw.OneOf(faults);
  plan.fault = DrawFaultPlan(draw.Chance(kFaultShare) ? fault : "none", plan.num_pairs(), draw);
  return plan;
}

Properties DescribeRecording(const RecordingPlan& plan, const std::vector<Clip>& clips,
                             const StereoCamera& camera) {
  const bool is_real = plan.kind == Kind::kReal;
  const Clip clip = is_real ? clips.at(plan.clip.clip) : Clip{};
  const std::string height = Format("%.2f", plan.drive.shape.camera_height_m);
  return {
      {"half", IsForTuning(plan.seed) ? "tune" : "judge"},
      {"kind", is_real ? "real" : "rendered"},
      {"source", is_real ? clip.name : "rendered"},
      {"motion", is_real ? clip.motion : plan.drive.motion},
      {"scene", is_real ? clip.scene : plan.drive.scene},
      {"fault", plan.fault.kind},
      {"stride", is_real ? std::to_string(plan.clip.stride) : "1"},
      {"direction", plan.clip.is_backward ? "backward" : "forward"},
      {"light", LightClass(plan.light)},
      {"noise", plan.light.noise_grey_levels > 0 ? "added" : "none"},
      {"fov", FovClass(camera)},
      {"baseline", BaselineClass(camera.baseline_m)},
      {"width", SizeClass(camera)},
      {"swap", ToString(plan.clip.transform.swap)},
      {"cut", plan.clip.transform.CutName()},
      {"interval_s", is_real ? "as_taken" : Format("%.2f", plan.drive.interval_s)},
      {"size", std::to_string(camera.width) + "x" + std::to_string(camera.height)},
      {"first", std::to_string(plan.clip.first)},
      {"fault_begin", std::to_string(plan.fault.begin)},
      {"step_m", is_real ? "as_taken" : Format("%.3f", plan.drive.step_m)},
      {"camera_height_m", is_real ? "as_taken" : height},
  };
}

Recording::Recording(const RecordingPlan& plan, std::unique_ptr<PairSource> source)
    : plan_(plan),
      source_(std::move(source)),
      fault_(MakeFault(plan.fault, source_->camera())),
      light_(ChangeLight(plan.light, source_->size())),
      noise_([](int, StereoImages&) {}) {
  if (plan.light.noise_grey_levels > 0) {
    noise_ = OnEachImage(AddNoiseOf(plan.light.noise_grey_levels));
  }
}

Recording::Pair Recording::Take(int index) {
  Pair pair;
  pair.clean = source_->Take(index);
  const StereoImages& clean = pair.clean.images;
  pair.images = {clean.stamp_s, clean.left.clone(), clean.right.clone()};
  fault_(index, pair.images);
  if (plan_.fault.HidesView()) {
    pair.shown.hidden = pair.images.left != clean.left;
    // Grey values agree by chance within a thing: closed, and its border too.
    cv::dilate(pair.shown.hidden, pair.shown.hidden, cv::Mat());
  }
  pair.images.right = pair.images.right.clone();  // a fault may keep it for later pairs
  light_(index, pair.images);
  pair.shown.image = pair.images.left.clone();
  pair.shown.noise_grey_levels = plan_.NoiseGreyLevels();
  noise_(index, pair.images);
  return pair;
}

}  // namespace arfm_vo
