#include "arfm_vo/pose/epnp.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

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
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter / x_in_world.cols());
    axes = solver.eigenvectors().rowwise().reverse();
    axes.col(2) = axes.col(0).cross(axes.col(1));
    lengths = solver.eigenvalues().reverse().cwiseMax(0).cwiseSqrt();
  }
};

struct Candidate {
  std::optional<Rigid3> camera_from_world;
  double error = std::numeric_limits<double>::infinity();  ///< sum of squares, normalised image
};

/// EPnP with C control points: the centroid and one on each of the C - 1 longest axes.
template <int C>
class Epnp {
 public:
  Epnp(const WorldPoints& x_in_world, const Rays& rays, const PrincipalAxes& principal)
      : x_in_world_(x_in_world), rays_(rays), principal_(principal) {
    FindNullSpace();
    FindPairProducts();
  }

  Candidate Solve() const {
    Candidate best;
    for (const Betas& start : Starts()) {
      const Candidate candidate = Evaluate(PoseOf(RefineBetas(start)));
      if (candidate.error < best.error) best = candidate;
    }
    return best;
  }

 private:
  static constexpr int kBetas = C == 4 ? 4 : 2;   ///< null-space vectors in use
  static constexpr int kPairs = C * (C - 1) / 2;  ///< distances between control points
  static constexpr int kStarts = C == 4 ? 4 : 2;
  using Betas = Eigen::Matrix<double, kBetas, 1>;
  using PairVector = Eigen::Matrix<double, kPairs, 1>;
  using ControlMatrix = Eigen::Matrix<double, 3 * C, 3 * C>;

  /// The eigenvectors of the kBetas smallest eigenvalues of M^T M (eq 7 of Lepetit et al.). M has
  /// for each point the rows [a_j, 0, -a_j x] and [0, a_j, -a_j y] over the control points j with
  /// the barycentric coordinates a_j, so its Gram matrix needs four sums for each pair (j, k).
  void FindNullSpace() {
    Eigen::Matrix<double, C, C> sum_1 = Eigen::Matrix<double, C, C>::Zero();
    Eigen::Matrix<double, C, C> sum_x = sum_1, sum_y = sum_1, sum_xx_yy = sum_1;
    for (Eigen::Index i = 0; i < x_in_world_.cols(); ++i) {
      const Eigen::Vector3d d =
          principal_.axes.transpose() * (x_in_world_.col(i) - principal_.centroid);
      Eigen::Matrix<double, C, 1> alpha;
      alpha.template tail<C - 1>() =
          d.template head<C - 1>().cwiseQuotient(principal_.lengths.template head<C - 1>());
      alpha[0] = 1 - alpha.template tail<C - 1>().sum();
      const double x = rays_(0, i), y = rays_(1, i);
      const Eigen::Matrix<double, C, C> product = alpha * alpha.transpose();
      sum_1 += product;
      sum_x += x * product;
      sum_y += y * product;
      sum_xx_yy += (x * x + y * y) * product;
    }
    ControlMatrix gram;
    for (int j = 0; j < C; ++j) {
      for (int k = 0; k < C; ++k) {
        gram.template block<3, 3>(3 * j, 3 * k) << sum_1(j, k), 0, -sum_x(j, k), 0, sum_1(j, k),
            -sum_y(j, k), -sum_x(j, k), -sum_y(j, k), sum_xx_yy(j, k);
      }
    }
    const Eigen::SelfAdjointEigenSolver<ControlMatrix> solver(gram);
    null_space_ = solver.eigenvectors().template leftCols<kBetas>();
  }

  Eigen::Vector3d ControlPoint(int j) const {
    if (j == 0) return principal_.centroid;
    return principal_.centroid + principal_.lengths[j - 1] * principal_.axes.col(j - 1);
  }

  /// For each pair of control points the products of the differences of the null vectors, and the
  /// squared distance they must give (eqs 13 to 15 of Lepetit et al.).
  void FindPairProducts() {
    int pair = 0;
    for (int j = 0; j < C; ++j) {
      for (int k = j + 1; k < C; ++k, ++pair) {
        const Eigen::Matrix<double, 3, kBetas> difference =
            null_space_.template middleRows<3>(3 * j) - null_space_.template middleRows<3>(3 * k);
        products_[pair] = difference.transpose() * difference;
        squared_distances_[pair] = (ControlPoint(j) - ControlPoint(k)).squaredNorm();
      }
    }
  }

