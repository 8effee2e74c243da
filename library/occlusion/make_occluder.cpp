// Occluders out of meshes: what is flat as it is, of what is closed a simpler surface inside it.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <sightline/occluder.hpp>

#include "library/geometry/linear.hpp"
#include "library/occlusion/flat_parts.hpp"
#include "library/occlusion/mesh_check.hpp"
#include "library/occlusion/shell.hpp"
#include "library/occlusion/silhouette.hpp"

namespace sightline {

using namespace occlusion;
using geometry::to_double;
using geometry::to_vec3;

namespace {

constexpr std::uint32_t kMost = 4096;     // triangles, and boxes
constexpr double kLeastPart = 0.01;       // of the mesh's size: smaller parts hide too little
constexpr double kLeastTriangle = 0.002;  // the same of single triangles
constexpr double kFromLid = 0.15;  // of a part's box: so far the hull of an open one keeps from its edges
constexpr std::uint32_t kLeastShare = 4;  // triangles that a part is worth beginning with

void keep_largest(std::vector<Candidate>& candidates, std::size_t most) {
  std::ranges::stable_sort(candidates,
                           [](const Candidate& a, const Candidate& b) { return a.area > b.area; });
  if (candidates.size() > most) candidates.resize(most);
}

bool covers_more(const MeshPart& part, std::span<const Candidate> a, std::span<const Candidate> b) {
  return !a.empty() &&
         (b.empty() || mean_silhouette(a, part.low, part.high) > mean_silhouette(b, part.low, part.high));
}

// Those triangles of a shell that lie inside as they are when they are rounded.
std::vector<Candidate> sound_triangles(const Solid& solid, const Shell& shell, std::size_t most) {
  std::vector<Candidate> out;
  for (std::size_t t = 0; t < shell.triangles.size(); ++t) {
    Candidate c;
    Corners3 rounded = shell.corners(t);
    for (std::size_t k = 0; k < 3; ++k) {
      c.corners[k] = to_vec3(solid.to_mesh(rounded[k]));
      rounded[k] = solid.to_solid(to_double(c.corners[k]));
    }
    c.area = triangle_area(c.corners);
    if (c.area > 0 && solid.holds(rounded)) out.push_back(c);
  }
  // All of a closed shell is seen from its front; of one with holes the far side shows through them.
  if (solid.has_lid() || (out.size() == shell.triangles.size() && out.size() <= most)) {
    for (Candidate& c : out) c.sides = Sides::front;
  }
  keep_largest(out, most);
  return out;
}

class Maker {
public:
  Maker(const MeshParts& mesh, const OccluderOptions& options) : mesh_(mesh), options_(options) {
    for (const MeshPart& part : mesh.parts)
      all_.low = glm::min(all_.low, part.low), all_.high = glm::max(all_.high, part.high);
  }
  Occluder make();

private:
  void choose_parts();
  void take_whole_part(const MeshPart& part, std::vector<Candidate>& flat, std::uint32_t most);
  std::vector<Candidate> shell_of(const Solid& solid, const MeshPart& part, std::uint32_t most);
  void add_boxes(const Solid& solid);
  const SolidGrid& grid_of(const Solid& solid) {
    if (!grid_) grid_.emplace(solid);
    return *grid_;
  }
  void add(std::span<const Candidate> candidates);

