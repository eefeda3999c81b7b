#include "arfm_vo/base/number_rows.h"

#include <charconv>
#include <cmath>
#include <sstream>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/whole_file.h"

namespace arfm_vo {

std::vector<double> ParseNumbers(const std::string& text, const std::string& place) {
  std::vector<double> values;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const char* begin = word.data() + (word[0] == '+');
    double value = 0;
    const auto [end, error] = std::from_chars(begin, word.data() + word.size(), value);
    Require(error == std::errc() && end == word.data() + word.size(),
            place + ": '" + word + "' is not a number");
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

std::string FormatNumber(double value, bool fixed) {
  char text[400];  // a fixed double has up to 309 digits before its point
  const auto result =
      fixed ? std::to_chars(text, text + sizeof(text), value, std::chars_format::fixed)
            : std::to_chars(text, text + sizeof(text), value);
  return std::string(text, result.ptr);
}

}  // namespace arfm_vo
