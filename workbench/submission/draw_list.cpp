#include "workbench/submission/draw_list.hpp"

#include <utility>

#include "library/geometry/radix_sort.hpp"
#include "library/geometry/view_depth.hpp"

namespace sightline::submission {

namespace {

ObjectId id_of(std::uint64_t key) noexcept {
  return static_cast<ObjectId>(key);
}

void append(const Mesh& mesh, std::uint32_t instances, std::uint32_t first, Frame& frame) noexcept {
  frame.draws.push_back(
      {mesh.index_count, instances, mesh.first_index, static_cast<std::int32_t>(mesh.first_vertex), first});
  frame.stats.triangles += std::uint64_t{mesh.index_count / 3} * instances;
}

}  // namespace

DrawList::DrawList(const Scene& scene) : instances_(scene.meshes.size(), 0) {
  for (auto* keys : {&opaque_, &transparent_, &scratch_}) keys->reserve(scene.size());
  touched_.reserve(scene.meshes.size());
}

void DrawList::build(const Scene& scene, const View& view, Frame& frame) noexcept {
  const Vec3 eye = eye_position(view), forward = view_direction(view);
  opaque_.clear(), transparent_.clear();
  for (const ObjectId id : frame.visible) {
    const std::uint32_t near_first = geometry::sortable(geometry::view_depth(scene.bounds[id], eye, forward));
    const bool blended = scene.surface[id] == Surface::transparent;
    (blended ? transparent_ : opaque_)
        .push_back(std::uint64_t{blended ? ~near_first : near_first} << 32 | id);
  }
  geometry::sort_by_high_bits(opaque_, scratch_, 32);
  geometry::sort_by_high_bits(transparent_, scratch_, 32);

  // Opaque: meshes in the order of their nearest object, their objects near to far.
  touched_.clear();
  for (const std::uint64_t key : opaque_) {
    const std::uint32_t mesh = scene.mesh[id_of(key)];
    if (instances_[mesh]++ == 0) touched_.push_back(mesh);
  }
  std::uint32_t first = 0;
  frame.draws.clear();
  for (const std::uint32_t mesh : touched_) {
    const std::uint32_t count = std::exchange(instances_[mesh], first);
    append(scene.meshes[mesh], count, first, frame);
    first += count;
  }
  for (const std::uint64_t key : opaque_) frame.visible[instances_[scene.mesh[id_of(key)]]++] = id_of(key);
  for (const std::uint32_t mesh : touched_) instances_[mesh] = 0;

  for (std::size_t i = 0; i < transparent_.size();) {
    const std::uint32_t mesh = scene.mesh[id_of(transparent_[i])], run = first;
    for (; i < transparent_.size() && scene.mesh[id_of(transparent_[i])] == mesh; ++i) {
      frame.visible[first++] = id_of(transparent_[i]);
    }
    append(scene.meshes[mesh], first - run, run, frame);
  }
  frame.stats.draw_calls = frame.draws.size();
}

}  // namespace sightline::submission
