#include "arfm_vo/configuration/yaml_writer.h"

#include <cmath>

#include "arfm_vo/base/number_rows.h"

namespace arfm_vo {

std::string FormatYamlNumber(double value) {
  if (std::isinf(value)) return value < 0 ? "-.inf" : ".inf";
  std::string text = FormatNumber(value);
  const size_t exponent = text.find('e');
  if (text.find('.') == std::string::npos) {
    text.insert(exponent == std::string::npos ? text.size() : exponent, ".0");
  }
  return text;
}

}  // namespace arfm_vo
