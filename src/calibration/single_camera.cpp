#include "arfm_vo/calibration/single_camera.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Columns of cv::projectPoints' Jacobian.
constexpr int kPoseColumns = 6, kIntrinsicsColumns = 4;

/// One view's part of the problem: residuals, and Jacobians by pose and by (skew, f, c,
/// distortion).
struct ViewProblem {
  Eigen::VectorXd residual;
  Jacobian by_pose, by_camera;
};

ViewProblem Linearize(const SingleCamera& camera, const BoardPose& pose,
                      const BoardCorners& corners, const std::vector<cv::Point3f>& board_corners) {
  std::vector<cv::Point2f> projected;
  cv::Mat jacobian;
  cv::projectPoints(board_corners, pose.rotation, pose.translation_m, camera.matrix,
                    camera.distortion, projected, jacobian);
  const Eigen::Map<const Jacobian> all(jacobian.ptr<double>(), jacobian.rows, jacobian.cols);
  const int num_camera = kIntrinsicsColumns + static_cast<int>(camera.distortion.total());
  const int num = static_cast<int>(corners.size());
  ViewProblem problem{Eigen::VectorXd(2 * num), all.leftCols(kPoseColumns),
                      Jacobian::Zero(2 * num, 1 + num_camera)};
  problem.by_camera.rightCols(num_camera) = all.middleCols(kPoseColumns, num_camera);
  for (int i = 0; i < num; ++i) {
    problem.residual[2 * i] = corners[i].x - projected[i].x;
    problem.residual[2 * i + 1] = corners[i].y - projected[i].y;
    problem.by_camera(2 * i, 0) = (projected[i].y - camera.matrix(1, 2)) / camera.matrix(1, 1);
  }
  return problem;
}

}  // namespace

const char* ToString(DistortionModel model) {
  return model == DistortionModel::kPlumbBob ? "plumb_bob" : "rational_polynomial";
}

DistortionModel ParseDistortionModel(const std::string& text) {
  for (const auto model : {DistortionModel::kPlumbBob, DistortionModel::kRationalPolynomial})
    if (text == ToString(model)) return model;
  throw std::invalid_argument("distortion model must be plumb_bob or rational_polynomial, is '" +
                              text + "'");
}

SingleCalibration CalibrateCamera(const std::vector<BoardCorners>& views, const Chessboard& board,
                                  cv::Size image_size, DistortionModel model) {
  Require(views.size() >= 3, "camera: Zhang's calibration needs at least 3 views");
  const std::vector<std::vector<cv::Point3f>> board_corners(views.size(), board.Corners());
  const bool is_rational = model == DistortionModel::kRationalPolynomial;
  SingleCalibration calibration;
  std::vector<cv::Mat> rotations, translations;
  cv::Mat sigma_intrinsics, sigma_poses, view_rms, distortion;
  calibration.rms_px =
      cv::calibrateCamera(board_corners, views, image_size, calibration.camera.matrix, distortion,
                          rotations, translations, sigma_intrinsics, sigma_poses, view_rms,
                          is_rational ? cv::CALIB_RATIONAL_MODEL : 0,
                          {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-9});
  calibration.camera.distortion = distortion.reshape(1, 1).colRange(0, is_rational ? 8 : 5).clone();
  for (size_t i = 0; i < views.size(); ++i) {
    calibration.poses.push_back({rotations[i], translations[i]});
    calibration.view_rms_px.push_back(view_rms.at<double>(static_cast<int>(i)));
  }
  return calibration;
}

IntrinsicsPrecision EvaluatePrecision(const SingleCalibration& calibration,
                                      const std::vector<BoardCorners>& views,
                                      const Chessboard& board) {
  const std::vector<cv::Point3f> board_corners = board.Corners();
  const int size = 1 + kIntrinsicsColumns + static_cast<int>(calibration.camera.distortion.total());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(size);
  double sum = 0, num_residuals = 0;
  for (size_t i = 0; i < views.size(); ++i) {
    const ViewProblem view =
        Linearize(calibration.camera, calibration.poses[i], views[i], board_corners);
    // Eliminate the view's pose (Schur complement).
    const Eigen::MatrixXd mixed = view.by_pose.transpose() * view.by_camera;
    const Eigen::LDLT<Eigen::MatrixXd> pose_information(view.by_pose.transpose() * view.by_pose);
    information += view.by_camera.transpose() * view.by_camera -
                   mixed.transpose() * pose_information.solve(mixed);
    gradient += view.by_camera.transpose() * view.residual -
                mixed.transpose() * pose_information.solve(
                                        Eigen::VectorXd(view.by_pose.transpose() * view.residual));
    sum += view.residual.squaredNorm();
    num_residuals += view.residual.size();
  }
  // Scaled to a unit diagonal: focal lengths and distortion differ by many orders of magnitude.
  const Eigen::VectorXd scale = information.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<Eigen::MatrixXd> solver(scale.asDiagonal() * information * scale.asDiagonal());
  const double freedom = num_residuals - kPoseColumns * double(views.size()) - size;
  const double variance = sum / std::max(freedom, 1.0);
  const Eigen::MatrixXd inverse = solver.solve(Eigen::MatrixXd::Identity(size, size));
  const Eigen::VectorXd step = scale.asDiagonal() * (inverse * (scale.asDiagonal() * gradient));
  const auto sigma = [&](int i) {
    const double value = inverse(i, i) * scale[i] * scale[i] * variance;
    return value >= 0 ? std::sqrt(value) : std::numeric_limits<double>::infinity();
  };
  return {step[0], sigma(0), sigma(1), sigma(2), sigma(3), sigma(4)};
}

double LargestTilt(const std::vector<BoardPose>& poses) {
  std::vector<cv::Vec3d> normals;
  for (const BoardPose& pose : poses) {
    cv::Matx33d rotation;
    cv::Rodrigues(pose.rotation, rotation);
    normals.push_back(rotation * cv::Vec3d(0, 0, 1));
  }
  double smallest_cosine = 1;
  for (const cv::Vec3d& a : normals)
    for (const cv::Vec3d& b : normals) smallest_cosine = std::min(smallest_cosine, a.dot(b));
  return std::acos(std::clamp(smallest_cosine, -1.0, 1.0));
}

}  // namespace arfm_vo
