#include <algorithm>
#include <cmath>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "arfm_vo/simulation/hash_noise.h"
#include "image/image_noise.h"
#include "synthetic/pair_changes.h"

namespace arfm_vo {

PairChange OnEachImage(const ImageChange& change) {
  return Both(OnSide(&StereoImages::left, change), OnSide(&StereoImages::right, change));
}

PairChange OnSide(cv::Mat StereoImages::*side, const ImageChange& change) {
  return [=](int, StereoImages& images) { change(images.*side); };
}

PairChange Both(const PairChange& a, const PairChange& b) {
  return [=](int index, StereoImages& images) {
    a(index, images);
    b(index, images);
  };
}

ImageChange Blur(int size_px) {
  return [=](cv::Mat& image) { cv::GaussianBlur(image, image, cv::Size(size_px, size_px), 0); };
}

ImageChange SmearSideways(int size_px) {
  return [=](cv::Mat& image) { cv::blur(image, image, cv::Size(size_px, 1)); };
}

ImageChange CompressAsJpeg(int quality) {
  return [=](cv::Mat& image) {
    std::vector<uchar> bytes;
    cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
    image = cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
  };
}

ImageChange AddNoiseOf(double grey_levels) {
  auto random = std::make_shared<cv::RNG>(1);
  return [=](cv::Mat& image) { AddNoise(image, grey_levels, *random); };
}

ImageChange Multiply(double factor) {
  return [=](cv::Mat& image) { image.convertTo(image, CV_8U, factor); };
}

ImageChange Flatten(double factor) {
  return [=](cv::Mat& image) {
    image.convertTo(image, CV_8U, factor, (1 - factor) * cv::mean(image)[0]);
  };
}

ImageChange KillRows(double share) {
  return [=](cv::Mat& image) {
    for (int y = 0; y < image.rows; ++y) {
      if (HashUnit(y) < share) image.row(y).setTo(0);
    }
  };
}

ImageChange KillColumns(double share) {
  return [=](cv::Mat& image) {
    for (int x = 0; x < image.cols; ++x) {
      if (HashUnit(x) < share) image.col(x).setTo(255);
    }
  };
}

ImageChange Dirty(double share, int seed) {
  return [=](cv::Mat& image) {
    // Smooth noise above the level that leaves `share` of the picture.
    cv::Mat noise(image.size(), CV_32F), smeared, dirt;
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x)
        noise.at<float>(y, x) = static_cast<float>(GradientNoise(x / 60., y / 60., seed));
    }
    std::vector<float> levels(noise.begin<float>(), noise.end<float>());
    const auto level = levels.begin() + static_cast<int>((1 - share) * levels.size());
    std::nth_element(levels.begin(), level, levels.end());
    cv::GaussianBlur(image, smeared, cv::Size(31, 31), 0);
    smeared.convertTo(smeared, CV_8U, 0.5, 60);
    cv::compare(noise, *level, dirt, cv::CMP_GT);
    smeared.copyTo(image, dirt);
  };
}

ImageChange DrawGlare(double radius) {
  return [=](cv::Mat& image) {
    const cv::Point2d centre(0.55 * image.cols, 0.35 * image.rows);
    const double spread = radius * image.rows;
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x) {
        const double distance = std::hypot(x - centre.x, y - centre.y) / spread;
        auto& grey = image.at<uchar>(y, x);
        grey = cv::saturate_cast<uchar>(grey + 400 * std::exp(-distance * distance));
      }
    }
  };
}

ImageChange DrawRain(int num_streaks) {
  auto random = std::make_shared<cv::RNG>(1);
  return [=](cv::Mat& image) {
    for (int i = 0; i < num_streaks; ++i) {
      const cv::Point top(random->uniform(0, image.cols), random->uniform(0, image.rows));
      const cv::Point bottom = top + cv::Point(random->uniform(-3, 3), random->uniform(8, 25));
      cv::line(image, top, bottom, cv::Scalar::all(random->uniform(150, 220)), 1, cv::LINE_AA);
    }
  };
}

}  // namespace arfm_vo
