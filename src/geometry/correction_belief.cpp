#include "arfm_vo/geometry/correction_belief.h"

#include <algorithm>
#include <cmath>

#include "arfm_vo/geometry/linear_algebra.h"

namespace arfm_vo {
namespace {

constexpr int kNumTerms = ImageBasis::kNumTerms, kNumLens = LensBasis::kNumTerms;

/// Small differences between two cameras that a calibration may leave: wx, wy, wz (rad), relative
/// focal length, its aspect, centre (px), k1, k2, k3, p1, p2 and the same two by r^2 (Brown,
/// Decentering distortion of lenses, 1966). Far wider than calibrations are, as their errors make
/// up for each other; the size of the field is bounded on its own.
constexpr int kNumErrors = 14;
constexpr double kErrorSigma[kNumErrors] = {0.02, 0.02, 0.005, 0.01, 0.001, 20,   20,
                                            0.01, 0.01, 0.01,  0.01, 0.01,  0.01, 0.01};
/// What no such error explains, and the size of the whole field, px a coefficient.
constexpr double kUnmodelledSigmaPx = 0.1, kFieldSigmaPx = 1;
/// Of both images' radial and tangential coefficients, px in the corners.
constexpr double kRadialSigmaPx = 3, kTangentialSigmaPx = 0.5;
/// Of both images' focal length: what calibrations after Zhang say of themselves.
constexpr double kFocalLengthSigma = 1e-3;
/// The pixels above are of a camera with this focal length: what a calibration is off by are
/// angles.
constexpr double kFocalLengthPx = 700;
/// How much the errors of kErrorSigma change from one drive to the next, whatever the focal length:
/// rotation (rad) and centre (px).
constexpr double kSigmaBetweenDrives[kNumErrors] = {1e-3, 1e-3, 1e-3, 0, 0, 0.3, 0.3};

using ErrorRow = Eigen::Matrix<double, 1, kNumErrors>;

Eigen::MatrixXd CovarianceOf(const double (&sigmas)[kNumErrors]) {
  return Eigen::Map<const Eigen::VectorXd>(sigmas, kNumErrors).cwiseAbs2().asDiagonal();
}

/// Displacement (du, dv) of a pixel by a unit of each error.
void DisplaceByErrors(const StereoCamera& camera, const Eigen::Vector2d& pixel, ErrorRow& du,
                      ErrorRow& dv) {
  const double x = (pixel.x() - camera.cx) / camera.fx, y = (pixel.y() - camera.cy) / camera.fy;
  const double r2 = x * x + y * y, r4 = r2 * r2, r6 = r4 * r2;
  const double across = 2 * x * y, along_x = r2 + 2 * x * x, along_y = r2 + 2 * y * y;
  du << x * y, 1 + x * x, y, x, x, 0, 0, x * r2, x * r4, x * r6, across, along_x, across * r2,
      along_x * r2;
  dv << 1 + y * y, x * y, -x, y, -y, 0, 0, y * r2, y * r4, y * r6, along_y, across, along_y * r2,
      across * r2;
  du *= camera.fx;
  dv *= camera.fy;
  du[5] = dv[6] = 1;
}

/// Coefficients of ImageBasis by a unit of each error: the least squares fit over a grid in the
/// image.
template <int kGrid = 21>
Eigen::Matrix<double, StereoCorrection::kSize, kNumErrors> CoefficientsByErrors(
    const StereoCamera& camera) {
  Eigen::Matrix<double, kNumTerms, kNumTerms> gram;
  Eigen::Matrix<double, kNumTerms, kNumErrors> along_u, along_v;
  gram.setZero();
  along_u.setZero();
  along_v.setZero();
  for (int i = 0; i < kGrid * kGrid; ++i) {
    const int row = i / kGrid, column = i % kGrid;
    const Eigen::Vector2d pixel((column + 0.5) * camera.width / kGrid,
                                (row + 0.5) * camera.height / kGrid);
    const ImageBasis basis(camera, pixel);
    ErrorRow du, dv;
    DisplaceByErrors(camera, pixel, du, dv);
    gram += basis.values * basis.values.transpose();
    along_u += basis.values * du;
    along_v += basis.values * dv;
  }
  Eigen::Matrix<double, StereoCorrection::kSize, kNumErrors> coefficients;
  coefficients << SolveSymmetric(gram, along_u),
      Eigen::Matrix<double, kNumLens, kNumErrors>::Zero(), SolveSymmetric(gram, along_v);
  return coefficients;
}

}  // namespace

CorrectionBelief CorrectionBelief::Isotropic(double sigma_px) {
  CorrectionBelief belief;
  belief.covariance = sigma_px * sigma_px * Matrix::Identity();
  return belief;
}

CorrectionBelief CorrectionBelief::OfCalibration(const StereoCamera& camera) {
  const auto by_errors = CoefficientsByErrors(camera);
  const Eigen::MatrixXd errors = CovarianceOf(kErrorSigma);
  const Matrix explained = Propagate(by_errors, errors) + Isotropic(kUnmodelledSigmaPx).covariance;
  CorrectionBelief belief;
  belief.covariance =
      InvertDefinite(InvertDefinite(explained) + Isotropic(kFieldSigmaPx).Information());
  auto of_lens = belief.covariance.diagonal().segment<kNumLens>(kNumTerms);
  of_lens.setConstant(kTangentialSigmaPx * kTangentialSigmaPx);
  of_lens.head<LensBasis::kNumRadial>().setConstant(kRadialSigmaPx * kRadialSigmaPx);
  belief.covariance *= std::pow(camera.fx / kFocalLengthPx, 2);
  belief.covariance.diagonal()[kNumTerms + LensBasis::kFocalLength] =
      std::pow(kFocalLengthSigma * LensBasis::CornerPx(camera), 2);
  return belief;
}

CorrectionBelief CorrectionBelief::AfterAPause(const StereoCamera& camera) const {
  const auto by_errors = CoefficientsByErrors(camera);
  const Eigen::MatrixXd errors = CovarianceOf(kSigmaBetweenDrives);
  CorrectionBelief belief = *this;
  belief.is_of_earlier_drive = false;
  belief.covariance += Propagate(by_errors, errors);
  return belief;
}

CorrectionBelief::Turns CorrectionBelief::ByTurn(const StereoCamera& camera) {
  return CoefficientsByErrors<7>(camera).leftCols<3>();  // quadratic, as the basis is: exact
}

Eigen::MatrixXd CorrectionBelief::ToTurn(const StereoCamera& camera) {
  const Eigen::MatrixXd by_turn = ByTurn(camera).transpose();
  return SolveSymmetric(Propagate(by_turn, Matrix::Identity()), by_turn);
}

CorrectionBelief CorrectionBelief::After(const RightTurn& turn, const StereoCamera& camera) const {
  const Turns by_turn = ByTurn(camera);
  CorrectionBelief after = *this;
  after.mean.coefficients_px += by_turn * turn.turn_rad;
  after.covariance += Propagate(by_turn, turn.covariance);
  return after;
}

CorrectionBelief::Matrix CorrectionBelief::Information() const {
  return InvertDefinite(covariance);
}

CorrectionBelief::Estimate CorrectionBelief::LargestRadial() const {
  constexpr int kSteps = 20, kNumRadial = LensBasis::kNumRadial;
  Estimate radial;
  for (int i = 1; i <= kSteps; ++i) {
    const double r = double(i) / kSteps;
    const auto by_coefficients = LensBasis::At({r, 0}).row(0).head<kNumRadial>().eval();
    const double off = by_coefficients.dot(mean.coefficients_px.segment<kNumRadial>(kNumTerms));
    if (std::abs(off) < std::abs(radial.mean)) continue;
    radial = {off, std::sqrt(by_coefficients.dot(
                       by_coefficients *
                       covariance.block<kNumRadial, kNumRadial>(kNumTerms, kNumTerms)))};
  }
  return radial;
}

CorrectionBelief::Estimate CorrectionBelief::FocalLengthExcess(const StereoCamera& camera) const {
  constexpr int kIndex = kNumTerms + LensBasis::kFocalLength;
  const double corner_px = LensBasis::CornerPx(camera);
  return {mean.coefficients_px[kIndex] / corner_px,
          std::sqrt(covariance(kIndex, kIndex)) / corner_px};
}

double CorrectionBelief::MaxColumnSigma(const StereoCamera& camera) const {
  constexpr int kGrid = 9;
  double largest = 0;
  for (int i = 0; i < kGrid * kGrid; ++i) {
    const Eigen::Vector2d edge(camera.width - 1, camera.height - 1);
    const Eigen::Vector2d place(i % kGrid, i / kGrid);
    const ImageBasis basis(camera, edge.cwiseProduct(place) / (kGrid - 1));
    largest = std::max(
        largest, basis.values.dot(covariance.topLeftCorner<kNumTerms, kNumTerms>() * basis.values));
  }
  return std::sqrt(largest);
}

}  // namespace arfm_vo