  const MeshParts& mesh_;
  OccluderOptions options_;
  MeshPart all_;  // the box around all of it
  Occluder out_;
  std::vector<Candidate> solid_, flat_;
  std::optional<SolidGrid> grid_;  // of the part at hand
};

// Boxes as the triangles of their sides.
Shell shell_of_boxes(std::span<const Bounds3> boxes) {
  Shell out;
  for (const Bounds3& box : boxes) {
    const auto first = static_cast<std::uint32_t>(out.points.size());
    for (int i = 0; i < 8; ++i)
      out.points.emplace_back((i & 1 ? box.high : box.low).x, (i & 2 ? box.high : box.low).y,
                              (i & 4 ? box.high : box.low).z);
    constexpr std::uint32_t kSides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                            {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& q : kSides) {
      out.triangles.push_back({first + q[0], first + q[1], first + q[2]});
      out.triangles.push_back({first + q[0], first + q[2], first + q[3]});
    }
  }
  return out;
}

// The best of what lies inside the part at hand: its convex hull where it is convex, else what the grid sees,
// as a surface or as boxes.
std::vector<Candidate> Maker::shell_of(const Solid& solid, const MeshPart& part, std::uint32_t most) {
  const Shell hull = convex_shell(solid, most);
  std::vector<Candidate> best = sound_triangles(solid, hull, most);
  if (!hull.triangles.empty() && best.size() == hull.triangles.size()) return best;
  const SolidGrid& grid = grid_of(solid);
  Shell shell = grid_shell(grid);
  simplify(solid, SolidGrid::kStep, most, shell);
  const Shell boxes = shell_of_boxes(boxes_inside(solid, grid, most / 12));
  const Shell far_hull = convex_shell(solid, most, kFromLid);
  for (const Shell& proposed : {shell, boxes, far_hull}) {
    std::vector<Candidate> other = sound_triangles(solid, proposed, most);
    if (covers_more(part, other, best)) best = std::move(other);
  }
  return best;
}

void Maker::add_boxes(const Solid& solid) {
  const SolidGrid& grid = grid_of(solid);
  for (const Bounds3& box : boxes_inside(solid, grid, options_.most_boxes - out_.boxes.size())) {
    const Box rounded{to_vec3(solid.to_mesh(box.low)), to_vec3(solid.to_mesh(box.high))};
    Bounds3 exact;
    exact.low = solid.to_solid(to_double(rounded.min)), exact.high = solid.to_solid(to_double(rounded.max));
    if (glm::all(glm::lessThan(exact.low, exact.high)) && solid.holds(exact)) out_.boxes.push_back(rounded);
  }
}

// The best that a part gives for so many triangles.
void Maker::take_whole_part(const MeshPart& part, std::vector<Candidate>& flat, std::uint32_t most) {
  const bool whole = flat.size() <= most;
  const double least = whole ? 0 : kLeastTriangle * all_.size();
  std::erase_if(flat, [&](const Candidate& c) { return c.area < least; });
  keep_largest(flat, most);
  grid_.reset();
  std::optional<Solid> closed;
  const bool wants_boxes = out_.boxes.size() < options_.most_boxes;
  if (!whole || (wants_boxes && part.inside != Inside::never)) closed.emplace(mesh_, part);
  if (closed && closed->thin()) closed.reset();
  std::vector<Candidate> shell;
  if (closed && !whole && most > 0) shell = shell_of(*closed, part, most);
  const bool better = covers_more(part, shell, flat);
  (better ? solid_ : flat_)
      .insert((better ? solid_ : flat_).end(), better ? shell.begin() : flat.begin(),
              better ? shell.end() : flat.end());
  if (closed && !closed->has_lid() && wants_boxes) add_boxes(*closed);
}

// Triangles are shared out by how large parts are.
void Maker::choose_parts() {
  std::vector<std::vector<Candidate>> flat(mesh_.parts.size());
  for (Candidate& c : flat_parts(mesh_)) flat[c.part].push_back(c);
  std::size_t all = 0, count = 0;
  for (const auto& its : flat) all += its.size();
  const bool whole = all <= options_.most_triangles;
  double size = 0;
  for (; count < mesh_.parts.size(); ++count) {
    const bool worth = mesh_.parts[count].size() >= kLeastPart * all_.size() &&
                       count < std::max(1u, options_.most_triangles / kLeastShare);
    if (!whole && !worth) break;
    size += mesh_.parts[count].size();
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto left = static_cast<std::uint32_t>(options_.most_triangles - solid_.size() - flat_.size());
    const double its = mesh_.parts[i].size();
    const auto share =
        size > 0 ? static_cast<std::uint32_t>(std::lround(left * std::min(1.0, its / size))) : left;
    take_whole_part(mesh_.parts[i], flat[i], whole ? left : std::min(left, std::max(share, kLeastShare)));
    size -= its;
  }
  out_.yield = whole ? OccluderYield::whole : OccluderYield::parts;
}

void Maker::add(std::span<const Candidate> candidates) {
  for (const Candidate& c : candidates) {
    for (const Vec3& p : c.corners) {
      const auto known = std::ranges::find(out_.positions, p);
      out_.indices.push_back(static_cast<std::uint32_t>(known - out_.positions.begin()));
      if (known == out_.positions.end()) out_.positions.push_back(p);
    }
    out_.sides.push_back(c.sides);
  }
}

Occluder Maker::make() {
  if (mesh_.parts.empty()) return out_;
  choose_parts();
  add(solid_);
  out_.solid_triangles = solid_.size();
  add(flat_);
  if (out_.indices.empty() && out_.boxes.empty()) out_.yield = OccluderYield::thin;
  return std::move(out_);
}

}  // namespace

Result<Occluder> make_occluder(std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
                               std::span<const Sides> sides, const OccluderOptions& options) {
  if (const Status sound = check_mesh(positions, indices, sides); !sound) return sound;
  if (options.most_triangles > kMost || options.most_boxes > kMost)
    return Status{StatusCode::bad_argument, "occluder: expected at most 4096 triangles and 4096 boxes"};
  if (options.most_triangles == 0 && options.most_boxes == 0)
    return Status{StatusCode::bad_argument, "make_occluder: expected room for some triangles or boxes"};
  return Maker(parts_of(positions, indices, sides), options).make();
}

const char* to_string(OccluderYield yield) noexcept {
  switch (yield) {
    case OccluderYield::whole:
      return "all of the mesh occludes, as it is";
    case OccluderYield::parts:
      return "what lies inside the mesh, and its largest flat parts, occlude";
    case OccluderYield::thin:
      return "nothing occludes: the mesh is open or thin, and has no large flat part";
    case OccluderYield::empty:
      break;
  }
  return "nothing occludes: the mesh has no triangle";
}

}  // namespace sightline
