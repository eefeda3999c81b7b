#pragma once

namespace arfm_vo {

/// Natural logarithm of the probability, 0.003, that a wrong match agrees with a pose: it lies
/// anywhere where it was looked for, 40 px around, and agrees within 3 sigma, some 2 px. (Both
/// images must agree, and a search through the whole image is wider: less by far.)
constexpr double kLogChance = -5.8;

/// Natural logarithm of how many sets of `num_agreeing` of so many wrong matches agree with a pose
/// by chance, where each of them agrees with a probability whose logarithm is `log_chance`: what an
/// a contrario test asks for (Moisan and Stival 2004).
double LogFalseAlarms(int num_matches, int num_agreeing, double log_chance = kLogChance);

/// The least number of `num_matches` matches, looked for near where they are expected, that agree
/// with a pose by chance in fewer than one image in 10,000, but `at_least`; more than `num_matches`
/// where all may.
int LeastAgreeing(int num_matches, int at_least = 0);

}  // namespace arfm_vo
