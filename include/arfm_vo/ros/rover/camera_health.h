#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <sensor_msgs/CameraInfo.h>

#include "arfm_vo/base/check.h"
#include "arfm_vo/hardware/stereo_camera_device.h"

namespace arfm_vo {

struct CameraHealthOptions {
  double min_rate_share = 0.8;      ///< of video.rate_hz; fewer pairs a second are a warning
  double max_unpaired_share = 0.1;  ///< of an eye's frames since the last report; more: warning

  void Check() const {
    Require(min_rate_share >= 0 && min_rate_share <= 1, "health.min_rate_share must be in 0..1");
    Require(max_unpaired_share >= 0 && max_unpaired_share <= 1,
            "health.max_unpaired_share must be in 0..1");
  }
  template <class Visitor>
  void VisitFields(Visitor&& visit) {
    visit("min_rate_share", min_rate_share);
    visit("max_unpaired_share", max_unpaired_share);
  }
};

/// The camera in stereo_camera_node's diagnostics: ERROR while no pairs come, WARN where they come
/// seldom, many frames stay alone, or a device does not do as asked.
/// `before` is the status at the last report.
void ReportCamera(const StereoCameraStatus& status, const StereoCameraStatus& before,
                  const StereoCameraOptions& camera, const CameraHealthOptions& options,
                  diagnostic_updater::DiagnosticStatusWrapper& diagnostics);

/// The calibration of both eyes: WARN where there is none, ERROR where it has another size than the
/// pictures or a baseline that is none.
void ReportCalibration(const sensor_msgs::CameraInfo& left, const sensor_msgs::CameraInfo& right,
                       int width, int height,
                       diagnostic_updater::DiagnosticStatusWrapper& diagnostics);

}  // namespace arfm_vo
