#pragma once

#include <memory>
#include <string>
#include <vector>

#include "recordings/clip.h"
#include "recordings/drive_plan.h"
#include "recordings/picture_plan.h"
#include "recordings/shared_view.h"

namespace arfm_vo {

enum class Kind { kReal, kRendered };

/// What a seed determines: the recording and everything that is done to it.
struct RecordingPlan {
  uint32_t seed = 0;
  Kind kind = Kind::kReal;
  ClipPlan clip;    ///< where kReal
  DrivePlan drive;  ///< where kRendered
  LightPlan light;
  FaultPlan fault;

  /// Standard deviation of what sensor and LightPlan put in; that of real cameras is not counted.
  double NoiseGreyLevels() const;
  int num_pairs() const { return kind == Kind::kReal ? clip.num_pairs : drive.num_pairs; }
};

/// Known without drawing the rest. A third of the recordings is rendered; all are where there are
/// no clips.
Kind KindOfSeed(uint32_t seed);
/// The half of the seeds that thresholds may be chosen on; the other is for judging.
bool IsForTuning(uint32_t seed);
RecordingPlan DrawRecording(uint32_t seed, const std::vector<Clip>& clips, int max_pairs);

/// Name and value of each property of a recording, always the same names.
using Properties = std::vector<std::pair<std::string, std::string>>;
Properties DescribeRecording(const RecordingPlan& plan, const std::vector<Clip>& clips,
                             const StereoCamera& camera);

/// The recording's pairs with fault, light and noise in them, and beside them those without.
class Recording {
 public:
  Recording(const RecordingPlan& plan, std::unique_ptr<PairSource> source);

  struct Pair {
    TruePair clean;       ///< without fault, light and noise
    StereoImages images;  ///< as the odometry gets them
    ShownPicture shown;   ///< the left image with fault and light, without the noise put in
  };
  const PairSource& source() const { return *source_; }
  const RecordingPlan& plan() const { return plan_; }
  /// One after the other, from 0.
  Pair Take(int pair);

 private:
  RecordingPlan plan_;
  std::unique_ptr<PairSource> source_;
  PairChange fault_, light_, noise_;
};

}  // namespace arfm_vo
