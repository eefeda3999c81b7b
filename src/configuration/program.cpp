#include "arfm_vo/configuration/program.h"

#include <iostream>

#include "arfm_vo/base/process_usage.h"

namespace arfm_vo {
namespace {

namespace po = boost::program_options;

std::string FormatUsage(const Program& program) {
  std::string usage = "usage: " + program.name;
  for (const auto& [name, value] : program.inputs) usage += " " + name;
  return usage + " [options]\n";
}

/// Sets inputs and options; returns whether --help is among them.
bool Parse(int argc, const char* const* argv, const Program& program) {
  po::options_description all;
  po::positional_options_description positional;
  for (const auto& [name, value] : program.inputs) {
    all.add_options()(name.c_str(), po::value(value));
    positional.add(name.c_str(), 1);
  }
  all.add(program.options);
  po::variables_map given;
  const auto style = po::command_line_style::unix_style & ~po::command_line_style::allow_guessing;
  po::store(
      po::command_line_parser(argc, argv).options(all).positional(positional).style(style).run(),
      given);
  po::notify(given);
  return given.count("help") > 0;
}

void RequireInputs(const Program& program) {
  for (const auto& [name, value] : program.inputs) {
    if (value->empty()) throw po::error("no " + name + " given");
  }
}

}  // namespace

int RunProgram(int argc, const char* const* argv, Program program) {
  KeepMemoryFlat();
  program.options.add_options()("help,h", "show this and leave");
  try {
    if (Parse(argc, argv, program)) {
      std::cout << FormatUsage(program) << program.description << "\n" << program.options;
      return 0;
    }
    if (program.answer()) return 0;
    RequireInputs(program);
    program.run();
    return 0;
  } catch (const po::error& error) {
    std::cerr << program.name << ": " << error.what() << "\n" << FormatUsage(program);
    return 2;
  } catch (const std::exception& error) {
    std::cerr << program.name << ": " << error.what() << "\n";
    return 1;
  }
}

}  // namespace arfm_vo
