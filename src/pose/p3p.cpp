#include "p3p.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

namespace arfm_vo {
namespace {

/// A real root of x^3 + b x^2 + c x + d.
double CubicRoot(double b, double c, double d) {
  // Of depressed y^3 + p y + q with x = y - b / 3.
  const double p = c - b * b / 3, q = b * (2 * b * b / 27 - c / 3) + d;
  const double discriminant = q * q / 4 + p * p * p / 27;
  double y;
  if (discriminant >= 0) {
    const double u = std::cbrt(-q / 2 - std::copysign(std::sqrt(discriminant), q));
    y = u == 0 ? 0 : u - p / (3 * u);
  } else {  // of three the one that lies apart
    const double r = std::sqrt(-p / 3);
    y = std::copysign(2 * r * std::cos(std::acos(std::abs(q) / (2 * r * r * r)) / 3), -q);
  }
  double x = y - b / 3;
  for (int i = 0; i < 2; ++i) {  // Newton, for the digits that were lost
    const double slope = (3 * x + 2 * b) * x + c;
    if (slope != 0) x -= (((x + b) * x + c) * x + d) / slope;
  }
  return x;
}

/// Lambda Twist. The distances l along the unit rays obey l^T M_ij l = a_ij for the three pairs,
/// with M_ij = (e_i - e_j)(e_i - e_j)^T but for the cosines off the diagonal.
class P3p {
 public:
  P3p(const Eigen::Matrix3d& x, const Eigen::Matrix<double, 2, 3>& rays) : x_(x) {
    for (int i = 0; i < 3; ++i) y_.col(i) = rays.col(i).homogeneous().normalized();
  }

  std::vector<Rigid3> Solve() {
    Eigen::Matrix3d axes;
    axes << x_.col(0) - x_.col(1), x_.col(1) - x_.col(2), Eigen::Vector3d::Zero();
    axes.col(2) = axes.col(0).cross(axes.col(1));
    if (!(axes.col(2).norm() > 1e-9 * axes.col(0).squaredNorm())) return {};
    axes_inverse_ = axes.inverse();
    const Eigen::Matrix3d first = Squared(1, 2) * Pair(0, 1) - Squared(0, 1) * Pair(1, 2);
    const Eigen::Matrix3d second = Squared(1, 2) * Pair(0, 2) - Squared(0, 2) * Pair(1, 2);
    const double by_cube = second.determinant();
    const double gamma =
        CubicRoot((Adjugate(second) * first).trace() / by_cube,
                  (Adjugate(first) * second).trace() / by_cube, first.determinant() / by_cube);
    if (!std::isfinite(gamma)) return {};
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(first + gamma * second);
    // One eigenvalue is zero; the planes part the two eigenvectors of the others.
    const Eigen::Vector3d& values = solver.eigenvalues();
    if (!(values[0] < 0 && values[2] > 0)) return {};
    const double s = std::sqrt(-values[0] / values[2]);
    for (const double sign : {s, -s}) {
      CutPlane(solver.eigenvectors().col(2) * sign + solver.eigenvectors().col(0) * (sign * sign),
               second);
    }
    return std::move(poses_);
  }

 private:
  double Squared(int i, int j) const { return (x_.col(i) - x_.col(j)).squaredNorm(); }
  Eigen::Matrix3d Pair(int i, int j) const {
    Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
    m(i, i) = m(j, j) = 1;
    m(i, j) = m(j, i) = -y_.col(i).dot(y_.col(j));
    return m;
  }
  static Eigen::Matrix3d Adjugate(const Eigen::Matrix3d& m) {
    Eigen::Matrix3d adjugate;
    for (int i = 0; i < 3; ++i) adjugate.row(i) = m.col((i + 1) % 3).cross(m.col((i + 2) % 3));
    return adjugate;
  }

  /// Where the cone `second` meets the plane of the distances through its tip.
  void CutPlane(const Eigen::Vector3d& normal, const Eigen::Matrix3d& cone) {
    Eigen::Index largest;
    normal.cwiseAbs().maxCoeff(&largest);
    const Eigen::Vector3d u = normal.cross(Eigen::Vector3d::Unit((largest + 1) % 3)).normalized();
    const Eigen::Vector3d v = normal.cross(u).normalized();
    // u cos(phi) + v sin(phi)
    const double uu = u.dot(cone * u), uv = u.dot(cone * v), vv = v.dot(cone * v);
    const double root = uv * uv - uu * vv;
    if (!(root >= 0)) return;
    const double q = -(uv + std::copysign(std::sqrt(root), uv));
    AddPose(q * u + uu * v);
    AddPose(vv * u + q * v);
  }

  void AddPose(Eigen::Vector3d l) {
    l /= std::sqrt(l.dot(Pair(1, 2) * l) / Squared(1, 2));
    if (l.sum() < 0) l = -l;
    if (!(l.minCoeff() > 0) || !l.allFinite()) return;
    RefineDistances(l);
    const Eigen::Matrix3d seen = y_ * l.asDiagonal();
    Eigen::Matrix3d axes;
    axes << seen.col(0) - seen.col(1), seen.col(1) - seen.col(2), Eigen::Vector3d::Zero();
    axes.col(2) = axes.col(0).cross(axes.col(1));
    const Eigen::Matrix3d rotation = axes * axes_inverse_;
    poses_.emplace_back(rotation, Eigen::Vector3d(seen.col(0) - rotation * x_.col(0)));
    if (!poses_.back().IsFinite()) poses_.pop_back();
  }

  /// Gauss and Newton, for the digits that were lost.
  void RefineDistances(Eigen::Vector3d& l) const {
    for (int iteration = 0; iteration < 2; ++iteration) {
      Eigen::Matrix3d jacobian;
      Eigen::Vector3d error;
      for (int k = 0; k < 3; ++k) {
        const int i = k, j = (k + 1) % 3;
        const Eigen::Vector3d m = Pair(i, j) * l;
        error[k] = l.dot(m) - Squared(i, j);
        jacobian.row(k) = 2 * m;
      }
      const Eigen::Vector3d step = jacobian.inverse() * error;
      if (step.allFinite()) l -= step;
    }
  }

  const Eigen::Matrix3d& x_;
  Eigen::Matrix3d y_;  ///< unit rays
  Eigen::Matrix3d axes_inverse_;
  std::vector<Rigid3> poses_;
};

}  // namespace

std::vector<Rigid3> SolveP3p(const Eigen::Matrix3d& x_in_world,
                             const Eigen::Matrix<double, 2, 3>& rays) {
  return P3p(x_in_world, rays).Solve();
}

}  // namespace arfm_vo
