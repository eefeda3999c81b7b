#include "arfm_vo/base/number_rows.h"

#include <cmath>
#include <sstream>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/whole_file.h"

namespace arfm_vo {

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
