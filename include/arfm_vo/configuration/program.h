#pragma once

#include <boost/program_options.hpp>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace arfm_vo {

/// A program of the command line: NAME INPUT.. [options].
struct Program {
  std::string name;
  std::string description;  ///< what --help says under the usage line
  /// The inputs, all required: name in the usage line and where the value goes.
  std::vector<std::pair<std::string, std::string*>> inputs;
  boost::program_options::options_description options{"Options"};
  /// Answers options that need no input; returns whether that was all that was asked.
  std::function<bool()> answer = [] { return false; };
  std::function<void()> run;

  /// The option --NAME VALUE: where its value goes, and what --help calls it.
  template <class Value>
  void Add(const char* option, Value& value, const char* word, const char* text) {
    options.add_options()(option, boost::program_options::value(&value)->value_name(word), text);
  }
  /// The option --NAME alone.
  void Add(const char* option, bool& is_given, const char* text) {
    options.add_options()(option, boost::program_options::bool_switch(&is_given), text);
  }
};

/// The whole of a program's main(). Takes `--key value` and `--key=value`, no abbreviations.
/// Returns 0; 1 with one line on stderr where `answer` or `run` threw; 2 for wrong arguments.
int RunProgram(int argc, const char* const* argv, Program program);

}  // namespace arfm_vo
