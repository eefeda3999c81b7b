#include "arfm_vo/evaluation/run_files.h"

#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/evaluation/run_report.h"
#include "arfm_vo/evaluation/trajectory_plot.h"
#include "arfm_vo/odometry/trajectory_files.h"

namespace arfm_vo {
namespace {

namespace fs = std::filesystem;

/// Fills `folder`; returns why there is no picture, if so.
std::string WriteFiles(const OdometryRun& run, const fs::path& folder) {
  WriteWholeFile(folder / "poses.txt", FormatKitti(run.trajectory));
  WriteWholeFile(folder / "tracked.txt", FormatTracked(run.trajectory));
  WriteWholeFile(folder / "poses_online.txt", FormatKitti(run.online));
  WriteWholeFile(folder / "trajectory.tum", FormatTum(run.trajectory));
  WriteWholeFile(folder / "timing.csv", FormatTiming(run));
  const PathComparison comparison = CompareWithTruth(run, run.trajectory);
  try {
    PlotTrajectory({comparison.estimate, comparison.is_tracked, comparison.truth},
                   folder / "trajectory.png");
  } catch (const std::runtime_error& error) {
    return std::string("no trajectory.png: ") + error.what();
  }
  return "";
}

}  // namespace

void CheckCanWriteRun(const std::string& folder) {
  fs::path existing = fs::absolute(folder);
  while (!fs::exists(existing)) existing = existing.parent_path();
  int error = fs::is_directory(existing) ? 0 : ENOTDIR;
  if (error == 0 && access(existing.c_str(), W_OK) != 0) error = errno;
  if (error != 0) {
    throw std::system_error(error, std::generic_category(), folder + ": cannot be written");
  }
}

std::string WriteRun(const OdometryRun& run, const std::string& folder) {
  const bool was_there = fs::exists(folder);
  const fs::path partial = fs::path(folder) / (".partial." + std::to_string(getpid()));
  try {
    fs::create_directories(partial);
    const std::string complaint = WriteFiles(run, partial);
    if (!complaint.empty()) fs::remove(fs::path(folder) / "trajectory.png");  // of another run
    for (const auto& entry : fs::directory_iterator(partial)) {
      fs::rename(entry.path(), fs::path(folder) / entry.path().filename());
    }
    fs::remove(partial);
    return complaint;
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(was_there ? partial : fs::path(folder), ignored);
    throw;
  }
}

}  // namespace arfm_vo
