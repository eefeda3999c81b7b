#include "recordings/picture_plan.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "arfm_vo/simulation/hash_noise.h"

namespace arfm_vo {
namespace {

constexpr auto kLeft = &StereoImages::left, kRight = &StereoImages::right;

/// `change` from pair `begin` to before `end`; it counts from 0.
PairChange During(int begin, int end, const PairChange& change) {
  return [=](int index, StereoImages& images) {
    if (index >= begin && index < end) change(index - begin, images);
  };
}

/// The right camera turns by plan.turn within plan.ramp_pairs, and stays so.
PairChange TurnRightCamera(const FaultPlan& plan, const StereoCamera& camera) {
  return [=](int age, StereoImages& images) {
    const double part = std::min(1.0, (age + 1.0) / plan.ramp_pairs);
    const cv::Vec3d turn(plan.turn.x(), plan.turn.y(), plan.turn.z());
    const cv::Matx33d projection(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
    TurnView(images.right, projection, part * turn, cv::INTER_CUBIC);
  };
}

/// A near, textured thing that is fixed to the camera: over `share` of the picture, from below or
/// from a side, with a disparity of a tenth of the width.
PairChange Cover(const FaultPlan& plan) {
  const int edge = plan.seed % 3;  // 0 below, 1 left, 2 right
  const auto paint = [=](cv::Mat& image, double disparity_px) {
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        const double x = (u + disparity_px) / image.cols, y = 1. * v / image.rows;
        const double inward = edge == 0 ? 1 - y : edge == 1 ? x : 1 - x;
        if (inward > plan.share) continue;
        const double grey = 110 + 150 * FractalNoise(60 * x + 7, 60 * y + 7, 2, 0.6, plan.seed);
        image.at<uchar>(v, u) = cv::saturate_cast<uchar>(grey);
      }
    }
  };
  return [=](int, StereoImages& images) {
    paint(images.left, 0);
    paint(images.right, 0.1 * images.right.cols);
  };
}

/// A projector's bright dots, always at the same places of both pictures, with the disparity that
/// a floor before the camera would give them: 1 % of the width at the top, 7 % at the bottom.
PairChange ProjectDots(const FaultPlan& plan) {
  const auto brighten = [](cv::Mat& image, double u, double v, double light) {
    constexpr int kReach = 3;
    for (int y = static_cast<int>(v) - kReach; y <= v + kReach; ++y) {
      for (int x = static_cast<int>(u) - kReach; x <= u + kReach; ++x) {
        if (x < 0 || y < 0 || x >= image.cols || y >= image.rows) continue;
        const double square = (x - u) * (x - u) + (y - v) * (y - v);
        const double added = light * std::exp(-square / 2);
        uchar& grey = image.at<uchar>(y, x);
        if (added >= 1) grey = cv::saturate_cast<uchar>(grey + added);
      }
    }
  };
  return [=](int, StereoImages& images) {
    Draw draw(static_cast<uint32_t>(plan.seed));
    for (int i = 0; i < plan.num_dots; ++i) {
      const double u = draw.Between(0, images.left.cols), v = draw.Between(0, images.left.rows);
      const double disparity = images.left.cols * (0.01 + 0.06 * v / images.left.rows);
      const double light = draw.Between(60, 140);
      brighten(images.left, u, v, light);
      brighten(images.right, u - disparity, v, light);
    }
  };
}

PairChange Appear(const ObjectOptions& object) {
  return
      [change = Show(object)](int age, StereoImages& images) { change(kObjectFrom + age, images); };
}

ObjectOptions DrawObject(Draw& draw) {
  ObjectOptions object;
  object.share = draw.Between(0.1, 0.5);
  const int kind = draw.Integer(0, 3);
  if (kind == 0) object.step = {draw.Sign() * draw.Between(1, 6), 0};
  if (kind == 1) object.growth = draw.Sign() * draw.Between(0.004, 0.012);
  if (kind == 2) object.step = {0, -draw.Between(0.5, 3)};
  if (kind == 3) object.swing_px = draw.Between(8, 40);
  return object;
}

Eigen::Vector3d DrawTurn(const std::string& kind, Draw& draw) {
  const double size = 1e-3 * draw.Sign() * draw.Between(0.3, 1);
  if (kind.rfind("pitch", 0) == 0) return {size, 0, 0};
  if (kind.rfind("yaw", 0) == 0) return {0, size, 0};
  if (kind.rfind("roll", 0) == 0) return {0, 0, size};
  const Eigen::Vector3d axis(draw.Gaussian(), draw.Gaussian(), draw.Gaussian());
  return 1e-3 * draw.Between(2, 5) * axis.normalized();  // a knock
}

}  // namespace

