#include "arfm_vo/calibration/pair_consistency.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "arfm_vo/base/median.h"

namespace arfm_vo {
namespace {

/// c_from_a of two poses, c_from_b first.
BoardPose Compose(const BoardPose& c_from_b, const BoardPose& b_from_a) {
  BoardPose c_from_a;
  cv::composeRT(b_from_a.rotation, b_from_a.translation_m, c_from_b.rotation,
                c_from_b.translation_m, c_from_a.rotation, c_from_a.translation_m);
  return c_from_a;
}

BoardPose Invert(const BoardPose& b_from_a) {
  cv::Matx33d rotation;
  cv::Rodrigues(b_from_a.rotation, rotation);
  return {-b_from_a.rotation, -(rotation.t() * b_from_a.translation_m)};
}

double ProjectionRms(const SingleCamera& camera, const BoardPose& pose, const BoardCorners& corners,
                     const std::vector<cv::Point3f>& board_corners) {
  std::vector<cv::Point2f> projected;
  cv::projectPoints(board_corners, pose.rotation, pose.translation_m, camera.matrix,
                    camera.distortion, projected);
  const double rms = cv::norm(projected, corners, cv::NORM_L2) / std::sqrt(double(corners.size()));
  return std::isfinite(rms) ? rms : std::numeric_limits<double>::max();
}

}  // namespace

std::vector<double> MeasureConsistency(const SingleCalibration& left,
                                       const SingleCalibration& right,
                                       const std::vector<CornerPair>& pairs,
                                       const Chessboard& board) {
  const std::vector<cv::Point3f> board_corners = board.Corners();
  std::vector<double> best;
  double best_median = std::numeric_limits<double>::infinity();
  for (size_t candidate = 0; candidate < pairs.size(); ++candidate) {
    const BoardPose right_from_left =
        Compose(right.poses[candidate], Invert(left.poses[candidate]));
    std::vector<double> errors;
    for (size_t i = 0; i < pairs.size(); ++i)
      errors.push_back(ProjectionRms(right.camera, Compose(right_from_left, left.poses[i]),
                                     pairs[i].right, board_corners));
    const double median = Median(errors);
    if (median < best_median) {
      best_median = median;
      best = errors;
    }
  }
  return best;
}

std::vector<char> FindOutliers(const std::vector<double>& errors, double factor, double floor) {
  std::vector<char> is_outlier(errors.size(), 0);
  if (errors.empty()) return is_outlier;
  const double worst = *std::max_element(errors.begin(), errors.end());
  const double limit = std::max({factor * Median(errors), floor, worst / 2});
  for (size_t i = 0; i < errors.size(); ++i) is_outlier[i] = errors[i] > limit ? 1 : 0;
  return is_outlier;
}

}  // namespace arfm_vo
