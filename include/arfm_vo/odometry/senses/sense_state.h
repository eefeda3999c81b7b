#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace arfm_vo {

/// A number by which a sense's readings differ from what is true.
struct SenseNumber {
  std::string name;   ///< in words, with its unit
  double ideal;       ///< of a sense without error
  double at_first;    ///< standard deviation of any sense: it may be mounted or wired wrong
  double usual;       ///< of a sense that is right
  double walk_per_s;  ///< how much it changes within a second
};

/// The numbers of a sense, learnt against the cameras by a Kalman filter. Whether the sense is
/// right is decided for each number by its odds: a right sense against any, by the ratio of the
/// likelihoods of all that was measured (Savage and Dickey's density ratio; Wagenmakers 2010),
/// where one sense in twenty is wrong.
class SenseState {
 public:
  explicit SenseState(std::vector<SenseNumber> numbers);

  void Advance(double interval_s);
  /// What the numbers are of has moved: mean <- carry * mean, with `noise` added.
  void Carry(const Eigen::MatrixXd& carry, const Eigen::MatrixXd& noise);
  /// `residual` is what was measured against what is expected by mean(), `jacobian` how it grows
  /// with the numbers. One beyond three standard deviations counts as if it were at three.
  void Update(const Eigen::VectorXd& jacobian, double residual, double variance);

  /// The first three, which go into what they are a step of: they are zero then.
  Eigen::Vector3d TakeFirst() {
    const Eigen::Vector3d step = mean_.head<3>();
    mean_.head<3>().setZero();
    return step;
  }

  const Eigen::VectorXd& mean() const { return mean_; }
  const Eigen::MatrixXd& covariance() const { return covariance_; }
  /// Each number's name and value.
  std::vector<std::pair<std::string, std::string>> Describe() const;
  /// The number by which the sense is likelier wrong than right, in words; the worst of some.
  std::optional<std::string> FindFault() const;

 private:
  std::vector<SenseNumber> numbers_;
  Eigen::VectorXd mean_;
  Eigen::MatrixXd covariance_;
};

}  // namespace arfm_vo
