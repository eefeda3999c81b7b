#pragma once

#include <string>
#include <vector>

namespace arfm_vo {

/// The numbers of one line of a text file.
struct NumberRow {
  int line = 0;  ///< counted from 1
  std::vector<double> values;
};

/// Reads a decimal number that is all of `text` ("-1.5e+3", "+2", "inf"), in any locale. False,
/// with `number` as it was, where it is not one or a double cannot hold it.
bool ParseNumber(const std::string& text, double& number);

/// Finite numbers separated by white space. Throws std::invalid_argument beginning with `place`
/// where a word is not a number, or is not finite.
std::vector<double> ParseNumbers(const std::string& text, const std::string& place);

/// The rows of a text file in which each line holds `num_columns` finite numbers; empty lines and
/// lines that begin with # are left out. Throws std::invalid_argument naming file and line.
std::vector<NumberRow> ReadNumberRows(const std::string& path, int num_columns);

/// The shortest decimal text that reads back as exactly `value`, the same on every machine;
/// without an exponent where `fixed`.
std::string FormatNumber(double value, bool fixed = false);

}  // namespace arfm_vo
