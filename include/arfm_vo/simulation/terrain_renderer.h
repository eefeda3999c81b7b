#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/image/stereo_images.h"
#include "arfm_vo/simulation/sensor.h"
#include "arfm_vo/simulation/terrain.h"

namespace arfm_vo {

struct RenderOptions {
  int num_threads = 1;     ///< that render a picture
  int edge_samples = 3;    ///< along each side of a pixel on an edge; 1: no smooth edges
  double skylight = 0.22;  ///< share of the light that comes from the whole sky
  SensorOptions sensor;

  void Check() const;
  ARFM_FIELDS(num_threads, edge_samples, skylight, (sensor))
};

/// What an ideal camera sees.
struct RenderedView {
  cv::Mat radiance;  ///< CV_32FC1, 1 is white
  cv::Mat depth;     ///< CV_32FC1, exact z in the camera frame (m) at the pixels' centres; infinity
                     ///< in the sky
};

/// Takes pictures of a terrain by ray casting with exact pinhole geometry (the pixel convention of
/// StereoCamera), texture filtered over each pixel's footprint, edges by supersampling. The same
/// input gives the same bytes on any number of threads.
class TerrainRenderer {
 public:
  /// `terrain` must outlive the renderer.
  TerrainRenderer(const Terrain& terrain, const RenderOptions& options);

  /// The view of the left camera of `camera` (its baseline plays no part). `bodies` are moving
  /// things: they are seen and cast shadows.
  RenderedView Trace(const StereoCamera& camera, const Rigid3& world_from_camera,
                     const std::vector<Solid>& bodies = {}) const;
  /// The same as an 8 bit picture; `image_id` selects the noise.
  cv::Mat Render(const StereoCamera& camera, const Rigid3& world_from_camera, uint32_t image_id,
                 const std::vector<Solid>& bodies = {}) const;
  /// Both cameras; the noise is that of images 2 * pair_id and 2 * pair_id + 1.
  StereoImages RenderPair(const StereoCamera& camera, const Rigid3& world_from_left,
                          uint32_t pair_id, double stamp_s,
                          const std::vector<Solid>& bodies = {}) const;

 private:
  const Terrain* terrain_;
  RenderOptions options_;
};

/// The pose of the right camera of a stereo camera whose left camera is at `world_from_left`.
Rigid3 RightCameraPose(const StereoCamera& camera, const Rigid3& world_from_left);

}  // namespace arfm_vo
