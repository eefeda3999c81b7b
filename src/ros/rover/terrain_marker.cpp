#include <algorithm>
#include <utility>

#include "arfm_vo/ros/messages/conversions.h"
#include "arfm_vo/ros/rover/simulator_node.h"

namespace arfm_vo {
namespace {

constexpr double kHalfSide_m = 30, kCell_m = 0.5;
constexpr double kSunk_m = 0.05;  // what lies on the ground stays visible

}  // namespace

visualization_msgs::Marker MakeTerrainMarker(const Terrain& terrain, const Rigid3& map_from_world,
                                             const std::string& frame) {
  visualization_msgs::Marker marker;
  marker.header.frame_id = frame;
  marker.ns = "terrain";
  marker.type = visualization_msgs::Marker::TRIANGLE_LIST;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose = ToPoseMessage(map_from_world);
  marker.scale.x = marker.scale.y = marker.scale.z = 1;
  marker.color.a = 1;
  const auto add = [&](double x, double y) {
    marker.points.emplace_back();
    marker.points.back().x = x;
    marker.points.back().y = y;
    marker.points.back().z = terrain.Height(x, y) - kSunk_m;
    const float light = static_cast<float>(std::clamp(terrain.Sunlight(x, y), 0.0, 2.0));
    marker.colors.emplace_back();
    marker.colors.back().r = 0.15f + 0.20f * light;
    marker.colors.back().g = 0.11f + 0.15f * light;
    marker.colors.back().b = 0.08f + 0.11f * light;
    marker.colors.back().a = 1;
  };
  const int num_cells = static_cast<int>(2 * kHalfSide_m / kCell_m);
  for (int i = 0; i < num_cells * num_cells; ++i) {
    const int column = i % num_cells, row = i / num_cells;
    const double x = -kHalfSide_m + kCell_m * column, y = -kHalfSide_m + kCell_m * row;
    for (const auto& [right, up] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}})
      add(x + right * kCell_m, y + up * kCell_m);
  }
  return marker;
}

}  // namespace arfm_vo
