// The world of cards in each of its forms.
#pragma once

#include <string>
#include <vector>

#include <sightline/workbench/worlds.hpp>

namespace sightline::test {

inline std::vector<Scene> card_scenes() {
  std::vector<Scene> scenes;
  for (const std::string show : {"leaves", "grate", "sides"})
    scenes.push_back(generate_world("cards?show=" + show));
  return scenes;
}

}  // namespace sightline::test
