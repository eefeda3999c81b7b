#include <arfm_vo/OdometryStatus.h>

#include <iostream>

#include "arfm_vo/geometry/stereo_camera.h"

int main() {
  const arfm_vo::StereoCamera camera{700, 700, 320, 240, 1, 640, 480};
  camera.Check();
  const bool is_tracked = arfm_vo::OdometryStatus().state == arfm_vo::OdometryStatus::TRACKED;
  std::cout << camera.baseline_m << (is_tracked ? " m\n" : " m, lost\n");
}
