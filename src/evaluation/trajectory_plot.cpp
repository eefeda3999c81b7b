#include "arfm_vo/evaluation/trajectory_plot.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "arfm_vo/base/number_rows.h"
#include "arfm_vo/odometry/kitti_metric.h"
#include "arfm_vo/odometry/trajectory_error.h"

namespace arfm_vo {
namespace {

/// `text` between single quotes as gnuplot reads them.
std::string Quote(const std::string& text) {
  std::string quoted = "'";
  for (const char letter : text) quoted += letter == '\'' ? "''" : std::string(1, letter);
  return quoted + "'";
}

/// `set xrange` and `set yrange` to a square, seen from above, that holds all paths and 5 % more.
std::string FormatSquareRange(const std::vector<Rigid3>& path, const std::vector<Rigid3>& other) {
  Eigen::AlignedBox2d box;
  for (const auto* poses : {&path, &other}) {
    for (const Rigid3& pose : *poses)
      box.extend(Eigen::Vector2d(pose.translation.x(), pose.translation.z()));
  }
  const double half_side = std::max(0.55 * box.sizes().maxCoeff(), 0.1);
  std::string text;
  for (const int axis : {0, 1}) {
    text += std::string("set ") + (axis ? "y" : "x") + "range [" +
            FormatNumber(box.center()[axis] - half_side) + ":" +
            FormatNumber(box.center()[axis] + half_side) + "]\n";
  }
  return text;
}

/// A gnuplot data block of positions seen from above: x right, z forward, and z again but for those
/// that are interpolated.
std::string FormatBlock(const std::string& name, const std::vector<Rigid3>& path,
                        const std::vector<bool>& is_tracked = {}) {
  std::string block = "$" + name + " << END\n";
  for (size_t i = 0; i < path.size(); ++i) {
    const std::string z = FormatNumber(path[i].translation.z());
    const bool is_solid = is_tracked.empty() || is_tracked[i];
    block += FormatNumber(path[i].translation.x()) + " " + z + " " + (is_solid ? z : "NaN") + "\n";
  }
  return block + "END\n";
}

std::string FormatErrorBlock(const std::vector<Rigid3>& estimate,
                             const std::vector<Rigid3>& truth) {
  const std::vector<double> distances = ComputeDistances(truth);
  std::string block = "$error << END\n";
  for (size_t i = 0; i < truth.size(); ++i) {
    const double error_m = (estimate[i].translation - truth[i].translation).norm();
    block += FormatNumber(distances[i]) + " " + FormatNumber(error_m) + "\n";
  }
  return block + "END\n";
}

}  // namespace

std::string WritePlotScript(const PlottedPath& path, const std::string& png_path) {
  const std::vector<Rigid3> estimate = RebaseToFirst(path.estimate);
  const std::vector<Rigid3> truth =
      path.truth.empty() ? std::vector<Rigid3>() : RebaseToFirst(path.truth);
  const std::string script = "set terminal pngcairo size 1400,700 font ',12'\nset output " +
                             Quote(png_path) + "\nset grid\nset key top left\n" +
                             FormatBlock("estimate", estimate, path.is_tracked);
  std::string from_above = FormatSquareRange(estimate, truth) +
                           "set size square\nset title 'From above'\nset xlabel 'x right, m'\n"
                           "set ylabel 'z forward, m'\nplot ";
  if (!truth.empty()) from_above += "$truth with lines lw 5 lc rgb '#f0b0b0' title 'truth', ";
  from_above += "$estimate using 1:3 with lines lw 2 lc rgb '#1f77b4' title 'estimate'";
  if (std::count(path.is_tracked.begin(), path.is_tracked.end(), false) > 0)
    from_above += ", $estimate with lines dt 2 lw 2 lc rgb '#1f77b4' title 'lost: interpolated'";
  if (truth.empty()) return script + from_above + "\n";
  return script + FormatBlock("truth", truth) + FormatErrorBlock(estimate, truth) +
         "set multiplot layout 1,2\n" + from_above +
         "\nset size nosquare\nset autoscale\nset title 'Error of the position'\n"
         "set xlabel 'distance driven, m'\nset ylabel 'error, m'\nset yrange [0:*]\n"
         "plot $error with lines lw 2 lc rgb '#2ca02c' notitle\nunset multiplot\n";
}

void PlotTrajectory(const PlottedPath& path, const std::string& png_path) {
  if (path.estimate.empty()) throw std::runtime_error("nothing to draw");
  const std::string script = WritePlotScript(path, png_path);
  const auto old_handler = std::signal(SIGPIPE, SIG_IGN);  // gnuplot may be missing or fail early
  FILE* gnuplot = popen("gnuplot >/dev/null 2>&1", "w");
  if (gnuplot) std::fwrite(script.data(), 1, script.size(), gnuplot);
  const int status = gnuplot ? pclose(gnuplot) : -1;
  std::signal(SIGPIPE, old_handler);
  if (status == 127 << 8) throw std::runtime_error("gnuplot is not installed");
  std::error_code ignored;
  if (status != 0 || std::filesystem::file_size(png_path, ignored) + 1 <= 1) {
    std::filesystem::remove(png_path, ignored);
    throw std::runtime_error("gnuplot failed to draw " + png_path);
  }
}

}  // namespace arfm_vo
