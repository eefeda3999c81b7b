#pragma once

#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/odometry/local_odometry.h"
#include "arfm_vo/reconstruction/stereo_frame.h"
#include "synthetic/observation_simulator.h"

namespace arfm_vo {

/// What a front end would hand to the odometry for a simulated frame: a keypoint and a stereo point
/// an observation, all of one scale, with the landmark's descriptor disturbed by
/// `descriptor_noise` (ObservationSimulator::Describe).
StereoFrame MakeStereoFrame(const StereoCamera& camera, const SimulatedFrame& simulated,
                            double stamp_s, double sigma_px, double descriptor_noise,
                            ObservationSimulator& simulator);

/// `options` for frames without images: the keypoints' own positions, trusted to `sigma_px`, and
/// no check of their scale, which the simulation does not have.
LocalOdometryOptions WithoutImages(LocalOdometryOptions options, double sigma_px);

}  // namespace arfm_vo