  /// Linear solutions for the products of the betas, one for each dimension N of the null space.
  std::array<Betas, kStarts> Starts() const {
    std::array<Betas, kStarts> starts;
    starts[0] = StartOfOne();
    starts[1] = StartOfProducts<3>({{{0, 0}, {0, 1}, {1, 1}}});
    if constexpr (C == 4) {
      starts[2] = StartOfProducts<5>({{{0, 0}, {0, 1}, {1, 1}, {0, 2}, {1, 2}}});
      starts[3] = StartOfProducts<4>({{{0, 0}, {0, 1}, {0, 2}, {0, 3}}});
    }
    return starts;
  }

  Betas StartOfOne() const {
    double numerator = 0, denominator = 0;
    for (int p = 0; p < kPairs; ++p) {
      numerator += std::sqrt(products_[p](0, 0) * squared_distances_[p]);
      denominator += products_[p](0, 0);
    }
    Betas betas = Betas::Zero();
    betas[0] = numerator / denominator;
    return betas;
  }

  /// Least squares for the named products beta_a beta_b, the others taken as zero.
  template <int N>
  Betas StartOfProducts(const std::array<std::pair<int, int>, N>& pairs_of_betas) const {
    Eigen::Matrix<double, kPairs, N> system;
    for (int p = 0; p < kPairs; ++p) {
      for (int i = 0; i < N; ++i) {
        const auto [a, b] = pairs_of_betas[i];
        system(p, i) = (a == b ? 1 : 2) * products_[p](a, b);
      }
    }
    const Eigen::Matrix<double, N, 1> solution = system.householderQr().solve(squared_distances_);
    Betas betas = Betas::Zero();
    betas[0] = std::sqrt(std::abs(solution[0]));
    for (int i = 1; i < N; ++i) {
      const auto [a, b] = pairs_of_betas[i];
      if (a == 0) betas[b] = solution[i] / std::copysign(betas[0], solution[0]);
    }
    return betas;
  }

  /// Gauss-Newton on the distances between control points (eq 15 of Lepetit et al.).
  Betas RefineBetas(Betas betas) const {
    constexpr int kMaxIterations = 10;
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
      Eigen::Matrix<double, kPairs, kBetas> jacobian;
      PairVector residual;
      for (int p = 0; p < kPairs; ++p) {
        const Betas product = products_[p] * betas;
        jacobian.row(p) = 2 * product;
        residual[p] = squared_distances_[p] - betas.dot(product);
      }
      Eigen::Matrix<double, kBetas, kBetas> normal = jacobian.transpose() * jacobian;
      normal.diagonal().array() += 1e-12 * normal.trace();  // keeps a rank-deficient step finite
      const Betas step = normal.ldlt().solve(jacobian.transpose() * residual);
      betas += step;
      if (!(step.squaredNorm() > 1e-20 * betas.squaredNorm())) break;
    }
    return betas;
  }

  /// Absolute orientation (Horn 1988; Umeyama 1991). With the control points on the principal axes
  /// the correlation of the points is that of the axes, so no sum over the points is needed.
  Rigid3 PoseOf(const Betas& betas) const {
    Eigen::Matrix<double, 3 * C, 1> control = null_space_ * betas;
    if (control[2] < 0) control = -control;  // the centroid is in front
    const Eigen::Vector3d centroid_in_camera = control.template head<3>();
    Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();
    for (int j = 1; j < C; ++j) {
      correlation += (control.template segment<3>(3 * j) - centroid_in_camera) *
                     (principal_.lengths[j - 1] * principal_.axes.col(j - 1)).transpose();
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(correlation,
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix3d u = svd.matrixU();
    if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) = -u.col(2);
    const Eigen::Matrix3d rotation = u * svd.matrixV().transpose();
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

  Eigen::Matrix<double, 3 * C, kBetas> null_space_;
  std::array<Eigen::Matrix<double, kBetas, kBetas>, kPairs> products_;
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
  if (lengths[2] < 1e-2 * lengths[0]) best = Epnp<3>(x_in_world, rays, principal).Solve();
  if (lengths[2] > 1e-7 * lengths[0]) {
    const Candidate candidate = Epnp<4>(x_in_world, rays, principal).Solve();
    if (candidate.error < best.error) best = candidate;
  }
  return best.camera_from_world;
}

}  // namespace arfm_vo
