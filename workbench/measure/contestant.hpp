// A method under examination, with the name it is reported by.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <sightline/workbench/method.hpp>

namespace sightline::measure {

struct Contestant {
  std::string name;  ///< the specification it was made from: "vfc-vc?contribution=off"
  std::unique_ptr<Method> method;
};

/// Makes each method for the scene. Throws Error for one that does not exist or does not fit.
std::vector<Contestant> make_contestants(const Scene& scene, std::span<const std::string> specifications);

/// Names of all registered CPU methods that fit the scene.
std::vector<std::string> fitting_methods(const Scene& scene);

/// Of those, the ones that promise something that can be held against them: exact or conservative.
std::vector<std::string> promising_methods(const Scene& scene);

}  // namespace sightline::measure
