#include "recordings/result_table.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/whole_file.h"

namespace arfm_vo {
namespace {

struct Counts {
  int pairs = 0, judged = 0, trackable = 0, tracked = 0, degraded = 0, lost = 0, wrong = 0;
  int other = 0, other_tracked = 0, other_wrong = 0;
  double worst = 0;  ///< error over sigma of a tracked pair
  double nees_sum = 0, sigma2_sum = 0, error2_sum = 0;
  int nees_pairs = 0;
};

void Count(const JudgedPair& pair, Counts& counts) {
  const bool is_tracked = pair.state == Outcome::kTracked;
  ++counts.judged;
  if (pair.can_be_tracked) {
    ++counts.trackable;
    counts.tracked += is_tracked;
    counts.degraded += pair.state == Outcome::kDegraded;
    counts.lost += pair.state == Outcome::kLost;
    counts.wrong += pair.is_wrong;
  } else {
    ++counts.other;
    counts.other_tracked += is_tracked;
    counts.other_wrong += pair.is_wrong;
  }
  if (!is_tracked) return;
  if (pair.is_wrong) counts.worst = std::max(counts.worst, pair.error_m / pair.sigma_m);
  counts.sigma2_sum += pair.sigma_m * pair.sigma_m;
  counts.error2_sum += pair.start_error_m * pair.start_error_m;
  if (!std::isfinite(pair.nees)) return;
  counts.nees_sum += pair.nees;
  ++counts.nees_pairs;
}

const char* const kCountNames =
    "pairs,judged,trackable,tracked,degraded,lost,wrong,other,other_tracked,other_wrong,"
    "worst_sigmas,nees_sum,nees_pairs,sigma2_sum,error2_sum,length_ratio,end_error_percent,path_m,"
    "seconds";

}  // namespace

std::string ResultHeader(const Properties& properties) {
  std::string header = "seed";
  for (const auto& [name, value] : properties) header += "," + name;
  return header + "," + kCountNames;
}

std::string FormatResult(uint32_t seed, const Properties& properties, const JudgedRun& run,
                         double seconds) {
  Counts counts;
  counts.pairs = static_cast<int>(run.pairs.size());
  for (const JudgedPair& pair : run.pairs) {
    if (pair.is_judged) Count(pair, counts);
  }
  std::ostringstream line;
  line << seed;
  for (const auto& [name, value] : properties) line << ',' << value;
  line << ',' << counts.pairs << ',' << counts.judged << ',' << counts.trackable << ','
       << counts.tracked << ',' << counts.degraded << ',' << counts.lost << ',' << counts.wrong
       << ',' << counts.other << ',' << counts.other_tracked << ',' << counts.other_wrong << ','
       << counts.worst << ',' << counts.nees_sum << ',' << counts.nees_pairs << ','
       << counts.sigma2_sum << ',' << counts.error2_sum << ',' << run.length_ratio << ','
       << run.end_error_percent << ',' << run.path_m << ',' << seconds;
  return line.str();
}

ResultTable::ResultTable(const std::string& path) : path_(path) {
  if (!std::filesystem::exists(path)) return;
  std::string content = ReadWholeFile(path);
  const size_t end = content.rfind('\n');
  content.resize(end == std::string::npos ? 0 : end + 1);
  WriteWholeFile(path, content);
  std::istringstream lines(content);
  std::string line;
  std::getline(lines, line);
  Require(line.empty() || line.find(kCountNames) != std::string::npos,
          path + ": has other columns than this program writes");
  while (std::getline(lines, line)) seeds_.insert(static_cast<uint32_t>(std::stoul(line)));
}

void ResultTable::Append(uint32_t seed, const Properties& properties, const std::string& line) {
  const bool is_new = !std::filesystem::exists(path_) || std::filesystem::file_size(path_) == 0;
  std::ofstream file(path_, std::ios::app);
  if (is_new) file << ResultHeader(properties) << '\n';
  file << line << '\n' << std::flush;
  Require(file.good(), path_ + ": cannot be written");
  seeds_.insert(seed);
}

}  // namespace arfm_vo
