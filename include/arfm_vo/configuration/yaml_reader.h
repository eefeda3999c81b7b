#pragma once

#include <yaml-cpp/yaml.h>

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "arfm_vo/base/check.h"
#include "arfm_vo/configuration/option_traits.h"

namespace arfm_vo {

/// The only document of a YAML file (a null node where it is empty). Throws std::invalid_argument
/// naming file and line where it cannot be read or parsed.
YAML::Node LoadYamlFile(const std::string& path);

/// A node and its name in messages.
struct YamlValue {
  YAML::Node node;
  std::string source;  ///< file, or whatever else the node was made from
  std::string key;     ///< full dotted name, empty for the whole document

  /// Throws std::invalid_argument: "source:line: key: what" (no line for a node made in memory).
  [[noreturn]] void Fail(const std::string& what) const;
  YamlValue Child(const YAML::Node& child, const std::string& name) const;
};

void ReadYamlValue(const YamlValue& value, bool& field);
void ReadYamlValue(const YamlValue& value, double& field);
void ReadYamlValue(const YamlValue& value, std::string& field);
/// A plain decimal integer in [min, max].
int64_t ReadYamlInteger(const YamlValue& value, int64_t min, int64_t max);
/// The index in `names` of the one that a scalar holds.
size_t ReadYamlName(const YamlValue& value, const std::vector<std::string>& names);
/// The elements of a list, each with its index in its name.
std::vector<YamlValue> ListElements(const YamlValue& value);

/// The visitor that reads the fields of one options struct from one YAML map.
class YamlMapReader {
 public:
  /// Fails unless the value is a map (or null: no keys) in which no key stands twice.
  explicit YamlMapReader(const YamlValue& map);

  template <class Field>
  void operator()(const char* name, Field& field);
  /// The value of a key, which is known from now on; none where the map does not hold it.
  std::optional<YamlValue> Find(const char* name);
  /// Fails where the map holds a key that was not asked for.
  void CheckAllKeysKnown() const;

 private:
  YamlValue map_;
  std::vector<std::string> known_;
};

template <class Field>
void ReadYamlField(const YamlValue& value, Field& field) {
  if constexpr (kHasFields<Field>) {
    YamlMapReader reader(value);
    field.VisitFields(reader);
    reader.CheckAllKeysKnown();
    Within(value.source, [&] { field.Check(); });
  } else if constexpr (std::is_enum_v<Field>) {
    const auto names = ListNames(Field{});
    field = names[ReadYamlName(value, FirstsOf(names))].second;
  } else if constexpr (std::is_integral_v<Field> && !std::is_same_v<Field, bool>) {
    static_assert(sizeof(Field) < 8 || std::is_signed_v<Field>, "no 64 bit unsigned options");
    using Limits = std::numeric_limits<Field>;
    field = static_cast<Field>(ReadYamlInteger(value, Limits::min(), Limits::max()));
  } else if constexpr (kIsVector<Field> || kIsArray<Field>) {
    const std::vector<YamlValue> elements = ListElements(value);
    if constexpr (kIsVector<Field>) field.assign(elements.size(), {});
    if (elements.size() != field.size())
      value.Fail("must be a list of " + std::to_string(field.size()));
    for (size_t i = 0; i < field.size(); ++i) ReadYamlField(elements[i], field[i]);
  } else {
    ReadYamlValue(value, field);
  }
}

template <class Field>
void YamlMapReader::operator()(const char* name, Field& field) {
  if (const auto value = Find(name)) ReadYamlField(*value, field);
}

/// Reads options strictly: each key of the map must be a field (ARFM_FIELDS) of the right type, or
/// std::invalid_argument names the key with its full dotted name and where it stands. Keys left out
/// keep the value that they have. Each options struct that a map holds is checked, by its Check(),
/// so that none need check those within it. Where it throws, `options` is as before. A quoted
/// scalar is a string and nothing else.
template <class Options>
void ReadYaml(const YAML::Node& node, const std::string& source, Options& options) {
  Options read = options;
  ReadYamlField(YamlValue{node, source, ""}, read);
  options = read;
}

template <class Options>
Options ReadYamlFile(const std::string& path) {
  Options options;
  ReadYaml(LoadYamlFile(path), path, options);
  return options;
}

/// The same, or the defaults where `path` is empty.
template <class Options>
Options ReadYamlFileOrDefaults(const std::string& path) {
  return path.empty() ? Options() : ReadYamlFile<Options>(path);
}

}  // namespace arfm_vo
