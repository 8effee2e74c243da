#include "world/lives/view_truth.hpp"

#include <algorithm>
#include <cmath>

#include <sightline/view.hpp>

#include "support/world_twin.hpp"

namespace sightline::lives {
namespace {

using geometry::to_double;

glm::dvec3 about(const WorldPoint& p, const WorldPoint& origin) {
  return {p.x - origin.x, p.y - origin.y, p.z - origin.z};
}
double reach(const WorldPoint& p) {
  return std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z);
}
double radius_of(const WorldBox& box) {
  return 0.5 * glm::length(about(box.max, box.min));
}

}  // namespace

ViewTruth::ViewTruth(const WorldView& view)
    : view_(view.view),
      planes_(test::planes_of(view)),
      about_(view.origin),
      eye_(geometry::eye_of(view.view)),
      eye_away_(std::fabs(eye_.x) + std::fabs(eye_.y) + std::fabs(eye_.z)) {}

ViewTruth::ViewTruth(const WorldView& view, const InstancePlacement& placement) : ViewTruth(view) {
  glm::dmat4 to_view = to_double(placement.transform);
  to_view[3] += glm::dvec4(about(placement.origin, view.origin), 0);
  for (glm::dvec4& plane : planes_) plane = glm::transpose(to_view) * plane;
  eye_ = glm::dvec3(glm::inverse(to_view) * glm::dvec4(eye_, 1));
  about_ = {};
  scale_ = glm::length(glm::dvec3(to_view[0]));
  placed_ = true;
}

double ViewTruth::depth(const WorldBox& box) const {
  return test::depth_in(planes_, about_, box);
}

double ViewTruth::distance(const WorldBox& box) const {
  return glm::length(0.5 * (about(box.min, about_) + about(box.max, about_)) - eye_);
}

double ViewTruth::pixels(const WorldBox& box) const {
  const auto& m = view_.eye_to_clip.m;
  const auto size = [](float by, std::uint32_t pixels) { return std::fabs(double{by}) * pixels; };
  const double radius = scale_ * radius_of(box), away = scale_ * distance(box);
  const double largest = radius * std::max(size(m[0], view_.width), size(m[5], view_.height));
  if (is_orthographic(view_)) return largest / std::fabs(double{m[15]});
  return away <= radius ? 1e30 : largest / (away * std::fabs(double{m[11]}));
}

double ViewTruth::pixels_doubt(const WorldBox& box) const {
  constexpr double kSector = 1600;
  const double radius = std::max(scale_ * radius_of(box), 1e-9), away = scale_ * distance(box);
  const double by_radius = 1e-4 + 4e-7 * kSector * scale_ / radius;
  if (is_orthographic(view_)) return placed_ ? 5 * by_radius : by_radius;
  if (std::fabs(away - radius) < 1e-3 * (placed_ ? 1 + away + radius : 1 + 1e-2 * (away + radius))) return 1;
  const double by_distance = 4e-7 * (away + 4000 * scale_ + eye_away_) / std::max(away, 1e-9);
  return (placed_ ? 5 : 1) * (by_radius + by_distance);
}

Verdict ViewTruth::in_frustum(const WorldBox& box, double largest) const {
  const double away = distance(box), at = depth(box);
  double outside = 0.02 + 3e-5 * (away + largest + 1600 + eye_away_);
  double inside = 1e-9 + 1e-12 * (away + eye_away_ + reach(box.min) + reach(box.max) + reach(about_));
  if (placed_) {
    outside = 0.02 + 1e-4 * eye_away_ + std::max(scale_, 1e-3) * (0.05 + 1e-4 * (away + largest + 1600));
    inside = 1e-6 * (1 + scale_ * (away + reach(box.min) + reach(box.max)));
  }
  if (at < -outside) return Verdict::unseen;
  return at < inside ? Verdict::either : Verdict::seen;
}

Verdict ViewTruth::in_range(const WorldBox& box, const DistanceRange& range, float scale) const {
  const double away = distance(box), low = double{range.min} * scale, high = double{range.max} * scale;
  const double doubt =
      placed_ ? 2e-3 + 1e-5 * (away + 3000 + eye_away_ / scale_) : 1.5e-3 + 2e-6 * (away + 3000);
  const auto near = [&](double limit) { return std::fabs(away - limit) < doubt + 1e-6 * limit; };
  if ((low > 0 && near(low)) || (std::isfinite(high) && near(high))) return Verdict::either;
  return low <= away && away < high ? Verdict::seen : Verdict::unseen;
}

}  // namespace sightline::lives
