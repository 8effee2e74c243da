// Whether a scene is still the one that somebody was made for.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <sightline/types.hpp>

namespace sightline {

struct Scene;

/// The scene that a method, a renderer or an oracle was made for, and how much it held then. They keep copies
/// and tables of its objects, so what is added later is no part of them: they are to be made anew.
class HeldScene {
public:
  /// `holder` is who holds it, in errors: "method". The scene outlives this.
  HeldScene(const Scene& scene, std::string holder);

  [[nodiscard]] const Scene& operator*() const noexcept { return scene_; }
  [[nodiscard]] const Scene* operator->() const noexcept { return &scene_; }

  /// Throws Error where the scene has other numbers of objects or meshes than then.
  void require_same() const;
  /// The same; and throws Error for a moved object that is not among them, or has no finite bounds any more.
  void require_sound(std::span<const ObjectId> moved) const;

private:
  const Scene& scene_;
  std::string holder_;
  std::size_t objects_, meshes_;
};

}  // namespace sightline
