#include "arfm_vo/calibration/stereo_calibration.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/format.h"
#include "arfm_vo/base/median.h"
#include "arfm_vo/calibration/pair_consistency.h"

namespace arfm_vo {
namespace {

/// A pair is left out above this many times the median rms and above this rms.
constexpr double kOutlierFactor = 3, kOutlierFloor_px = 0.1;
constexpr double kMinTilt_deg = 5;       ///< between the board's planes of two views
constexpr double kMaxFocalSigma = 0.01;  ///< of fx, as a share of it
/// Consistency of a pair measured with single poses is noisier than its final error: only what
/// stands out grossly goes before both cameras are adjusted together.
constexpr double kGrossFactor = 5, kGrossFloorPx = 2;
/// Above this the cameras have no common relative pose; a good rig is at a few px.
constexpr double kNoCommonPosePx = 15;

constexpr auto kLeft = &CornerPair::left, kRight = &CornerPair::right;

std::vector<BoardCorners> Views(const std::vector<CornerPair>& pairs,
                                BoardCorners CornerPair::*camera) {
  std::vector<BoardCorners> views;
  for (const CornerPair& pair : pairs) views.push_back(pair.*camera);
  return views;
}

/// The pairs still in the calibration and those left out so far.
class PairSelection {
 public:
  PairSelection(std::vector<CornerPair> pairs, const StereoCalibrationOptions& options)
      : pairs_(std::move(pairs)), options_(options), num_given_(pairs_.size()) {
    CheckEnough();
  }

  const std::vector<CornerPair>& Pairs() const { return pairs_; }
  std::vector<LeftOutPair> TakeLeftOut() { return std::move(left_out_); }

  /// Leaves out the pairs whose error stands out, with `cause` in their reason; false where none.
  bool LeaveOut(const std::vector<double>& errors, double factor, double floor,
                const std::string& cause) {
    const std::vector<char> is_outlier = FindOutliers(errors, factor, floor);
    const double median = Median(errors);
    std::vector<CornerPair> kept;
    for (size_t i = 0; i < pairs_.size(); ++i) {
      if (is_outlier[i]) {
        left_out_.push_back(
            {pairs_[i].name,
             cause + Format(": %.2f px rms against a median of %.2f px", errors[i], median)});
      } else {
        kept.push_back(std::move(pairs_[i]));
      }
    }
    const bool has_changed = kept.size() < pairs_.size();
    pairs_ = std::move(kept);
    CheckEnough();
    return has_changed;
  }

 private:
  void CheckEnough() const {
    const size_t needed = std::max<size_t>(options_.min_pairs, (num_given_ + 1) / 2);
    if (pairs_.size() >= needed) return;
    std::string message = "too few views: " + std::to_string(pairs_.size()) + " good pairs of " +
                          std::to_string(num_given_) + ", at least " + std::to_string(needed) +
                          " are needed";
    for (const LeftOutPair& pair : left_out_)
      message += "\n  left out " + pair.name + ": " + pair.reason;
    throw CalibrationError(message);
  }

