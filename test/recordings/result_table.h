#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "recordings/judged_run.h"
#include "recordings/recording_plan.h"

namespace arfm_vo {

/// recordings.csv: a line a recording, appended as soon as it is judged.
class ResultTable {
 public:
  /// Reads the seeds of `path` where that is there; what a run that was killed left of a line goes.
  /// Throws std::invalid_argument where its columns are others.
  explicit ResultTable(const std::string& path);

  bool Has(uint32_t seed) const { return seeds_.count(seed) > 0; }
  void Append(const RecordingPlan& plan, const Properties& properties, const JudgedRun& run,
              double seconds);

 private:
  std::string path_;
  std::set<uint32_t> seeds_;
};

/// The columns' names, with commas. Properties come first; then, of the judged pairs, the counts:
/// `tracked`, `degraded`, `lost` and `wrong` are of the `trackable` ones, `other_*` of the rest.
std::string ResultHeader(const Properties& properties);
std::string FormatResult(uint32_t seed, const Properties& properties, const JudgedRun& run,
                         double seconds);

}  // namespace arfm_vo
