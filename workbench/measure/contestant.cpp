#include "workbench/measure/contestant.hpp"

#include <sightline/workbench/error.hpp>

namespace sightline::measure {

std::vector<Contestant> make_contestants(const Scene& scene, std::span<const std::string> specifications) {
  std::vector<Contestant> made;
  for (const std::string& specification : specifications) {
    made.push_back({specification, or_throw(create_method(specification, scene))});
  }
  return made;
}

std::vector<std::string> fitting_methods(const Scene& scene) {
  std::vector<std::string> names;
  for (const MethodInfo& info : cpu_methods()) {
    if (info.fits(scene)) names.emplace_back(info.name);
  }
  return names;
}

std::vector<std::string> promising_methods(const Scene& scene) {
  std::vector<std::string> names;
  for (const MethodInfo& info : cpu_methods()) {
    if (info.fits(scene) && info.guarantee != Guarantee::approximate) names.emplace_back(info.name);
  }
  return names;
}

}  // namespace sightline::measure
