#include "workbench/submission/draw_list.hpp"

#include <utility>

#include "library/geometry/mutant.h"
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

CallOf call_from(const Parameters& parameters) noexcept {
  return parameters.word("submission") == "objects" ? CallOf::object : CallOf::mesh;
}

DrawList::DrawList(const Scene& scene, CallOf call)
    : call_(call), states_(scene.size()), instances_(scene.meshes.size(), 0) {
  std::array<std::size_t, kDrawStates> counts{};
  for (ObjectId id = 0; id < scene.size(); ++id) {
    states_[id] = draw_state(scene, id);
    ++counts[static_cast<std::size_t>(states_[id])];
  }
  for (std::size_t state = 0; state < keys_.size(); ++state) keys_[state].reserve(counts[state]);
  scratch_.reserve(scene.size());
  touched_.reserve(scene.meshes.size());
}

void DrawList::build(const Scene& scene, const View& view, Frame& frame) noexcept {
  const Vec3 eye = eye_position(view), forward = view_direction(view);
  for (auto& keys : keys_) keys.clear();
  for (const ObjectId id : frame.visible) {
    const std::uint32_t near_first = geometry::sortable(geometry::view_depth(scene.bounds[id], eye, forward));
    const DrawState state = states_[id];
    keys_[static_cast<std::size_t>(state)].push_back(
        std::uint64_t{state == DrawState::blended && !SIGHTLINE_MUTANT(transparent_near_to_far) ? ~near_first
                                                                                                : near_first}
            << 32 |
        id);
  }
  frame.draws.clear();
  frame.one_by_one = call_ == CallOf::object;
  std::uint32_t first = 0;
  for (std::size_t state = 0; state < keys_.size(); ++state) {
    std::vector<std::uint64_t>& keys = keys_[state];
    geometry::sort_by_high_bits(keys, scratch_, 32);
    if (call_ == CallOf::object) {
      draw_one_by_one(scene, keys, first, frame);
    } else if (static_cast<DrawState>(state) == DrawState::blended) {
      draw_in_runs(scene, first, frame);
    } else {
      draw_by_mesh(scene, keys, first, frame);
    }
    first += static_cast<std::uint32_t>(keys.size());
  }
  frame.stats.draw_calls = frame.draws.size();
}

// Meshes in the order of their nearest object, their objects near to far.
void DrawList::draw_by_mesh(const Scene& scene, std::span<const std::uint64_t> near_first,
                            std::uint32_t first, Frame& frame) noexcept {
  touched_.clear();
  for (const std::uint64_t key : near_first) {
    const std::uint32_t mesh = scene.mesh[id_of(key)];
    if (instances_[mesh]++ == 0) touched_.push_back(mesh);
  }
  for (const std::uint32_t mesh : touched_) {
    const std::uint32_t count = std::exchange(instances_[mesh], first);
    append(scene.meshes[mesh], count, first, frame);
    first += count;
  }
  for (const std::uint64_t key : near_first) frame.visible[instances_[scene.mesh[id_of(key)]]++] = id_of(key);
  for (const std::uint32_t mesh : touched_) instances_[mesh] = 0;
}

void DrawList::draw_in_runs(const Scene& scene, std::uint32_t first, Frame& frame) const noexcept {
  const std::vector<std::uint64_t>& far_first = keys_[static_cast<std::size_t>(DrawState::blended)];
  for (std::size_t i = 0; i < far_first.size();) {
    const std::uint32_t mesh = scene.mesh[id_of(far_first[i])], run = first;
    for (; i < far_first.size() && scene.mesh[id_of(far_first[i])] == mesh; ++i)
      frame.visible[first++] = id_of(far_first[i]);
    append(scene.meshes[mesh], first - run, run, frame);
  }
}

void DrawList::draw_one_by_one(const Scene& scene, std::span<const std::uint64_t> keys, std::uint32_t first,
                               Frame& frame) noexcept {
  for (const std::uint64_t key : keys) {
    frame.visible[first] = id_of(key);
    append(scene.meshes[scene.mesh[id_of(key)]], 1, first++, frame);
  }
}

}  // namespace sightline::submission
