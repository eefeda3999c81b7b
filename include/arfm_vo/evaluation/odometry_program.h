#pragma once

#include <functional>
#include <memory>
#include <string>

#include "arfm_vo/configuration/program.h"
#include "arfm_vo/datasets/stereo_sequence.h"

namespace arfm_vo {

/// A program NAME INPUT [options] that takes a recording through
/// VisualOdometry.
struct OdometryProgram {
  std::string name;
  std::string description;                              ///< what --help says under the usage line
  std::string input_name;                               ///< in the usage line, such as SEQUENCE_DIR
  boost::program_options::options_description options;  ///< of this program alone
  std::function<std::unique_ptr<StereoSequence>(const std::string& input, const PairSelection&)>
      open;
};

/// The whole of its main(), as RunProgram. Takes --config, --print-config,
/// --pairs, --stride,
/// --output and `program.options`; prints the run's lines `key: value` on
/// stdout.
int RunOdometryProgram(int argc, const char* const* argv, const OdometryProgram& program);

}  // namespace arfm_vo
