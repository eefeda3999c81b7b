#include "arfm_vo/pose/epnp.h"

#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <utility>

#include "arfm_vo/geometry/linear_algebra.h"

namespace arfm_vo {
namespace {

using WorldPoints = Eigen::Ref<const Eigen::Matrix3Xd>;
using Rays = Eigen::Ref<const Eigen::Matrix2Xd>;

/// Centroid and principal axes of the points, longest axis first.
struct PrincipalAxes {
  Eigen::Vector3d centroid;
  Eigen::Matrix3d axes;     ///< columns, a right-handed rotation
  Eigen::Vector3d lengths;  ///< m, root mean square along each axis

  explicit PrincipalAxes(const WorldPoints& x_in_world) : centroid(x_in_world.rowwise().mean()) {
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (Eigen::Index i = 0; i < x_in_world.cols(); ++i) {
      const Eigen::Vector3d d = x_in_world.col(i) - centroid;
      scatter += d * d.transpose();
    }
    const SymmetricEigen principal(scatter / x_in_world.cols());
    axes = principal.vectors.rowwise().reverse();
    axes.col(2) = axes.col(0).cross(axes.col(1));
    lengths = principal.values.reverse().cwiseMax(0).cwiseSqrt();
  }
};

struct Candidate {
  std::optional<Rigid3> camera_from_world;
  double error = std::numeric_limits<double>::infinity();  ///< sum of squares, normalised image
};

/// EPnP with 3 or 4 control points: the centroid and one on each of the longest axes. What has no
/// control point, pair of them or null vector is zero.
class Epnp {
 public:
  Epnp(const WorldPoints& x_in_world, const Rays& rays, const PrincipalAxes& principal,
       int num_controls)
      : num_controls_(num_controls), x_in_world_(x_in_world), rays_(rays), principal_(principal) {
    FindNullSpace();
    FindPairProducts();
  }

  Candidate Solve() const {
    Candidate best;
    const auto consider = [&](const Betas& start) {
      const Candidate candidate = Evaluate(PoseOf(RefineBetas(start)));
      if (candidate.error < best.error) best = candidate;
    };
    // Linear solutions for the products of the betas, one for each dimension of the null space.
    consider(StartOfOne());
    consider(StartOfProducts({{0, 0}, {0, 1}, {1, 1}}));
    if (num_controls_ == 4) {
      consider(StartOfProducts({{0, 0}, {0, 1}, {1, 1}, {0, 2}, {1, 2}}));
      consider(StartOfProducts({{0, 0}, {0, 1}, {0, 2}, {0, 3}}));
    }
    return best;
  }

 private:
  static constexpr int kMaxPairs = 6;  ///< of 4 control points
  using Betas = Eigen::Vector4d;       ///< weights of the null vectors
  using PairVector = Eigen::Matrix<double, kMaxPairs, 1>;

  /// The eigenvectors of the smallest eigenvalues of M^T M (eq 7 of Lepetit et al.), four, or two
  /// of three control points. M has for each point the rows [a_j, 0, -a_j x] and [0, a_j, -a_j y]
  /// over the control points j with the barycentric coordinates a_j, so its Gram matrix needs four
  /// sums for each pair (j, k).
  void FindNullSpace() {
    Eigen::Matrix4d sum_1 = Eigen::Matrix4d::Zero();
    Eigen::Matrix4d sum_x = sum_1, sum_y = sum_1, sum_xx_yy = sum_1;
    Eigen::Vector3d lengths = principal_.lengths;
    if (num_controls_ == 3) lengths[2] = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < x_in_world_.cols(); ++i) {
      const Eigen::Vector3d d =
          principal_.axes.transpose() * (x_in_world_.col(i) - principal_.centroid);
      Eigen::Vector4d alpha;
      alpha.tail<3>() = d.cwiseQuotient(lengths);
      alpha[0] = 1 - alpha.tail<3>().sum();
      const double x = rays_(0, i), y = rays_(1, i);
      const Eigen::Matrix4d product = alpha * alpha.transpose();
      sum_1 += product;
      sum_x += x * product;
      sum_y += y * product;
      sum_xx_yy += (x * x + y * y) * product;
    }
    Eigen::MatrixXd gram(3 * num_controls_, 3 * num_controls_);
    for (int j = 0; j < num_controls_; ++j) {
      for (int k = 0; k < num_controls_; ++k) {
        gram.block<3, 3>(3 * j, 3 * k) << sum_1(j, k), 0, -sum_x(j, k), 0, sum_1(j, k),
            -sum_y(j, k), -sum_x(j, k), -sum_y(j, k), sum_xx_yy(j, k);
      }
    }
    const int num_betas = num_controls_ == 4 ? 4 : 2;
    null_space_.topLeftCorner(gram.rows(), num_betas) =
        SymmetricEigen(gram).vectors.leftCols(num_betas);
  }

  Eigen::Vector3d ControlPoint(int j) const {
    if (j == 0) return principal_.centroid;
    return principal_.centroid + principal_.lengths[j - 1] * principal_.axes.col(j - 1);
  }

  /// For each pair of control points the products of the differences of the null vectors, and the
  /// squared distance they must give (eqs 13 to 15 of Lepetit et al.).
  void FindPairProducts() {
    for (int j = 0; j < num_controls_; ++j) {
      for (int k = j + 1; k < num_controls_; ++k, ++num_pairs_) {
        const Eigen::Matrix<double, 3, 4> difference =
            null_space_.middleRows<3>(3 * j) - null_space_.middleRows<3>(3 * k);
        products_[num_pairs_] = difference.transpose() * difference;
        squared_distances_[num_pairs_] = (ControlPoint(j) - ControlPoint(k)).squaredNorm();
      }
    }
  }

