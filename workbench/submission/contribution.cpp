#include "workbench/submission/contribution.hpp"

namespace sightline::submission {

Contribution contribution_from(const Parameters& parameters) noexcept {
  const std::string_view word = parameters.word("contribution");
  Contribution out;
  out.test = word == "exact"  ? Contribution::Test::exact
             : word == "area" ? Contribution::Test::area
                              : Contribution::Test::off;
  out.threshold = static_cast<float>(parameters.number("threshold"));
  return out;
}

std::size_t Contribution::filter(const Scene& scene, const Projector& projector,
                                 std::span<ObjectId> ids) const noexcept {
  if (test == Test::off) return ids.size();
  std::size_t kept = 0;
  for (const ObjectId id : ids) {
    const bool keep = test == Test::exact
                          ? covers_sample(projector, projected_rect(projector, scene.bounds[id]))
                          : projected_area(projector, scene.sphere(id)) >= threshold;
    ids[kept] = id;
    kept += keep ? 1 : 0;
  }
  return kept;
}

}  // namespace sightline::submission