LightPlan DrawLightPlan(Draw& draw) {
  LightPlan plan;
  const double gain = draw.LogBetween(0.35, 1.6), gamma = draw.LogBetween(0.6, 1.6);
  const double last = draw.LogBetween(0.4, 2), noise = draw.Between(1, 8);
  if (draw.Chance(0.25)) plan.gain = gain;
  if (draw.Chance(0.2)) plan.gamma = gamma;
  if (draw.Chance(0.2)) plan.last_gain = last;
  if (draw.Chance(0.25)) plan.noise_grey_levels = noise;
  return plan;
}

PairChange ChangeLight(const LightPlan& plan, int num_pairs) {
  return [=](int index, StereoImages& images) {
    if (!plan.IsChanged()) return;
    const double part = static_cast<double>(index) / std::max(1, num_pairs - 1);
    const double gain = plan.gain * std::pow(plan.last_gain, part);
    cv::Mat table(1, 256, CV_8U);
    for (int grey = 0; grey < 256; ++grey) {
      const double light = gain * std::pow(grey / 255.0, plan.gamma);
      table.at<uchar>(grey) = cv::saturate_cast<uchar>(255 * light);
    }
    cv::LUT(images.left, table, images.left);
    cv::LUT(images.right, table, images.right);
  };
}

const std::vector<std::string>& FaultKinds() {
  static const std::vector<std::string> kinds{
      "none",         "yaw_step",  "pitch_step", "roll_step",  "yaw_ramp",
      "pitch_ramp",   "roll_ramp", "knock",      "right_late", "right_black",
      "right_frozen", "object",    "blur_one",   "cover",      "dots"};
  return kinds;
}

FaultPlan DrawFaultPlan(const std::string& kind, int num_pairs, Draw& draw) {
  FaultPlan plan;
  plan.kind = kind;
  if (kind == "none") return plan;
  plan.begin = draw.Integer(num_pairs / 4, num_pairs / 2);
  plan.turn = DrawTurn(kind, draw);
  plan.object = DrawObject(draw);
  plan.blur_px = draw.OneOf<int>({3, 5, 7, 9, 13});
  plan.is_left = draw.Chance(0.5);
  plan.share = draw.Between(0.2, 0.3);
  plan.num_dots = draw.Integer(150, 500);
  plan.seed = draw.Integer(1, 1 << 20);
  const int lasts = draw.Integer(2, 15);
  const bool ends =
      kind == "right_black" || kind == "right_frozen" || (kind == "right_late" && draw.Chance(0.5));
  if (ends) plan.end = plan.begin + lasts;
  if (kind == "cover" || kind == "dots") plan.begin = 0;
  if (kind.find("ramp") != std::string::npos) plan.ramp_pairs = std::max(5, num_pairs / 3);
  return plan;
}

PairChange MakeFault(const FaultPlan& plan, const StereoCamera& camera) {
  PairChange change = [](int, StereoImages&) {};
  if (plan.kind == "right_late") change = DelayRight(1);
  if (plan.kind == "right_black") change = Blacken(kRight, {});
  if (plan.kind == "right_frozen") change = Freeze(kRight, {});
  if (plan.kind == "object") change = Appear(plan.object);
  if (plan.kind == "blur_one") change = OnSide(plan.is_left ? kLeft : kRight, Blur(plan.blur_px));
  if (plan.kind == "cover") change = Cover(plan);
  if (plan.kind == "dots") change = ProjectDots(plan);
  const bool turns = plan.kind == "knock" || plan.kind.find("_step") != std::string::npos ||
                     plan.kind.find("_ramp") != std::string::npos;
  if (turns) change = TurnRightCamera(plan, camera);
  return During(plan.begin, plan.end, change);
}

}  // namespace arfm_vo
