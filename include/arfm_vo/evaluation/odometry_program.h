#pragma once

#include <functional>
#include <memory>
#include <string>

#include "arfm_vo/configuration/program.h"
#include "arfm_vo/datasets/stereo_sequence.h"

namespace arfm_vo {

using OpenSequence =
    std::function<std::unique_ptr<StereoSequence>(const std::string& input, const PairSelection&)>;

/// The whole of the main() of a program NAME INPUT [options] that takes a recording through
/// VisualOdometry, as RunProgram. `program` has its name, description and own options, to which
/// --config, --pairs, --output and others come; `input_name` is that of INPUT in the usage line.
/// Prints the run's lines `key: value`.
int RunOdometryProgram(int argc, const char* const* argv, Program program,
                       const std::string& input_name, const OpenSequence& open);

}  // namespace arfm_vo
