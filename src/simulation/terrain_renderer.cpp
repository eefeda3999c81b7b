#include "arfm_vo/simulation/terrain_renderer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arfm_vo/base/range_check.h"
#include "arfm_vo/simulation/parallel_rows.h"
#include "arfm_vo/simulation/view_solids.h"

namespace arfm_vo {
namespace {

constexpr double kNoDepth = std::numeric_limits<double>::infinity();
constexpr double kFarthest = 12000;    ///< m
constexpr double kHaze_m = 4000;       ///< over which the air takes 63 % of the contrast
constexpr double kShadowLift = 2e-4;   ///< m, off a surface, so that it does not shade itself
constexpr double kSkyRadiance = 0.62;  ///< at the horizon
constexpr int kSky = -1, kGround = 0, kFirstSolid = 16;
constexpr double kEdgeBend = 0.02;  ///< relative bend of the inverse depth that makes an edge

/// What one ray of sight meets.
struct Sight {
  double depth = kNoDepth;
  double radiance = 0;
  int surface = kSky;  ///< differs between neighbours where there is an edge
};

/// One camera's rays through one terrain.
class Tracer {
 public:
  Tracer(const Terrain& terrain, const RenderOptions& options, const StereoCamera& camera,
         const Rigid3& world_from_camera, const std::vector<Solid>& bodies)
      : terrain_(terrain),
        options_(options),
        camera_(camera),
        bodies_(bodies),
        origin_(world_from_camera.translation),
        world_from_camera_(world_from_camera.RotationMatrix()),
        solids_(camera, world_from_camera, terrain.rocks(), bodies) {}

  /// Along the ray through (u, v); the texture's mean is taken over `pixel_share` of a pixel.
  Sight Look(double u, double v, double pixel_share) const {
    const Ray ray{origin_, world_from_camera_ * Eigen::Vector3d((u - camera_.cx) / camera_.fx,
                                                                (v - camera_.cy) / camera_.fy, 1)};
    const double ground = terrain_.Intersect(ray, 0, kFarthest);
    const ViewSolids::Hit hit = solids_.Intersect(ray, u, v, std::min(ground, kFarthest));
    Sight sight;
    if (hit.solid != nullptr) {
      sight = SeeSolid(ray, hit, pixel_share);
    } else if (ground <= kFarthest) {
      sight = SeeGround(ray, ground, pixel_share);
    } else {
      sight.radiance = SkyRadiance(ray.direction);
      return sight;
    }
    const double haze = 1 - std::exp(-sight.depth / kHaze_m);
    sight.radiance += haze * (kSkyRadiance - sight.radiance);
    return sight;
  }

 private:
  double SkyRadiance(const Eigen::Vector3d& direction) const {
    const double height = std::max(0.0, direction.z() / direction.norm());
    return kSkyRadiance * (1 - 0.35 * std::sqrt(height));
  }

  bool IsShadowed(const Eigen::Vector3d& point) const {
    if (terrain_.rocks().IsShadowed(point)) return true;
    return std::any_of(bodies_.begin(), bodies_.end(), [&](const Solid& body) {
      return body.Blocks({point, terrain_.to_sun()});
    });
  }

  /// The steps on the surface of normal `normal` that one step to the right and one down on the
  /// image make: x = o + z d with n . dx = 0.
  void ProjectPixel(const Ray& ray, double depth, const Eigen::Vector3d& normal, double share,
                    Eigen::Vector3d& along_u, Eigen::Vector3d& along_v) const {
    const double facing = normal.dot(ray.direction);
    const double slant = std::min(facing, -1e-4 * ray.direction.norm());
    const Eigen::Vector3d step_u = world_from_camera_.col(0) / camera_.fx;
    const Eigen::Vector3d step_v = world_from_camera_.col(1) / camera_.fy;
    along_u = share * depth * (step_u - ray.direction * (normal.dot(step_u) / slant));
    along_v = share * depth * (step_v - ray.direction * (normal.dot(step_v) / slant));
  }

  Sight SeeGround(const Ray& ray, double depth, double share) const {
    const Eigen::Vector3d point = ray.origin + depth * ray.direction;
    const Eigen::Vector3d normal = terrain_.Normal(point.x(), point.y());
    Eigen::Vector3d along_u, along_v;
    ProjectPixel(ray, depth, normal, share, along_u, along_v);
    const double albedo =
        terrain_.GroundAlbedo({point.head<2>(), along_u.head<2>(), along_v.head<2>()});
    double sunlight = terrain_.Sunlight(point.x(), point.y());
    Sight sight{depth, 0, kGround};
    if (sunlight > 0 && IsShadowed(point + kShadowLift * Eigen::Vector3d::UnitZ())) {
      sunlight = 0;
      sight.surface = kGround + 1;
    }
    sight.radiance = albedo * (options_.skylight + (1 - options_.skylight) * sunlight);
    return sight;
  }

