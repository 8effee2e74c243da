// Visible sets cell by cell.
#include <sightline/pvs.hpp>

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "bindings/c/calls.hpp"

struct sightline_pvs {
  sightline::CellPvs cells;
};

using namespace sightline;
using namespace sightline::c_api;

namespace {

static_assert(SIGHTLINE_NO_CELL == kNoCell);

// x * y * z, or more than there can be.
std::uint64_t cells_of(const std::uint32_t (&counts)[3]) {
  std::uint64_t cells = 1;
  for (const std::uint32_t along : counts) {
    cells *= along;
    if (cells > kMostCells) return kMostCells + 1;
  }
  return cells;
}

Status take(const sightline_pvs_cells& given, CellPvs& cells) {
  sightline_pvs_cells c = sightline_pvs_cells_default();
  if (!take_struct(&given, SIGHTLINE_FIRST_SIZE(sightline_pvs_cells, visible_count), c)) {
    return {StatusCode::bad_argument,
            "pvs: a struct_size is unknown, expected that of sightline_pvs_cells_default"};
  }
  if (c.cells > kMostCells) return {StatusCode::too_many, "pvs: expected at most 2^22 cells"};
  if (!c.open || !c.first || !can_hold(c.visible, c.visible_count)) {
    return {StatusCode::bad_argument, "pvs: open, first or visible are NULL, or more than memory holds"};
  }
  // Before anything is read: there may be no more of it than the counts say.
  if (c.cells != cells_of(c.counts))
    return {StatusCode::bad_argument, "pvs: expected cells to be counts[0] * counts[1] * counts[2]"};
  if (c.first[c.cells] != c.visible_count)
    return {StatusCode::bad_argument, "pvs: expected first[cells] to be visible_count"};
  cells.bounds = box_of(c.bounds);
  cells.counts = {c.counts[0], c.counts[1], c.counts[2]};
  cells.objects = c.objects, cells.scene = c.scene;
  cells.open.assign(c.open, c.open + c.cells);
  cells.first.assign(c.first, c.first + c.cells + 1);
  if (c.visible_count > 0) cells.visible.assign(c.visible, c.visible + c.visible_count);
  return {};
}

bool has(const sightline_pvs* pvs, std::uint32_t cell) {
  return pvs && cell < pvs->cells.size();
}

}  // namespace

extern "C" {

sightline_status sightline_pvs_read(const void* bytes, size_t size, sightline_pvs** pvs) {
  const auto* data = static_cast<const std::byte*>(bytes);
  if (!can_hold(data, size) || !pvs)
    return refuse("pvs: a pointer is NULL, or the size more than memory holds");
  Result<CellPvs> cells = read_pvs({data, size});
  if (!cells) return keep(cells.error());
  *pvs = new sightline_pvs{*std::move(cells)};
  return SIGHTLINE_OK;
}
void sightline_pvs_destroy(sightline_pvs* pvs) {
  delete pvs;
}

uint32_t sightline_pvs_cell_at(const sightline_pvs* pvs, const float point[3]) {
  return pvs && point ? pvs->cells.cell_at({point[0], point[1], point[2]}) : SIGHTLINE_NO_CELL;
}

sightline_status sightline_pvs_seen_from(const sightline_pvs* pvs, uint32_t cell, const uint32_t** objects,
                                         size_t* count) {
  if (!has(pvs, cell) || !objects || !count)
    return refuse("pvs: a pointer is NULL, or there is no such cell");
  const std::span<const std::uint32_t> seen = pvs->cells.seen_from(cell);
  *objects = seen.data(), *count = seen.size();
  return SIGHTLINE_OK;
}

sightline_status sightline_pvs_cell_bounds(const sightline_pvs* pvs, uint32_t cell, float bounds[6]) {
  if (!has(pvs, cell) || !bounds) return refuse("pvs: a pointer is NULL, or there is no such cell");
  const Box box = pvs->cells.cell_bounds(cell);
  std::memcpy(bounds, &box, sizeof box);
  return SIGHTLINE_OK;
}

sightline_status sightline_pvs_contents(const sightline_pvs* pvs, sightline_pvs_cells* cells) {
  if (!pvs || !cells) return refuse("pvs: the pvs or the cells are NULL");
  if (!knows<sightline_pvs_cells>(cells->struct_size,
                                  SIGHTLINE_FIRST_SIZE(sightline_pvs_cells, visible_count)))
    return refuse("pvs: a struct_size is unknown, expected that of sightline_pvs_cells_default");
  const CellPvs& from = pvs->cells;
  sightline_pvs_cells c = sightline_pvs_cells_default();
  c.struct_size = cells->struct_size;
  c.objects = from.objects, c.scene = from.scene;
  std::memcpy(c.bounds, &from.bounds, sizeof c.bounds);
  std::copy_n(from.counts.begin(), 3, c.counts);
  c.cells = static_cast<std::uint32_t>(from.size());
  c.open = from.open.data(), c.first = from.first.data();
  c.visible = from.visible.data(), c.visible_count = from.visible.size();
  std::memcpy(cells, &c, c.struct_size);
  return SIGHTLINE_OK;
}

sightline_status sightline_pvs_write(const sightline_pvs_cells* cells,
                                     void (*sink)(void* user, const void* bytes, size_t size), void* user) {
  if (!cells || !sink) return refuse("pvs: the cells or the sink is NULL");
  CellPvs given;
  if (const Status ok = take(*cells, given); !ok) return keep(ok);
  const Result<std::vector<std::byte>> bytes = write_pvs(given);
  if (!bytes) return keep(bytes.error());
  sink(user, bytes->data(), bytes->size());
  return SIGHTLINE_OK;
}

}  // extern "C"
