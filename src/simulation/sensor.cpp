#include "arfm_vo/simulation/sensor.h"

#include <opencv2/imgproc.hpp>

#include "arfm_vo/simulation/hash_noise.h"

namespace arfm_vo {

void SensorOptions::Check() const {
  Require(gain > 0, "sensor.gain must be positive");
  Require(blur_px >= 0 && blur_px < 20, "sensor.blur_px must be in [0, 20)");
  Require(noise_grey_levels >= 0, "sensor.noise_grey_levels must not be negative");
}

cv::Mat ExposeImage(const cv::Mat& radiance, const SensorOptions& options, uint32_t image_id) {
  Require(radiance.type() == CV_32FC1, "radiance image must be CV_32FC1");
  cv::Mat light = radiance;
  if (options.blur_px > 0) {
    cv::GaussianBlur(radiance, light, {0, 0}, options.blur_px, options.blur_px,
                     cv::BORDER_REPLICATE);
  }
  constexpr double kVignetting = 0.1;  // share of the light lost in the corners
  cv::Mat image(light.size(), CV_8UC1);
  const double center_x = (light.cols - 1) / 2.0, center_y = (light.rows - 1) / 2.0;
  const double corner_squared = center_x * center_x + center_y * center_y + 1e-9;
  const uint32_t image_word = HashCell(static_cast<int>(image_id), 0, options.seed);
  for (int v = 0; v < light.rows; ++v) {
    const float* in = light.ptr<float>(v);
    uint8_t* out = image.ptr<uint8_t>(v);
    const double dy = v - center_y;
    for (int u = 0; u < light.cols; ++u) {
      const double dx = u - center_x;
      const double loss = kVignetting * (dx * dx + dy * dy) / corner_squared;
      const double noise =
          options.noise_grey_levels > 0
              ? options.noise_grey_levels * HashGaussian(HashCell(u, v, image_word))
              : 0;
      out[u] = cv::saturate_cast<uint8_t>(options.gain * in[u] * (1 - loss) + noise);
    }
  }
  return image;
}

}  // namespace arfm_vo
