#include "arfm_vo/base/number_rows.h"

#include <locale.h>

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
  const auto shortest = [&](std::ios_base& (*notation)(std::ios_base&)) {
    std::ostringstream stream;
    stream.imbue(std::locale::classic());
    double read_back = NAN;
    for (int precision = 0; read_back != value; ++precision) {
      stream.str("");
      stream << notation << std::setprecision(precision) << value;
      if (!std::isfinite(value) || !ParseNumber(stream.str(), read_back)) break;
    }
    return stream.str();
  };
  const std::string plain = shortest(std::fixed), scientific = shortest(std::scientific);
  return fixed || plain.size() <= scientific.size() ? plain : scientific;
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
