#include "arfm_vo/ros/display/bounded_path.h"

#include <cmath>

namespace arfm_vo {

void BoundedPath::Clear() {
  path_.poses.clear();
  spacing_m_ = options_.spacing_m;
}

bool BoundedPath::Add(const std_msgs::Header& header, const geometry_msgs::Pose& pose) {
  std::vector<geometry_msgs::PoseStamped>& poses = path_.poses;
  if (!poses.empty()) {
    const geometry_msgs::Point &last = poses.back().pose.position, &next = pose.position;
    if (std::hypot(next.x - last.x, next.y - last.y, next.z - last.z) < spacing_m_) return false;
  }
  if (static_cast<int>(poses.size()) >= options_.max_poses) {
    size_t kept = 0;
    for (size_t i = 0; i < poses.size(); i += 2) poses[kept++] = poses[i];
    poses.resize(kept);
    spacing_m_ *= 2;
  }
  path_.header = header;
  poses.emplace_back();
  poses.back().header = header;
  poses.back().pose = pose;
  return true;
}

}  // namespace arfm_vo
