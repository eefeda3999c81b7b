#pragma once

#include <string>
#include <vector>

#include "arfm_vo/odometry/visual_odometry.h"
#include "recordings/draw.h"
#include "recordings/pair_source.h"
#include "recordings/view_transform.h"

namespace arfm_vo {

/// A real recording and how well the truth of it is known.
struct Clip {
  std::string name, folder;
  std::string motion, scene;  ///< properties
  bool has_truth = false;     ///< poses.txt; else the odometry's own, see ReadClipTruth
  double truth_percent = 1;   ///< of the way by which the truth may be off
  double truth_m = 0;         ///< and beside that
  int num_pairs = 0;
  StereoCamera camera;
};

/// Those of the known clips that are below `data` (../shared/data).
std::vector<Clip> FindClips(const std::string& data);

/// What is taken of a clip: a window of its pairs, and how it is changed.
struct ClipPlan {
  int clip = 0;  ///< index
  int first = 0, num_pairs = 0, stride = 1;
  bool is_backward = false;
  ViewTransform transform;
};

/// `max_pairs` bounds the window.
ClipPlan DrawClipPlan(const std::vector<Clip>& clips, int max_pairs, Draw& draw);

/// world_from_left of every pair of a clip. Beside it stands a reference: the poses that the
/// odometry has after the whole clip, otherwise unchanged and at stride 1, computed once and kept
/// in `cache_folder`. They are the truth where a clip has no poses.txt. Where it has one, its
/// places are taken with the reference's directions, turned all alike: KITTI's own directions are
/// off by up to 0.8 degrees, which makes an error of 1.4 % of the way of an odometry that begins
/// with them.
std::vector<Rigid3> ReadClipTruth(const Clip& clip, const OdometryOptions& options,
                                  const std::string& cache_folder);

/// The window of a clip, changed as planned, in memory. Depth is that of block matching.
class ClipWindow : public PairSource {
 public:
  ClipWindow(const Clip& clip, const ClipPlan& plan, const std::vector<Rigid3>& truth);

  const StereoCamera& camera() const override { return camera_; }
  int size() const override { return static_cast<int>(pairs_.size()); }
  const Rigid3& WorldFromLeft(int pair) const override { return world_from_left_.at(pair); }
  TruePair Take(int pair) const override;
  const StereoImages& Images(int pair) const { return pairs_.at(pair); }

 private:
  StereoCamera camera_;
  std::vector<StereoImages> pairs_;
  std::vector<Rigid3> world_from_left_;
};

}  // namespace arfm_vo
