#include "arfm_vo/matching/epipolar_ransac.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "arfm_vo/base/ransac.h"

namespace arfm_vo {
namespace {

constexpr int kSampleSize = 7;
/// Sampson distance of an inlier.
constexpr double kMaxErrorPx = 1.5;
/// Fewer are no consensus: any seven matches agree.
constexpr int kMinInliers = 15;

bool IsFinite(const cv::Matx33d& matrix) {
  return std::all_of(matrix.val, matrix.val + 9, [](double value) { return std::isfinite(value); });
}

/// One problem: the keypoints of the matches, side by side.
class EpipolarProblem {
 public:
  EpipolarProblem(const std::vector<Keypoint>& first, const std::vector<Keypoint>& second,
                  const Matches& matches) {
    for (const Match& match : matches) {
      first_.push_back(first[match.first]);
      second_.push_back(second[match.second]);
    }
  }

  int size() const { return static_cast<int>(first_.size()); }

  /// The up to three solutions of the 7-point algorithm.
  std::vector<cv::Matx33d> Estimate(const std::vector<int>& sample) const {
    std::vector<cv::Point2d> first, second;
    for (const int i : sample) {
      first.emplace_back(first_[i].x, first_[i].y);
      second.emplace_back(second_[i].x, second_[i].y);
    }
    const cv::Mat solutions = cv::findFundamentalMat(first, second, cv::FM_7POINT);
    std::vector<cv::Matx33d> finite;
    for (int row = 0; row + 3 <= solutions.rows; row += 3) {
      const cv::Matx33d solution(solutions.ptr<double>(row));
      if (IsFinite(solution)) finite.push_back(solution);
    }
    return finite;
  }

  double Classify(const cv::Matx33d& fundamental, std::vector<char>& is_inlier) const {
    double score = 0;
    for (size_t i = 0; i < first_.size(); ++i) {
      const double error = SampsonDistance(fundamental, first_[i], second_[i]) / kMaxErrorPx;
      is_inlier[i] = error <= 1;
      if (error < 1) score += 1 - error * error;
    }
    return score;
  }

 private:
  std::vector<Keypoint> first_, second_;
};

}  // namespace

double SampsonDistance(const cv::Matx33d& fundamental, const Keypoint& first,
                       const Keypoint& second) {
  const cv::Vec3d x(first.x, first.y, 1), y(second.x, second.y, 1);
  const cv::Vec3d line_in_second = fundamental * x, line_in_first = fundamental.t() * y;
  const double squared_gradient =
      line_in_second[0] * line_in_second[0] + line_in_second[1] * line_in_second[1] +
      line_in_first[0] * line_in_first[0] + line_in_first[1] * line_in_first[1];
  if (!(squared_gradient > 0)) return std::numeric_limits<double>::infinity();
  return std::abs(y.dot(line_in_second)) / std::sqrt(squared_gradient);
}

std::optional<EpipolarGeometry> FindEpipolarGeometry(const std::vector<Keypoint>& first,
                                                     const std::vector<Keypoint>& second,
                                                     const Matches& matches) {
  const EpipolarProblem problem(first, second, matches);
  const auto report = Ransac<cv::Matx33d>(
      problem.size(), kSampleSize, RansacOptions(),
      [&](const std::vector<int>& sample) { return problem.Estimate(sample); },
      [&](const cv::Matx33d& model, std::vector<char>& is_inlier) {
        return problem.Classify(model, is_inlier);
      });
  if (!report || report->num_inliers < kMinInliers) return std::nullopt;
  return EpipolarGeometry{report->model, report->is_inlier, report->num_inliers};
}

}  // namespace arfm_vo
