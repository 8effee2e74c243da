#include "library/world/scattered_moves.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "library/geometry/box_reader.hpp"
#include "library/world/chunk_map.hpp"
#include "library/world/chunk_runs.hpp"

#ifndef __wasm__  // where movers have no pages
namespace sightline::world {

std::span<const Handle> ScatteredMoves::handles() const noexcept {
  return handles_;
}
std::span<const Box> ScatteredMoves::boxes() const noexcept {
  return boxes_;
}

using geometry::kBlock;

bool ScatteredMoves::are_scattered(const Strided<const Handle>& handles) noexcept {
  constexpr std::size_t kAsked = 64, kFew = 8;
  if (handles.size() < 2) return false;
  const std::size_t step = std::max<std::size_t>(1, (handles.size() - 1) / kAsked);
  std::size_t back = 0;
  for (std::size_t i = 0; i + 1 < handles.size(); i += step) back += handles[i + 1].index < handles[i].index;
  return back > kFew;
}

bool ScatteredMoves::sort(const Strided<const Handle>& handles, const BoxView& boxes, const WorldPoint& about,
                          std::size_t first, std::size_t count, std::size_t ids) {
  const bool float_corners = BoxReader::are_float_corners(boxes);
  const auto page = [](const Handle& handle) { return handle.index / ChunkMap::kCapacity; };
  next_.assign(ids / ChunkMap::kCapacity + 1, 0);
  handles_.resize(count), boxes_.resize(count);
  for (std::size_t i = 0; i < count; ++i) ++next_[page(handles[first + i])];
  std::uint32_t before = 0;
  for (std::uint32_t& next : next_) before += std::exchange(next, before);
  std::array<std::uint32_t, kBlock> to;
  for (std::size_t at = 0; at < count; at += kBlock) {
    const std::size_t some = std::min(kBlock, count - at);
    for (std::size_t i = 0; i < some; ++i) {
      const Handle handle = handles[first + at + i];
      to[i] = next_[page(handle)]++;
      handles_[to[i]] = handle;
    }
    std::span<const Box> structs;
    if (BoxReader::lies_as_structs(boxes, about, structs)) {
      for (std::size_t i = 0; i < some; ++i) boxes_[to[i]] = structs[first + at + i];
      continue;
    }
    geometry::BoxBlock block;
    if (!lay_out_in_sector(boxes, first + at, some, about, block) && !float_corners) return false;
    const auto& v = block.values;
    for (std::size_t i = 0; i < some; ++i)
      boxes_[to[i]] = {{v[0][i], v[1][i], v[2][i]}, {v[3][i], v[4][i], v[5][i]}};
  }
  return true;
}

}  // namespace sightline::world
#endif
