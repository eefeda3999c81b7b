#pragma once

#include <arfm_vo/MapStatus.h>
#include <ros/time.h>

#include <filesystem>
#include <optional>
#include <string>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/base/range_check.h"
#include "arfm_vo/base/worker.h"
#include "arfm_vo/odometry/placed_map.h"

namespace arfm_vo {

struct MapKeeperOptions {
  /// Where the map is kept: read before the first keyframe where there is one, written at the end
  /// and on the way; empty: no map is kept.
  std::string map_file;
  double map_max_mb = 200;  ///< of the file, at least 0.1: what others show too is left out first
  double map_save_interval_s = 60;  ///< while keyframes come

  void Check() const {
    RequireInRange(map_max_mb, 0.1, 100000, "map_max_mb");
    Require(map_save_interval_s > 0, "map_save_interval_s must be positive");
  }
  ARFM_FIELDS(map_file, map_max_mb, map_save_interval_s)
};

/// The file of ba_node's map, and what ba_node says of it. A file that is refused, or that another
/// program has written meanwhile, is left as it is: the drive's map then goes beside it (map_2.bin
/// for map.bin).
class MapKeeper {
 public:
  /// Reads the file where there is one.
  MapKeeper(const MapKeeperOptions& options, const std::string& map_frame);

  /// Gives the file's map to `map`, once, before the first keyframe, which is of this camera. From
  /// then on the state is known.
  void LoadFor(const StereoCamera& camera, PlacedMap& map);
  /// Returns what was written, in words. Throws std::invalid_argument where there is nothing to
  /// write, std::system_error naming the file where it cannot be written.
  std::string Save(const PlacedMap& map);
  /// Saves where keyframes came since the last time and that is long enough ago.
  void SaveIfDue(const PlacedMap& map);
  bool is_enabled() const { return !options_.map_file.empty(); }
  /// What there is to say, where that has changed.
  std::optional<MapStatus> News(const PlacedMap& map, const ros::Time& stamp);
  std::string told() const { return told_.Get(); }  ///< by News; from any thread

 private:
  size_t max_bytes() const { return static_cast<size_t>(1e6 * options_.map_max_mb); }
  void Refuse(const std::exception& error);
  void GoBeside(const std::string& why);

  MapKeeperOptions options_;
  std::string map_frame_, refused_;
  Shared<std::string> told_;
  std::optional<KnownMap> known_;  ///< the file's, until it is handed on
  std::filesystem::path path_;
  std::optional<std::filesystem::file_time_type> written_;  ///< the file, when it was ours
  bool has_begun_ = false;                                  ///< a keyframe has come
  size_t num_saved_ = 0;                                    ///< keyframes
  ros::WallTime saved_ = ros::WallTime::now();
};

}  // namespace arfm_vo
