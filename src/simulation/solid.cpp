#include "arfm_vo/simulation/solid.h"

#include <cmath>

namespace arfm_vo {
namespace {
constexpr double kFar = std::numeric_limits<double>::infinity();
}

Solid::Span Solid::Cut(const Ray& ray) const {
  const double a = ray.direction.squaredNorm(), b = ray.origin.dot(ray.direction);
  const double discriminant = b * b - a * (ray.origin.squaredNorm() - 1);
  if (discriminant <= 0) return {kFar, -kFar, 0};
  const double root = std::sqrt(discriminant);
  Span span{(-b - root) / a, (-b + root) / a, 0};
  for (size_t i = 0; i < planes.size(); ++i) {
    const Eigen::Vector3d normal = planes[i].head<3>();
    const double approach = normal.dot(ray.direction);
    const double distance = planes[i].w() - normal.dot(ray.origin);
    if (std::abs(approach) < 1e-12) {
      if (distance < 0) return {kFar, -kFar, 0};
      continue;
    }
    const double crossing = distance / approach;
    if (approach > 0) {
      span.end = std::min(span.end, crossing);
    } else if (crossing > span.begin) {
      span.begin = crossing;
      span.face = 1 + static_cast<int>(i);
    }
  }
  return span;
}

SolidHit Solid::Intersect(const Ray& ray, double begin, double end) const {
  SolidHit hit;
  const Ray unit_ray{unit_from_world * (ray.origin - center), unit_from_world * ray.direction};
  const Span span = Cut(unit_ray);
  if (span.begin >= span.end || span.begin <= begin || span.begin >= end) return hit;
  hit.parameter = span.begin;
  hit.face = span.face;
  const Eigen::Vector3d unit_normal =
      span.face == 0 ? Eigen::Vector3d(unit_ray.origin + span.begin * unit_ray.direction)
                     : Eigen::Vector3d(planes[span.face - 1].head<3>());
  hit.normal = (unit_from_world.transpose() * unit_normal).normalized();
  return hit;
}

bool Solid::Blocks(const Ray& ray) const {
  const Eigen::Vector3d offset = ray.origin - center;
  const double along = -offset.dot(ray.direction) / ray.direction.squaredNorm();
  if ((offset + along * ray.direction).squaredNorm() > bounding_radius_m * bounding_radius_m) {
    return false;
  }
  const Span span = Cut({unit_from_world * offset, unit_from_world * ray.direction});
  return span.begin < span.end && span.end > 0;
}

Solid MakeBox(const Rigid3& world_from_body, const Eigen::Vector3d& half_size_m) {
  Solid box;
  box.center = world_from_body.translation;
  box.bounding_radius_m = half_size_m.norm();
  box.body_from_world = world_from_body.RotationMatrix().transpose();
  // The sphere touches the corners: it cuts nothing off.
  box.unit_from_world = box.body_from_world / (box.bounding_radius_m * (1 + 1e-9));
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Eigen::Vector4d plane = Eigen::Vector4d::Zero();
      plane[axis] = side;
      plane.w() = half_size_m[axis] / (box.bounding_radius_m * (1 + 1e-9));
      box.planes.push_back(plane);
    }
  }
  return box;
}

}  // namespace arfm_vo