  Betas StartOfOne() const {
    double numerator = 0, denominator = 0;
    for (int p = 0; p < num_pairs_; ++p) {
      numerator += std::sqrt(products_[p](0, 0) * squared_distances_[p]);
      denominator += products_[p](0, 0);
    }
    return {numerator / denominator, 0, 0, 0};
  }

  /// Least squares for the named products beta_a beta_b, the others taken as zero.
  Betas StartOfProducts(std::initializer_list<std::pair<int, int>> pairs_of_betas) const {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(pairs_of_betas.size(), pairs_of_betas.size());
    Eigen::VectorXd right = Eigen::VectorXd::Zero(pairs_of_betas.size());
    for (int p = 0; p < num_pairs_; ++p) {
      Eigen::VectorXd row(pairs_of_betas.size());
      Eigen::Index i = 0;
      for (const auto& [a, b] : pairs_of_betas) row(i++) = (a == b ? 1 : 2) * products_[p](a, b);
      normal += row * row.transpose();
      right += squared_distances_[p] * row;
    }
    const Eigen::VectorXd solution = SolveSymmetric(normal, right);
    Betas betas(std::sqrt(std::abs(solution(0))), 0, 0, 0);
    Eigen::Index i = 0;
    for (const auto& [a, b] : pairs_of_betas) {
      if (a == 0 && b > 0) betas[b] = solution(i) / std::copysign(betas[0], solution(0));
      ++i;
    }
    return betas;
  }

  /// Gauss-Newton on the distances between control points (eq 15 of Lepetit et al.).
  Betas RefineBetas(Betas betas) const {
    constexpr int kMaxIterations = 10;
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
      Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
      Betas right = Betas::Zero();
      for (int p = 0; p < num_pairs_; ++p) {
        const Betas product = products_[p] * betas;
        normal += 4 * product * product.transpose();
        right += 2 * (squared_distances_[p] - betas.dot(product)) * product;
      }
      normal.diagonal().array() += 1e-12 * normal.trace();  // keeps a rank-deficient step finite
      const Betas step = SolveSymmetric(normal, right);
      betas += step;
      if (!(step.squaredNorm() > 1e-20 * betas.squaredNorm())) break;
    }
    return betas;
  }

  /// Absolute orientation. With the control points on the principal axes the correlation of the
  /// points is that of the axes, so no sum over the points is needed.
  Rigid3 PoseOf(const Betas& betas) const {
    Eigen::Matrix<double, 12, 1> control = null_space_ * betas;
    if (control[2] < 0) control = -control;  // the centroid is in front
    const Eigen::Vector3d centroid_in_camera = control.head<3>();
    Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();
    for (int j = 1; j < num_controls_; ++j) {
      correlation += (control.segment<3>(3 * j) - centroid_in_camera) *
                     (principal_.lengths[j - 1] * principal_.axes.col(j - 1)).transpose();
    }
    const Eigen::Matrix3d rotation = FindRotation(correlation);
    return {rotation, Eigen::Vector3d(centroid_in_camera - rotation * principal_.centroid)};
  }

  /// Infinite error where a point lies behind the camera or the pose is not finite.
  Candidate Evaluate(const Rigid3& camera_from_world) const {
    const Eigen::Matrix3d rotation = camera_from_world.RotationMatrix();
    double error = 0;
    for (Eigen::Index i = 0; i < x_in_world_.cols(); ++i) {
      const Eigen::Vector3d x = rotation * x_in_world_.col(i) + camera_from_world.translation;
      if (!(x.z() > 0)) return {};
      error += (x.head<2>() / x.z() - rays_.col(i)).squaredNorm();
    }
    if (!std::isfinite(error)) return {};
    return {camera_from_world, error};
  }

  int num_controls_;
  int num_pairs_ = 0;  ///< of control points
  Eigen::Matrix<double, 12, 4> null_space_ = Eigen::Matrix<double, 12, 4>::Zero();
  std::array<Eigen::Matrix4d, kMaxPairs> products_;
  PairVector squared_distances_;
  const WorldPoints& x_in_world_;
  const Rays& rays_;
  const PrincipalAxes& principal_;
};

}  // namespace

std::optional<Rigid3> SolveEpnp(const Eigen::Ref<const Eigen::Matrix3Xd>& x_in_world,
                                const Eigen::Ref<const Eigen::Matrix2Xd>& rays) {
  if (x_in_world.cols() < 4 || rays.cols() != x_in_world.cols()) return std::nullopt;
  if (!x_in_world.allFinite() || !rays.allFinite()) return std::nullopt;
  const PrincipalAxes principal(x_in_world);
  const Eigen::Vector3d& lengths = principal.lengths;
  if (!(lengths[1] > 1e-5 * lengths[0])) return std::nullopt;  // on a line or in one place
  // A thin cloud is solved both ways, as it may count as flat within the noise or not.
  Candidate best;
  if (lengths[2] < 1e-2 * lengths[0]) best = Epnp(x_in_world, rays, principal, 3).Solve();
  if (lengths[2] > 1e-7 * lengths[0]) {
    const Candidate candidate = Epnp(x_in_world, rays, principal, 4).Solve();
    if (candidate.error < best.error) best = candidate;
  }
  return best.camera_from_world;
}

}  // namespace arfm_vo
