#include "features/plain_surf.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "arfm_vo/features/surf.h"
#include "base/shared_data.h"

namespace arfm_vo {
namespace {

/// Blobs, edges and noise at many scales, seeded.
cv::Mat MakeScene(int width, int height) {
  cv::Mat scene(height, width, CV_32F, cv::Scalar(128));
  cv::RNG random(7);
  for (int size = 4; size < width; size *= 2) {
    cv::Mat noise(height / size + 2, width / size + 2, CV_32F);
    random.fill(noise, cv::RNG::NORMAL, 0, 20);
    cv::Mat grown;
    cv::resize(noise, grown, scene.size(), 0, 0, cv::INTER_CUBIC);
    scene += grown;
  }
  cv::Mat grey;
  scene.convertTo(grey, CV_8U);
  return grey;
}

Features ExtractWith(const cv::Mat& grey, int threads) {
  SurfOptions options;
  options.threads = threads;
  return Surf(options).Extract(grey);
}

void ExpectSame(const Features& plain, const Features& found) {
  ASSERT_EQ(plain.size(), found.size());
  for (int i = 0; i < plain.size(); ++i) {
    const Keypoint &a = plain.keypoints[i], &b = found.keypoints[i];
    ASSERT_EQ(a.x, b.x) << i;
    ASSERT_EQ(a.y, b.y) << i;
    ASSERT_EQ(a.scale, b.scale) << i;
    ASSERT_EQ(a.response, b.response) << i;
    ASSERT_EQ(a.laplacian_sign, b.laplacian_sign) << i;
    ASSERT_NEAR(a.angle, b.angle, 1e-5) << i;
  }
  if (plain.size() > 0) {
    EXPECT_LT(cv::norm(plain.descriptors, found.descriptors, cv::NORM_INF), 1e-4);
  }
}

void ExpectAgreement(const SurfOptions& options, const cv::Mat& grey) {
  ExpectSame(ExtractPlainly(options, grey), Surf(options).Extract(grey));
}

void ExpectAgreement(const cv::Mat& grey) {
  for (const bool upright : {false, true}) {
    SurfOptions options;
    options.descriptor.upright = upright;
    ExpectAgreement(options, grey);
  }
  for (const int initial_step : {2, 3, 4}) {
    SCOPED_TRACE(initial_step);
    SurfOptions options;
    options.detector.initial_step = initial_step;
    ExpectAgreement(options, grey);
  }
  SurfOptions bay;  // as published
  bay.smooth = bay.detector.merge_octaves = bay.descriptor.overlapping_regions = false;
  ExpectAgreement(bay, grey);
}

TEST(PlainSurf, AgreesOnAScene) {
  const cv::Mat scene = MakeScene(421, 283);
  EXPECT_GT(ExtractWith(scene, 1).size(), 200);
  ExpectAgreement(scene);
}

TEST(PlainSurf, AgreesOnOddAndTinyImages) {
  const cv::Mat scene = MakeScene(131, 97);
  for (const cv::Size size : {cv::Size(131, 97), cv::Size(60, 97), cv::Size(35, 33),
                              cv::Size(17, 40), cv::Size(9, 9), cv::Size(1, 1)}) {
    SCOPED_TRACE(size);
    ExpectAgreement(scene(cv::Rect(cv::Point(), size)).clone());
  }
}

TEST(PlainSurf, DoesNotDependOnThreads) {
  const cv::Mat scene = MakeScene(421, 283);
  ExpectSame(ExtractWith(scene, 1), ExtractWith(scene, 2));
}

TEST(PlainSurf, KeepsNothingFromTheImageBefore) {
  Surf surf{SurfOptions{}};
  surf.Extract(MakeScene(421, 283));
  const cv::Mat smaller = MakeScene(200, 150);
  ExpectSame(Surf(SurfOptions{}).Extract(smaller), surf.Extract(smaller));
}

TEST(PlainSurf, AgreesOnRealImages) {
  for (const char* name :
       {"kitti/odometry_06_000-050/image_0/000000.png", "matching/oxford_graf/img1.png",
        "matching/oxford_boat/img4.png", "matching/oxford_leuven/img6.png"}) {
    SCOPED_TRACE(name);
    const std::string path = FindShared(std::string("data/") + name);
    if (path.empty()) GTEST_SKIP() << "the real image " << name << " is not there";
    const cv::Mat grey = cv::imread(path, cv::IMREAD_GRAYSCALE);
    ASSERT_FALSE(grey.empty());
    ExpectAgreement(grey);
  }
}

}  // namespace
}  // namespace arfm_vo
