// Occlusion among visible cells, on the CPU and with the occluders of the method `masked`: cells that they
// hide by their boxes are not drawn, and of the others what they hide of each object.
#include <sightline/workbench/error.hpp>

#include "workbench/methods/draw_calls/draw_call_method.hpp"

namespace sightline::methods {

// Of what is in view the largest occlude, unless the scene does as one.
bool DrawCallMethod::draw_occluders(const View& view, const Frustum& frustum) noexcept {
  candidates_.clear();
  for (ObjectId object = 0; !occluders_->as_one() && object < scene_.size(); ++object) {
    if (overlaps(frustum, scene_.bounds[object])) candidates_.push_back(object);
  }
  return occluders_->usable() && occluders_->draw({view, {}}, candidates_);
}

void DrawCallMethod::build_occludees(const FlatTriangles& flat, Layer& layer) {
  std::vector<Vec3> corners;
  std::vector<std::uint32_t> counts;
  for (std::uint32_t cell = 0; cell < layer.partition.cells(); ++cell) {
    ObjectId last = kNoObject;
    for (const std::uint32_t triangle : layer.partition.triangles(cell)) {
      const auto at = flat.span()[triangle];
      corners.insert(corners.end(), at.begin(), at.end());
      if (flat.objects[triangle] != last) counts.push_back(0);
      last = flat.objects[triangle];
      ++counts.back();
    }
  }
  or_throw(layer.occludees.assign(corners, counts));
}

void DrawCallMethod::leave_out_hidden(const Layer& layer, Frame& frame) noexcept {
  const DrawBatches& batches = layer.batches;
  seen_runs_.clear();
  for (const auto& run : runs_) {
    for (std::uint32_t cell = run.first_cell; cell < run.last_cell; ++cell) {
      if (!occluders_->buffer().may_see(layer.partition.bounds(cell))) {
        const std::uint32_t first = batches.object_start[batches.cell_start[cell]],
                            end = batches.object_start[batches.cell_start[cell + 1]];
        for (std::uint32_t o = first; o < end; ++o) reach(batches.objects[o], kInView, frame);
      } else if (!seen_runs_.empty() && seen_runs_.back().last_cell == cell) {
        seen_runs_.back().last_cell = cell + 1;
      } else {
        seen_runs_.push_back({cell, cell + 1});
      }
    }
  }
  std::swap(runs_, seen_runs_);
}

void DrawCallMethod::take_unhidden(const Layer& layer, Frame& frame) noexcept {
  for (const auto& run : runs_) {
    for (std::uint32_t cell = run.first_cell; cell < run.last_cell; ++cell)
      take_unhidden_of(layer, layer.batches.cell_start[cell], frame);
  }
}

// A copy's triangles stand object by object. What is hidden between two ranges is drawn along where it is
// less than the call that it would save is worth.
void DrawCallMethod::take_unhidden_of(const Layer& layer, std::uint32_t batch, Frame& frame) noexcept {
  const DrawBatches& batches = layer.batches;
  const std::uint32_t first = batches.object_start[batch], end = batches.object_start[batch + 1];
  std::uint32_t at = batches.ranges[batches.range_start[batch]].first;
  std::uint32_t undecided = first;  // the first object that is hidden or in a gap
  const auto decide = [&](std::uint32_t until, Reached how_far) {
    for (; undecided < until; ++undecided) reach(batches.objects[undecided], how_far, frame);
  };
  bool open = false;
  for (std::uint32_t o = first; o < end; ++o) {
    const std::uint32_t begin = at, count = layer.occludees.triangles(o);
    at += count;
    if (!occluders_->buffer().may_see(layer.occludees, o)) continue;
    if (open && begin - (ranges_.back().first + ranges_.back().count) < partition::kCallsWorth) {
      ranges_.back().count = at - ranges_.back().first;
      decide(o, kSubmitted);
    } else {
      ranges_.push_back({begin, count});
      decide(o, kInView);
    }
    decide(o + 1, kSubmitted);
    open = true;
  }
  decide(end, kInView);
}

}  // namespace sightline::methods
