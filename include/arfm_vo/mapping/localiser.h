#pragma once

#include <optional>
#include <string>
#include <vector>

#include "arfm_vo/mapping/place_finder.h"

namespace arfm_vo {

/// Whether the newest epoch lies in the frame of what was known before it.
enum class MapState { kNewMap, kLocalising, kLocalised };

/// Where a person states that the rover stands.
struct StatedPose {
  Rigid3 map_from_base, odom_from_base;
  Eigen::Matrix3d covariance;  ///< of x and y (m) and the heading (rad); zero: not known
};

/// The epochs that are over, of this drive and those before, and in which of their frames the
/// newest epoch lies. Unless the map is kept all lie in one. Of a map that is kept each epoch has a
/// frame of its own until it is found in an older one (PlaceFinder); frames that meet become the
/// older one.
class Localiser {
 public:
  /// Keeps at most `max_points` points (at least 1) for later epochs and drives; `known` is what
  /// there is already.
  void Keep(KnownMap known, size_t max_points);
  bool is_kept() const { return max_points_ > 0; }

  /// An epoch is over, and the next begins.
  void Close(std::vector<KnownKeyframe> epoch, const StereoCamera& camera);
  /// Looks for the newest epoch's next view in older frames. Returns how the map frame moves,
  /// new_from_old, where the epoch came to lie in an older one.
  std::optional<Rigid3> Localise(const std::vector<SeenPoint>& view, const Rigid3& odom_from_camera,
                                 const Rigid3& map_from_odom);
  /// Whether there is what Localise could find with this camera.
  bool MayLocalise(const StereoCamera& camera) const {
    return camera == map_.camera && KnowsOtherFrames();
  }
  /// A person states where the rover stands, which is `new_from_old` from where it was believed to
  /// be. All in the map frame moves; of a map that is kept the newest epoch alone, which is looked
  /// for anew. A place that contradicts the statement is not taken.
  void Move(const Rigid3& new_from_old, const StatedPose& stated);

  MapState state() const;
  /// What was found last, in words.
  const std::string& found() const { return found_; }
  int own_frame() const { return own_frame_; }  ///< of the newest epoch
  const std::vector<KnownKeyframe>& keyframes() const { return map_.keyframes; }
  /// Of this drive are the keyframes from this one on.
  size_t first_of_drive() const { return first_of_drive_; }
  /// All that is known with the newest epoch, of which this is known so far.
  KnownMap WithNewest(std::vector<KnownKeyframe> epoch, const StereoCamera& camera) const;

 private:
  void BeginEpoch();
  bool KnowsOtherFrames() const;
  bool Contradicts(const Rigid3& map_from_odom) const;
  void MoveFrame(int from, int to, const Rigid3& to_from_from);

  size_t max_points_ = 0;
  KnownMap map_;
  size_t first_of_drive_ = 0;
  std::optional<PlaceFinder> finder_;  ///< in map_
  int own_frame_ = 0;
  bool is_localised_ = false;
  std::optional<StatedPose> stated_;
  std::string found_;
};

}  // namespace arfm_vo
