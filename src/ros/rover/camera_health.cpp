#include <algorithm>
#include <string>

#include "arfm_vo/base/format.h"
#include "arfm_vo/ros/rover/stereo_camera_node.h"

namespace arfm_vo {
namespace {

/// A stereo camera's baseline is shorter, m.
constexpr double kMaxBaseline_m = 10;

bool IsCalibrated(const sensor_msgs::CameraInfo& info) { return info.K[0] > 0; }

double UnpairedShare(const StereoCameraStatus& status, const StereoCameraStatus& before) {
  const int num_pairs = status.num_pairs - before.num_pairs;
  const int num_unpaired = std::max(status.num_unpaired_left - before.num_unpaired_left,
                                    status.num_unpaired_right - before.num_unpaired_right);
  return num_unpaired == 0 ? 0 : static_cast<double>(num_unpaired) / (num_unpaired + num_pairs);
}

/// Why an open camera gave no pair since the last report; empty where that is not known.
std::string WhyNoPairs(const StereoCameraStatus& status, const StereoCameraStatus& before,
                       const StereoCameraOptions& camera) {
  const bool has_left = status.num_unpaired_left > before.num_unpaired_left;
  const bool has_right = status.num_unpaired_right > before.num_unpaired_right;
  if (status.num_ambiguous > before.num_ambiguous)
    return Format(
        "frames of one eye come within %.1f ms, as two for one partner (max_skew_s is %.1f ms): "
        "its rate is higher than asked, or its stamps are wrong",
        2e3 * camera.max_skew_s, 1e3 * camera.max_skew_s);
  if (has_left && has_right)
    return Format("the eyes' frames are %.1f ms apart (max_skew_s is %.1f ms)",
                  1e3 * status.rejected_skew_s, 1e3 * camera.max_skew_s);
  return "";
}

void Summarize(const StereoCameraStatus& status, const StereoCameraStatus& before,
               const StereoCameraOptions& camera, const CameraHealthOptions& options,
               Diagnostics& diagnostics) {
  const double share = UnpairedShare(status, before);
  const bool has_pairs = status.num_pairs > before.num_pairs;
  const std::string why_none = has_pairs ? "" : WhyNoPairs(status, before, camera);
  if (!status.is_open)
    diagnostics.summary(Diagnostics::ERROR, status.problem);
  else if (!why_none.empty())
    diagnostics.summary(Diagnostics::ERROR, "no pairs: " + why_none);
  else if (!status.problem.empty())
    diagnostics.summary(Diagnostics::ERROR, status.problem);
  else if (!has_pairs && share > 0)
    diagnostics.summary(Diagnostics::ERROR, "no pairs: frames come from one eye alone");
  else if (!has_pairs)
    diagnostics.summary(Diagnostics::WARN, "no pairs since the last report");
  else if (share > options.max_unpaired_share)
    diagnostics.summaryf(Diagnostics::WARN, "%.0f %% of an eye's frames have no partner",
                         100 * share);
  else if (status.rate_hz < options.min_rate_share * camera.video.rate_hz)
    diagnostics.summaryf(Diagnostics::WARN, "%.1f pairs a second, asked are %.1f", status.rate_hz,
                         camera.video.rate_hz);
  else if (!status.warning.empty())
    diagnostics.summary(Diagnostics::WARN, status.warning);
  else
    diagnostics.summary(Diagnostics::OK, "pairs come");
}

}  // namespace

void ReportCamera(const StereoCameraStatus& status, const StereoCameraStatus& before,
                  const StereoCameraOptions& camera, const CameraHealthOptions& options,
                  Diagnostics& diagnostics) {
  Summarize(status, before, camera, options, diagnostics);
  diagnostics.addf("pairs a second", "%.2f", status.rate_hz);
  diagnostics.add("pairs", status.num_pairs);
  diagnostics.addf("skew, right - left, last pair (ms)", "%.3f", 1e3 * status.skew_s);
  diagnostics.addf("skew, largest (ms)", "%.3f", 1e3 * status.max_skew_s);
  diagnostics.add("frames without partner, left", status.num_unpaired_left);
  diagnostics.add("frames without partner, right", status.num_unpaired_right);
  diagnostics.add("frames too close to be told apart", status.num_ambiguous);
  diagnostics.add("frames dropped by the driver", status.num_dropped);
  diagnostics.add("frames corrupted", status.num_corrupted);
  diagnostics.add("frames without a usable stamp", status.num_stamped_late);
  diagnostics.add("failures", status.num_failures);
  diagnostics.add("times opened", status.num_opened);
  if (status.exposure) diagnostics.addf("exposure (ms)", "%.2f", 1e3 * status.exposure->time_s);
  if (status.exposure && status.exposure->gain) diagnostics.add("gain", *status.exposure->gain);
  if (!status.warning.empty()) diagnostics.add("not as asked", status.warning);
}

void ReportCalibration(const sensor_msgs::CameraInfo& left, const sensor_msgs::CameraInfo& right,
                       int width, int height, Diagnostics& diagnostics) {
  if (!IsCalibrated(left) || !IsCalibrated(right)) {
    const bool is_one = IsCalibrated(left) || IsCalibrated(right);
    return diagnostics.summary(
        Diagnostics::WARN,
        is_one ? std::string(IsCalibrated(left) ? "right" : "left") + " eye is not calibrated"
               : "not calibrated (calibrate_stereo, set_camera_info or left_camera_info_url)");
  }
  for (const auto& [eye, info] : {std::pair("left", &left), {"right", &right}})
    if (!HasSize(*info, width, height))
      return diagnostics.summaryf(Diagnostics::ERROR,
                                  "%s calibration is for %ux%u, pictures are %dx%d: not used", eye,
                                  info->width, info->height, width, height);
  const double baseline_m = -right.P[3] / right.P[0];
  diagnostics.addf("baseline (m)", "%.4f", baseline_m);
  if (!(baseline_m > 0 && baseline_m < kMaxBaseline_m))
    return diagnostics.summaryf(Diagnostics::ERROR,
                                "baseline is %.4g m: P[3] of the right eye must be -fx * baseline "
                                "in m; are the eyes swapped?",
                                baseline_m);
  diagnostics.summary(Diagnostics::OK, "calibrated");
}

}  // namespace arfm_vo
