#include <charconv>
#if !defined(__cpp_lib_to_chars)  // libstdc++ before 11: of integers only
#include <locale.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <sstream>
#endif

#include "arfm_vo/base/number_rows.h"

namespace arfm_vo {

#if defined(__cpp_lib_to_chars)

namespace {

bool ParseWithoutPlus(const std::string& text, double& number) {
  const char* const end = text.data() + text.size();
  double value = 0;
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end) return false;
  number = value;
  return true;
}

}  // namespace

std::string FormatNumber(double value, bool fixed) {
  char text[400];  // a fixed double has up to 309 digits before its point
  const auto result =
      fixed ? std::to_chars(text, text + sizeof(text), value, std::chars_format::fixed)
            : std::to_chars(text, text + sizeof(text), value);
  return std::string(text, result.ptr);
}

#else

namespace {

/// As above by strtod, which reads white space, a sign + and hexadecimal digits as well.
bool ParseWithoutPlus(const std::string& text, double& number) {
  static const locale_t classic = newlocale(LC_ALL_MASK, "C", nullptr);
  if (text.empty() || text.find_first_of(" \t\n\v\f\r+") == 0) return false;
  if (text.find_first_of("xX") != std::string::npos) return false;
  errno = 0;
  char* end = nullptr;
  const double value = strtod_l(text.c_str(), &end, classic);
  if (end != text.c_str() + text.size()) return false;
  if (errno == ERANGE && (value == 0 || std::isinf(value))) return false;  // not where subnormal
  number = value;
  return true;
}

}  // namespace

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
  } while (!ParseWithoutPlus(stream.str(), read_back) || read_back != value);
  const std::string scientific = stream.str();
  const int exponent = std::stoi(scientific.substr(scientific.find('e') + 1));
  stream.str("");
  stream << std::fixed << std::setprecision(std::max(0, num_decimals - exponent)) << value;
  return fixed || stream.str().size() <= scientific.size() ? stream.str() : scientific;
}

#endif

bool ParseNumber(const std::string& text, double& number) {
  const bool has_plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  return ParseWithoutPlus(text.substr(has_plus), number);
}

}  // namespace arfm_vo
