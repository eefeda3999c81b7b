#include "arfm_vo/base/number_rows.h"

#include <locale.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <sstream>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/whole_file.h"

namespace arfm_vo {

bool ParseNumber(const std::string& text, double& number) {
  // strtod would read white space and hexadecimal digits as well.
  static const locale_t classic = newlocale(LC_ALL_MASK, "C", nullptr);
  if (text.empty() || text.find_first_of(" \t\n\v\f\rxX") != std::string::npos) return false;
  errno = 0;
  char* end = nullptr;
  const double value = strtod_l(text.c_str(), &end, classic);
  if (end != text.c_str() + text.size()) return false;
  if (errno == ERANGE && (value == 0 || std::isinf(value))) return false;  // not where subnormal
  number = value;
  return true;
}

#if defined(__cpp_lib_to_chars)

std::string FormatNumber(double value, bool fixed) {
  char text[400];  // a fixed double has up to 309 digits before its point
  const auto result =
      fixed ? std::to_chars(text, text + sizeof(text), value, std::chars_format::fixed)
            : std::to_chars(text, text + sizeof(text), value);
  return std::string(text, result.ptr);
}

#else  // libstdc++ before 11 has it of integers only

std::string FormatNumber(double value, bool fixed) {
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  if (!std::isfinite(value)) {
    stream << value;
    return stream.str();
  }
  int num_decimals = -1;
  double read_back = 0;
  do {
    stream.str("");
    stream << std::scientific << std::setprecision(++num_decimals) << value;
  } while (!ParseNumber(stream.str(), read_back) || read_back != value);
  const std::string scientific = stream.str();
  const int exponent = std::stoi(scientific.substr(scientific.find('e') + 1));
  stream.str("");
  stream << std::fixed << std::setprecision(std::max(0, num_decimals - exponent)) << value;
  return fixed || stream.str().size() <= scientific.size() ? stream.str() : scientific;
}

#endif

std::vector<double> ParseNumbers(const std::string& text, const std::string& place) {
  std::vector<double> values;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    double value = 0;
    Require(ParseNumber(word, value), place + ": '" + word + "' is not a number");
    Require(std::isfinite(value), place + ": '" + word + "' is not finite");
    values.push_back(value);
  }
  return values;
}

std::vector<NumberRow> ReadNumberRows(const std::string& path, int num_columns) {
  std::vector<NumberRow> rows;
  std::istringstream file(ReadWholeFile(path));
  int line = 0;
  for (std::string text; std::getline(file, text);) {
    const std::string place = path + ":" + std::to_string(++line);
    const size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string::npos || text[first] == '#') continue;
    rows.push_back({line, ParseNumbers(text, place)});
    Require(static_cast<int>(rows.back().values.size()) == num_columns,
            place + ": holds " + std::to_string(rows.back().values.size()) +
                " numbers instead of " + std::to_string(num_columns));
  }
  return rows;
}

}  // namespace arfm_vo
