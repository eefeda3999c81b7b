#include "arfm_vo/odometry/senses/sense_state.h"

#include <algorithm>
#include <cmath>

#include "arfm_vo/base/format.h"

namespace arfm_vo {
namespace {

/// Of one sense in twenty being wrong.
const double kPriorLogOdds = std::log(19.);
constexpr double kMaxSigmas = 3;

/// Up to a constant.
double LogNormal(double x, double variance) { return -(x * x / variance + std::log(variance)) / 2; }

}  // namespace

SenseState::SenseState(std::vector<SenseNumber> numbers)
    : numbers_(std::move(numbers)),
      mean_(numbers_.size()),
      covariance_(Eigen::MatrixXd::Zero(numbers_.size(), numbers_.size())) {
  for (size_t i = 0; i < numbers_.size(); ++i) {
    mean_[i] = numbers_[i].ideal;
    covariance_(i, i) = std::pow(numbers_[i].at_first, 2);
  }
}

void SenseState::Advance(double interval_s) {
  for (size_t i = 0; i < numbers_.size(); ++i) {
    covariance_(i, i) += std::pow(numbers_[i].walk_per_s, 2) * interval_s;
  }
}

void SenseState::Carry(const Eigen::MatrixXd& carry, const Eigen::MatrixXd& noise) {
  mean_ = carry * mean_;
  covariance_ = carry * covariance_ * carry.transpose() + noise;
}

void SenseState::Update(const Eigen::VectorXd& jacobian, double residual, double variance) {
  const Eigen::VectorXd carried = covariance_ * jacobian;
  const double innovation_variance =
      std::max(jacobian.dot(carried) + variance, std::pow(residual / kMaxSigmas, 2));
  mean_ += carried * (residual / innovation_variance);
  covariance_ -= carried * carried.transpose() / innovation_variance;
}

std::vector<std::pair<std::string, std::string>> SenseState::Describe() const {
  std::vector<std::pair<std::string, std::string>> texts;
  for (size_t i = 0; i < numbers_.size(); ++i) {
    texts.emplace_back(numbers_[i].name,
                       Format("%.3f (sigma %.3f)", mean_[i], std::sqrt(covariance_(i, i))));
  }
  return texts;
}

std::optional<std::string> SenseState::FindFault() const {
  std::optional<size_t> worst;
  double least = 0;
  for (size_t i = 0; i < numbers_.size(); ++i) {
    const double usual = std::pow(numbers_[i].usual, 2);
    const double log_odds = kPriorLogOdds +
                            LogNormal(mean_[i] - numbers_[i].ideal, covariance_(i, i) + usual) -
                            LogNormal(0, std::pow(numbers_[i].at_first, 2) + usual);
    if (log_odds >= least) continue;
    least = log_odds;
    worst = i;
  }
  if (!worst) return std::nullopt;
  const auto [name, text] = Describe()[*worst];
  return name + " " + text;
}

}  // namespace arfm_vo
