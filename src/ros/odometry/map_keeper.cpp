#include "arfm_vo/ros/odometry/map_keeper.h"

#include <ros/console.h>

#include <utility>

#include "arfm_vo/mapping/map_file.h"

namespace arfm_vo {
namespace {

namespace fs = std::filesystem;

const char* ToString(MapState state) {
  constexpr const char* kNames[] = {"NEW_MAP", "LOCALISING", "LOCALISED"};
  return kNames[static_cast<size_t>(state)];
}

size_t NumKeyframes(const PlacedMap& map) {
  return map.localiser().keyframes().size() + static_cast<size_t>(map.num_keyframes());
}

}  // namespace

MapKeeper::MapKeeper(const MapKeeperOptions& options, const std::string& map_frame)
    : options_(options), map_frame_(map_frame), path_(options.map_file) {
  options_.Check();
  if (!is_enabled() || !fs::exists(path_)) return;
  try {
    written_ = fs::last_write_time(path_);
    known_ = ReadMap(path_);
  } catch (const std::exception& error) {
    Refuse(error);
  }
}

void MapKeeper::Refuse(const std::exception& error) {
  known_.reset();
  const std::string why = error.what();
  GoBeside(why.find(path_.string()) == 0 ? why : path_.string() + ": " + why);
}

void MapKeeper::GoBeside(const std::string& why) {
  const fs::path first(options_.map_file);
  for (int i = 2; fs::exists(path_); ++i)
    path_ = first.parent_path() /
            (first.stem().string() + "_" + std::to_string(i) + first.extension().string());
  written_.reset();
  refused_ = why;
  ROS_ERROR("%s; it stays as it is, and this drive's map goes to %s", why.c_str(), path_.c_str());
}

void MapKeeper::LoadFor(const StereoCamera& camera, PlacedMap& map) {
  if (!is_enabled() || std::exchange(has_begun_, true)) return;
  try {
    if (known_) CheckSameCamera(*known_, camera);
  } catch (const std::exception& error) {
    Refuse(error);
  }
  map.Keep(known_ ? std::move(*known_) : KnownMap(), MaxPoints(max_bytes()));
  known_.reset();
  num_saved_ = NumKeyframes(map);
}

std::string MapKeeper::Save(const PlacedMap& map) {
  Require(is_enabled(), "map_file is not set");
  Require(has_begun_, "no keyframe has come yet");
  KnownMap known = map.MakeKnownMap();
  Require(!known.keyframes.empty(), "nothing was seen yet by which a place could be found again");
  known.frame_id = map_frame_;
  std::error_code none;
  const auto written = fs::last_write_time(path_, none);
  if (!none && written_ != written) GoBeside(path_.string() + ": another program has written it");
  saved_ = ros::WallTime::now();
  const size_t num_keyframes = known.keyframes.size();
  WriteMap(path_, std::move(known), max_bytes());
  written_ = fs::last_write_time(path_);
  num_saved_ = NumKeyframes(map);
  return path_.string() + ": " + std::to_string(num_keyframes) + " keyframes, " +
         std::to_string(fs::file_size(path_) / 1000) + " kB";
}

void MapKeeper::SaveIfDue(const PlacedMap& map) {
  const bool is_due = (ros::WallTime::now() - saved_).toSec() >= options_.map_save_interval_s;
  if (!is_enabled() || !is_due || NumKeyframes(map) == num_saved_) return;
  saved_ = ros::WallTime::now();
  try {
    Save(map);
  } catch (const std::exception& error) {
    ROS_WARN_THROTTLE(600, "the map is not saved: %s", error.what());
  }
}

std::optional<MapStatus> MapKeeper::News(const PlacedMap& map, const ros::Time& stamp) {
  MapStatus status;
  status.header.stamp = stamp;
  status.header.frame_id = map_frame_;
  status.state = static_cast<uint8_t>(map.localiser().state());
  status.state_text = ToString(map.localiser().state());
  status.text = map.news().empty() ? refused_ : map.news();
  const std::string told = status.state_text + (status.text.empty() ? "" : ": " + status.text);
  if (told == told_.Get()) return std::nullopt;
  told_.Set(told);
  if (is_enabled() || !status.text.empty()) ROS_INFO("map: %s", told.c_str());
  return status;
}

}  // namespace arfm_vo
