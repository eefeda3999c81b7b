#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "arfm_vo/configuration/option_traits.h"

namespace arfm_vo {

/// The YAML text of a number: the shortest that reads back as the same double, with a point where
/// it has an exponent (rosparam takes 1e-05 for a string).
std::string FormatYamlNumber(double value);

/// The visitor that writes the fields of one options struct as entries of an open YAML map.
class YamlMapWriter {
 public:
  explicit YamlMapWriter(YAML::Emitter& emitter) : emitter_(emitter) {}

  template <class Field>
  void operator()(const char* name, Field& field) {
    emitter_ << YAML::Key << name << YAML::Value;
    Write(field);
  }
  template <class Field>
  void Write(Field& field);

 private:
  YAML::Emitter& emitter_;
};

template <class Field>
void YamlMapWriter::Write(Field& field) {
  if constexpr (kHasFields<Field>) {
    emitter_ << YAML::BeginMap;
    field.VisitFields(*this);
    emitter_ << YAML::EndMap;
  } else if constexpr (std::is_enum_v<Field>) {
    for (const auto& [name, value] : ListNames(field)) {
      if (value == field) emitter_ << name;
    }
  } else if constexpr (kIsVector<Field> || kIsArray<Field>) {
    emitter_ << YAML::Flow << YAML::BeginSeq;
    for (auto& element : field) Write(element);
    emitter_ << YAML::EndSeq;
  } else if constexpr (std::is_same_v<Field, std::string>) {
    emitter_ << YAML::DoubleQuoted << field;
  } else if constexpr (std::is_same_v<Field, double>) {
    emitter_ << FormatYamlNumber(field);
  } else if constexpr (std::is_same_v<Field, bool>) {
    emitter_ << field;
  } else {
    static_assert(std::is_integral_v<Field>);
    emitter_ << static_cast<long long>(field);
  }
}

/// All options with the values that they have, as YAML that ReadYaml takes.
template <class Options>
std::string WriteYaml(const Options& options) {
  Options copy = options;  // VisitFields is not const
  YAML::Emitter emitter;
  YamlMapWriter(emitter).Write(copy);
  return std::string(emitter.c_str()) + "\n";
}

}  // namespace arfm_vo