  Sight SeeSolid(const Ray& ray, const ViewSolids::Hit& hit, double share) const {
    const Solid& solid = *hit.solid;
    const double depth = hit.where.parameter;
    const Eigen::Vector3d& normal = hit.where.normal;
    const Eigen::Vector3d point = ray.origin + depth * ray.direction;
    Eigen::Vector3d along_u, along_v;
    ProjectPixel(ray, depth, normal, share, along_u, along_v);
    // The texture lies on the body's coordinate plane that faces the normal most.
    int main_axis;
    (solid.body_from_world * normal).cwiseAbs().maxCoeff(&main_axis);
    const int first = (main_axis + 1) % 3, second = (main_axis + 2) % 3;
    const auto on_plane = [&](const Eigen::Vector3d& x_in_world) {
      const Eigen::Vector3d x = solid.body_from_world * x_in_world;
      return Eigen::Vector2d(x[first], x[second]);
    };
    const double albedo = terrain_.SolidAlbedo(
        solid, {on_plane(point - solid.center), on_plane(along_u), on_plane(along_v)});
    const double facing_sun = normal.dot(terrain_.to_sun());
    const bool is_shadowed = facing_sun <= 0 || IsShadowed(point + kShadowLift * normal) ||
                             terrain_.Sunlight(solid.center.x(), solid.center.y()) <= 0;
    Sight sight{depth, 0, kFirstSolid + hit.index * 64 + 2 * hit.where.face + is_shadowed};
    const double sunlight = is_shadowed ? 0 : facing_sun / terrain_.to_sun().z();
    const double skylight = options_.skylight * (0.7 + 0.3 * normal.z());
    sight.radiance = albedo * (skylight + (1 - options_.skylight) * std::min(sunlight, 2.5));
    return sight;
  }

  const Terrain& terrain_;
  const RenderOptions& options_;
  const StereoCamera& camera_;
  const std::vector<Solid>& bodies_;
  Eigen::Vector3d origin_;
  Eigen::Matrix3d world_from_camera_;
  ViewSolids solids_;
};

/// Whether the surface changes, or its inverse depth (linear on a plane) bends, at a pixel.
bool IsEdge(const cv::Mat& surface, const cv::Mat& depth, int u, int v) {
  const int here = surface.at<int>(v, u);
  const auto differs = [&](int du, int dv) {
    const int x = std::clamp(u + du, 0, surface.cols - 1);
    const int y = std::clamp(v + dv, 0, surface.rows - 1);
    return surface.at<int>(y, x) != here;
  };
  if (differs(-1, 0) || differs(1, 0) || differs(0, -1) || differs(0, 1)) return true;
  if (here == kSky) return false;
  const auto inverse = [&](int x, int y) { return 1.0f / depth.at<float>(y, x); };
  const float center = inverse(u, v);
  const auto bends = [&](float before, float after) {
    return std::abs(before + after - 2 * center) > kEdgeBend * center;
  };
  return (u > 0 && u + 1 < depth.cols && bends(inverse(u - 1, v), inverse(u + 1, v))) ||
         (v > 0 && v + 1 < depth.rows && bends(inverse(u, v - 1), inverse(u, v + 1)));
}

/// The mean radiance of samples x samples rays through a pixel.
double Supersample(const Tracer& tracer, int u, int v, int samples) {
  double sum = 0;
  for (int i = 0; i < samples; ++i) {
    for (int j = 0; j < samples; ++j) {
      const double du = (i + 0.5) / samples - 0.5, dv = (j + 0.5) / samples - 0.5;
      sum += tracer.Look(u + du, v + dv, 1.0 / samples).radiance;
    }
  }
  return sum / (samples * samples);
}

}  // namespace

void RenderOptions::Check() const {
  Require(num_threads >= 1, "render.num_threads must be at least 1");
  RequireInRange(edge_samples, 1, 8, "render.edge_samples");
  RequireInRange(skylight, 0, 1, "render.skylight");
  sensor.Check();
}

Rigid3 RightCameraPose(const StereoCamera& camera, const Rigid3& world_from_left) {
  return world_from_left *
         Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(camera.baseline_m, 0, 0));
}

TerrainRenderer::TerrainRenderer(const Terrain& terrain, const RenderOptions& options)
    : terrain_(&terrain), options_(options) {
  options.Check();
}

RenderedView TerrainRenderer::Trace(const StereoCamera& camera, const Rigid3& world_from_camera,
                                    const std::vector<Solid>& bodies) const {
  camera.Check();
  Require(world_from_camera.IsFinite(), "render: the camera's pose is not finite");
  const Tracer tracer(*terrain_, options_, camera, world_from_camera, bodies);
  RenderedView view{cv::Mat(camera.height, camera.width, CV_32FC1),
                    cv::Mat(camera.height, camera.width, CV_32FC1)};
  cv::Mat surface(camera.height, camera.width, CV_32SC1);
  ForEachRow(camera.height, options_.num_threads, [&](int v) {
    for (int u = 0; u < camera.width; ++u) {
      const Sight sight = tracer.Look(u, v, 1);
      view.radiance.at<float>(v, u) = sight.radiance;
      view.depth.at<float>(v, u) = sight.depth;
      surface.at<int>(v, u) = sight.surface;
    }
  });
  if (options_.edge_samples == 1) return view;
  ForEachRow(camera.height, options_.num_threads, [&](int v) {
    for (int u = 0; u < camera.width; ++u) {
      if (!IsEdge(surface, view.depth, u, v)) continue;
      view.radiance.at<float>(v, u) = Supersample(tracer, u, v, options_.edge_samples);
    }
  });
  return view;
}

cv::Mat TerrainRenderer::Render(const StereoCamera& camera, const Rigid3& world_from_camera,
                                uint32_t image_id, const std::vector<Solid>& bodies) const {
  return ExposeImage(Trace(camera, world_from_camera, bodies).radiance, options_.sensor, image_id);
}

StereoImages TerrainRenderer::RenderPair(const StereoCamera& camera, const Rigid3& world_from_left,
                                         uint32_t pair_id, double stamp_s,
                                         const std::vector<Solid>& bodies) const {
  StereoImages images;
  images.stamp_s = stamp_s;
  images.left = Render(camera, world_from_left, 2 * pair_id, bodies);
  images.right = Render(camera, RightCameraPose(camera, world_from_left), 2 * pair_id + 1, bodies);
  return images;
}

}  // namespace arfm_vo
