#include "arfm_vo/configuration/yaml_reader.h"

#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <boost/algorithm/string/join.hpp>
#include <charconv>
#include <cmath>
#include <set>
#include <sstream>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/number_rows.h"
#include "arfm_vo/base/whole_file.h"

namespace arfm_vo {
namespace {

/// The text of a scalar; fails with `expected` for anything else.
std::string GetScalar(const YamlValue& value, const std::string& expected) {
  if (!value.node.IsDefined() || value.node.IsNull())
    value.Fail("must be " + expected + ", is empty");
  if (!value.node.IsScalar()) value.Fail("must be " + expected);
  return value.node.Scalar();
}

/// The text of a scalar that is not quoted (a quoted one is a string whatever it holds).
std::string GetPlainScalar(const YamlValue& value, const std::string& expected) {
  const std::string text = GetScalar(value, expected);
  if (value.node.Tag() == "!") value.Fail("must be " + expected + ", is \"" + text + "\"");
  return text;
}

bool ParseInteger(const std::string& text, int64_t& number) {
  const char* end = text.data() + text.size();
  const char* begin = text.data() + (text.size() > 1 && text[0] == '+' && text[1] != '-');
  const auto result = std::from_chars(begin, end, number);
  return result.ec == std::errc() && result.ptr == end;
}

class DocumentCounter : public YAML::EventHandler {
 public:
  int num_documents = 0;

  void OnDocumentStart(const YAML::Mark&) override { ++num_documents; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

/// The number of documents, counted up to `max`: yaml-cpp finds them without end where one begins
/// with a comma (as YAML::LoadAll does, which takes all memory).
int CountDocuments(const std::string& content, int max) {
  std::istringstream stream(content);
  YAML::Parser parser(stream);
  DocumentCounter counter;
  while (counter.num_documents < max && parser.HandleNextDocument(counter)) {
  }
  return counter.num_documents;
}

}  // namespace

YAML::Node LoadYamlFile(const std::string& path) {
  try {
    const std::string content = ReadWholeFile(path);
    Require(CountDocuments(content, 2) <= 1, path + ": holds more than one YAML document");
    return YAML::Load(content);
  } catch (const YAML::Exception& error) {
    throw std::invalid_argument(path + ":" + std::to_string(error.mark.line + 1) + ": " +
                                error.msg);
  }
}

void YamlValue::Fail(const std::string& what) const {
  const YAML::Mark mark = node.IsDefined() ? node.Mark() : YAML::Mark::null_mark();
  const std::string line = mark.is_null() ? "" : ":" + std::to_string(mark.line + 1);
  throw std::invalid_argument(source + line + ": " + (key.empty() ? "" : key + ": ") + what);
}

YamlValue YamlValue::Child(const YAML::Node& child, const std::string& name) const {
  return {child, source, key.empty() || name[0] == '[' ? key + name : key + "." + name};
}

void ReadYamlValue(const YamlValue& value, bool& field) {
  const std::string text = GetPlainScalar(value, "true or false");
  if (text != "true" && text != "false") value.Fail("must be true or false, is " + text);
  field = text == "true";
}

void ReadYamlValue(const YamlValue& value, double& field) {
  const std::string text = GetPlainScalar(value, "a number");
  if (text == ".inf" || text == "-.inf") {
    field = text[0] == '-' ? -HUGE_VAL : HUGE_VAL;
  } else if (!ParseNumber(text, field) || !std::isfinite(field)) {
    value.Fail("must be a number, is " + text);
  }
}

void ReadYamlValue(const YamlValue& value, std::string& field) {
  field = GetScalar(value, "a string");
}

int64_t ReadYamlInteger(const YamlValue& value, int64_t min, int64_t max) {
  const std::string text = GetPlainScalar(value, "an integer");
  int64_t number = 0;
  if (!ParseInteger(text, number)) value.Fail("must be an integer, is " + text);
  if (number < min || number > max) {
    value.Fail("must be an integer in " + std::to_string(min) + ".." + std::to_string(max) +
               ", is " + text);
  }
  return number;
}

size_t ReadYamlName(const YamlValue& value, const std::vector<std::string>& names) {
  const std::string text = GetScalar(value, "one of " + boost::join(names, ", "));
  const auto found = std::find(names.begin(), names.end(), text);
  if (found == names.end())
    value.Fail("must be one of " + boost::join(names, ", ") + ", is " + text);
  return found - names.begin();
}

std::vector<YamlValue> ListElements(const YamlValue& value) {
  if (!value.node.IsSequence()) value.Fail("must be a list");
  std::vector<YamlValue> elements;
  for (size_t i = 0; i < value.node.size(); ++i) {
    elements.push_back(value.Child(value.node[i], "[" + std::to_string(i) + "]"));
  }
  return elements;
}

YamlMapReader::YamlMapReader(const YamlValue& map) : map_(map) {
  if (map.node.IsNull() && map.key.empty()) return;
  if (!map.node.IsMap()) map.Fail("must be a map of options");
  std::set<std::string> seen;
  for (const auto& entry : map.node) {
    const YamlValue key{entry.first, map.source, map.key};
    if (!entry.first.IsScalar()) key.Fail("a key must be a name");
    if (!seen.insert(entry.first.Scalar()).second) {
      map.Child(entry.first, entry.first.Scalar()).Fail("stands twice");
    }
  }
}

std::optional<YamlValue> YamlMapReader::Find(const char* name) {
  known_.emplace_back(name);
  if (!map_.node.IsMap()) return std::nullopt;
  const YAML::Node& map = map_.node;  // const: a search that adds no key
  if (const YAML::Node found = map[name]) return map_.Child(found, name);
  return std::nullopt;
}

void YamlMapReader::CheckAllKeysKnown() const {
  if (!map_.node.IsMap()) return;
  for (const auto& entry : map_.node) {
    const std::string name = entry.first.Scalar();
    if (std::find(known_.begin(), known_.end(), name) == known_.end())
      map_.Child(entry.first, name).Fail("unknown key; known here: " + boost::join(known_, ", "));
  }
}

}  // namespace arfm_vo