  std::vector<CornerPair> pairs_;
  const StereoCalibrationOptions& options_;
  const size_t num_given_;
  std::vector<LeftOutPair> left_out_;
};

struct BothCameras {
  SingleCalibration left, right;
};

/// Each camera for itself, without the views that it finds bad.
BothCameras CalibrateCameras(PairSelection& selection, const Chessboard& board, cv::Size image_size,
                             DistortionModel model) {
  while (true) {
    BothCameras cameras{
        CalibrateCamera(Views(selection.Pairs(), kLeft), board, image_size, model),
        CalibrateCamera(Views(selection.Pairs(), kRight), board, image_size, model)};
    if (selection.LeaveOut(cameras.left.view_rms_px, kOutlierFactor, kOutlierFloor_px,
                           "left corners do not fit the left camera"))
      continue;
    if (selection.LeaveOut(cameras.right.view_rms_px, kOutlierFactor, kOutlierFloor_px,
                           "right corners do not fit the right camera"))
      continue;
    return cameras;
  }
}

void CheckViews(const char* camera, const SingleCalibration& calibration,
                const IntrinsicsPrecision& precision) {
  const double tilt_deg = LargestTilt(calibration.poses) * 180 / M_PI;
  const std::string advice = "; tilt the board by 20 to 45 degrees about both its axes";
  if (tilt_deg < kMinTilt_deg)
    throw CalibrationError("all views of the " + std::string(camera) +
                           " camera are parallel: the board's planes differ by " +
                           Format("%.1f degrees at most", tilt_deg) + advice);
  const double fx = calibration.camera.matrix(0, 0);
  if (!(precision.fx_sigma_px <= kMaxFocalSigma * fx))
    throw CalibrationError(
        "the views do not determine the focal length of the " + std::string(camera) +
        Format(" camera, fx = %.1f +- %.1f px (views nearly parallel)", fx, precision.fx_sigma_px) +
        advice);
}

/// Throws where no relative pose suits most pairs, naming a mirrored camera where that is the
/// cause.
void CheckCommonPose(const BothCameras& cameras, const std::vector<double>& consistency,
                     const std::vector<CornerPair>& pairs, const Chessboard& board,
                     cv::Size image_size, const StereoCalibrationOptions& options) {
  const double error = Median(consistency);
  if (error < kNoCommonPosePx) return;
  std::vector<CornerPair> mirrored = pairs;
  for (CornerPair& pair : mirrored)
    pair.right = AlignOrder(pair.left, MirrorCorners(pair.right, board.Size(), image_size.width),
                            board.Size());
  const SingleCalibration right =
      CalibrateCamera(Views(mirrored, kRight), board, image_size, options.model);
  const double mirrored_error = Median(MeasureConsistency(cameras.left, right, mirrored, board));
  if (mirrored_error < error / 4)
    throw CalibrationError(
        "one camera is mirrored: with the right images mirrored the pairs agree "
        "(" +
        Format("%.1f px instead of %.1f px)", mirrored_error, error));
  throw CalibrationError("the cameras do not agree: the best relative pose leaves " +
                         Format("%.1f px (median of the pairs)", error) +
                         "; are the pairs taken at the same moments, and is the board the same?");
}

/// Both cameras together by OpenCV, from each camera's own calibration.
StereoCalibration AdjustTogether(const BothCameras& cameras, const std::vector<CornerPair>& pairs,
                                 const Chessboard& board, cv::Size image_size) {
  StereoCalibration calibration;
  calibration.image_size = image_size;
  calibration.left = {cameras.left.camera.matrix, cameras.left.camera.distortion.clone()};
  calibration.right = {cameras.right.camera.matrix, cameras.right.camera.distortion.clone()};
  const std::vector<std::vector<cv::Point3f>> board_corners(pairs.size(), board.Corners());
  const bool is_rational = calibration.left.distortion.total() > 5;
  cv::Mat rotation = cv::Mat::eye(3, 3, CV_64F), translation = cv::Mat::zeros(3, 1, CV_64F);
  cv::Mat essential, fundamental, errors;
  calibration.stereo_rms_px = cv::stereoCalibrate(
      board_corners, Views(pairs, kLeft), Views(pairs, kRight), calibration.left.matrix,
      calibration.left.distortion, calibration.right.matrix, calibration.right.distortion,
      image_size, rotation, translation, essential, fundamental, errors,
      cv::CALIB_USE_INTRINSIC_GUESS | (is_rational ? cv::CALIB_RATIONAL_MODEL : 0),
      {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-9});
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> r(rotation.ptr<double>());
  const Eigen::Map<const Eigen::Vector3d> t(translation.ptr<double>());
  calibration.right_from_left = Rigid3(Eigen::Matrix3d(r), Eigen::Vector3d(t));
  for (int i = 0; i < errors.rows; ++i) {
    calibration.left_px.push_back(errors.at<double>(i, 0));
    calibration.right_px.push_back(errors.at<double>(i, 1));
  }
  return calibration;
}

std::vector<double> WorseCamera(const StereoCalibration& calibration) {
  std::vector<double> errors;
  for (size_t i = 0; i < calibration.left_px.size(); ++i)
    errors.push_back(std::max(calibration.left_px[i], calibration.right_px[i]));
  return errors;
}

void CheckRig(const Rigid3& right_from_left) {
  const Eigen::Vector3d right_in_left = right_from_left.Inverse().translation;
  const std::string where =
      Format("the right camera is at x = %.4f, y = %.4f", right_in_left.x(), right_in_left.y()) +
      Format(", z = %.4f of the left camera", right_in_left.z());
  const double sideways = std::abs(right_in_left.x());
  if (sideways < std::abs(right_in_left.y()) || sideways < std::abs(right_in_left.z()))
    throw CalibrationError("the cameras are not side by side: " + where);
  if (right_in_left.x() < 0)
    throw CalibrationError(
        "left and right are swapped (or both cameras mirrored or upside down): " + where);
}

}  // namespace

void StereoCalibrationOptions::Check() const {
  Require(min_pairs >= 3, "min_pairs must be at least 3");
}

StereoCalibration CalibrateStereo(std::vector<CornerPair> pairs, const Chessboard& board,
                                  cv::Size image_size, const StereoCalibrationOptions& options) {
  board.Check();
  options.Check();
  PairSelection selection(std::move(pairs), options);
  BothCameras cameras = CalibrateCameras(selection, board, image_size, options.model);
  CheckViews("left", cameras.left,
             EvaluatePrecision(cameras.left, Views(selection.Pairs(), kLeft), board));
  CheckViews("right", cameras.right,
             EvaluatePrecision(cameras.right, Views(selection.Pairs(), kRight), board));
  std::vector<double> consistency =
      MeasureConsistency(cameras.left, cameras.right, selection.Pairs(), board);
  CheckCommonPose(cameras, consistency, selection.Pairs(), board, image_size, options);
  while (selection.LeaveOut(consistency, kGrossFactor, kGrossFloorPx,
                            "the cameras disagree (board moved between the exposures?)")) {
    cameras = CalibrateCameras(selection, board, image_size, options.model);
    consistency = MeasureConsistency(cameras.left, cameras.right, selection.Pairs(), board);
  }
  StereoCalibration calibration = AdjustTogether(cameras, selection.Pairs(), board, image_size);
  while (selection.LeaveOut(WorseCamera(calibration), kOutlierFactor, kOutlierFloor_px,
                            "does not fit both cameras together")) {
    cameras = CalibrateCameras(selection, board, image_size, options.model);
    calibration = AdjustTogether(cameras, selection.Pairs(), board, image_size);
  }
  CheckRig(calibration.right_from_left);
  calibration.left_precision =
      EvaluatePrecision(cameras.left, Views(selection.Pairs(), kLeft), board);
  calibration.right_precision =
      EvaluatePrecision(cameras.right, Views(selection.Pairs(), kRight), board);
  calibration.tilt_rad = LargestTilt(cameras.left.poses);
  calibration.pairs = selection.Pairs();
  calibration.left_out = selection.TakeLeftOut();
  return calibration;
}

}  // namespace arfm_vo
