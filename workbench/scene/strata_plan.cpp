#include "workbench/scene/strata_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "library/geometry/elementary.hpp"

namespace sightline::scene {

namespace {

constexpr float kHeight = 600;        // all layers together
constexpr std::uint32_t kFaults = 3;  // each way across
constexpr float kHeading = 0.45f;     // radians: faults do not run along the axes
constexpr float kDip = 0.2f;          // how far a fault moves aside for each unit of depth

// Cuts a rectangle into `pieces`, each time across its longer side, about in proportion.
void cut(const StrataRectangle& r, std::uint32_t pieces, Random& random, std::vector<StrataRectangle>& out) {
  if (pieces == 1) {
    out.push_back(r);
    return;
  }
  const std::uint32_t first = pieces / 2;
  const float share = std::clamp(
      static_cast<float>(first) / static_cast<float>(pieces) + random.between(-0.12f, 0.12f), 0.2f, 0.8f);
  StrataRectangle a = r, b = r;
  if (r.u1 - r.u0 >= r.v1 - r.v0) {
    a.u1 = b.u0 = r.u0 + share * (r.u1 - r.u0);
  } else {
    a.v1 = b.v0 = r.v0 + share * (r.v1 - r.v0);
  }
  cut(a, first, random, out);
  cut(b, pieces - first, random, out);
}

Vec3 minus(const Vec3& a, const Vec3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// A sheet of quads with its own vertices. `point(i, j)` runs counter-clockwise from i to j as seen from
// outside.
template <class Point>
void add_sheet(StrataMesh& mesh, std::uint32_t columns, std::uint32_t rows, const Point& point) {
  auto& [middle, positions, normals, indices] = mesh;
  const auto first = static_cast<std::uint32_t>(positions.size());
  for (std::uint32_t j = 0; j <= rows; ++j) {
    for (std::uint32_t i = 0; i <= columns; ++i) positions.push_back(point(i, j));
  }
  normals.resize(positions.size());
  const std::uint32_t stride = columns + 1;
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t a = first + j * stride + i, b = a + 1, c = a + stride, d = c + 1;
      for (std::uint32_t index : {a, b, d, a, d, c}) indices.push_back(index);
      const Vec3 n = cross(minus(positions[d], positions[a]), minus(positions[c], positions[b]));
      for (std::uint32_t index : {a, b, c, d}) {
        Vec3& sum = normals[index];
        sum = {sum.x + n.x, sum.y + n.y, sum.z + n.z};
      }
    }
  }
  for (std::size_t i = first; i < normals.size(); ++i) {
    Vec3& n = normals[i];
    const float length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
    n = length > 0 ? Vec3{n.x / length, n.y / length, n.z / length} : Vec3{0, 1, 0};
  }
}

// `triangles` shared out as 4nm + 4n + 4m with n quads along u and m along v, in proportion to the sides.
std::pair<std::uint32_t, std::uint32_t> quads(const StrataRectangle& r, double triangles) {
  const double ratio = (r.u1 - r.u0) / (r.v1 - r.v0);
  const double along_v =
      std::max(1.0, std::sqrt(triangles / 4 / ratio + 0.25 * (1 + 1 / ratio) * (1 + 1 / ratio)) -
                        0.5 * (1 + 1 / ratio));
  const auto m = static_cast<std::uint32_t>(std::lround(along_v));
  const double along_u = (triangles - 4.0 * m) / (4.0 * m + 4.0);
  return {static_cast<std::uint32_t>(std::lround(std::max(1.0, along_u))), m};
}

}  // namespace

StrataGround::StrataGround(Random& random, std::uint32_t layers) {
  for (Fold& fold : folds_) {
    const float wave = random.between(2, 7) / kStrataSide, heading = random.between(-0.6f, 0.6f);
    fold = {2 * std::numbers::pi_v<float> * wave * portable::cos(heading),
            2 * std::numbers::pi_v<float> * wave * portable::sin(heading),
            random.between(0, 2 * std::numbers::pi_v<float>), random.between(15, 60)};
  }
  float y = -0.5f * kHeight;
  for (std::uint32_t layer = 0; layer < layers; ++layer) {
    borders_.push_back(y);
    y += random.between(0.4f, 1.6f) * kHeight / static_cast<float>(layers);
  }
  borders_.push_back(y);
}

Vec3 StrataGround::at(std::uint32_t border, float u, float v, float thrown) const {
  float y = borders_[border] + thrown;
  const float damped = 1 - 0.3f * static_cast<float>(border) / static_cast<float>(borders_.size());
  for (const Fold& fold : folds_) {
    y += damped * fold.height * portable::sin(fold.along_u * u + fold.along_v * v + fold.phase);
  }
  // Thickness swells and thins from place to place, never to nothing.
  y += 3 * portable::sin(0.004f * u + static_cast<float>(border)) * portable::cos(0.005f * v);
  const float slanted = u + kDip * y;
  const float c = portable::cos(kHeading), s = portable::sin(kHeading);
  return {c * slanted - s * v, y, s * slanted + c * v};
}

StrataPlan plan_strata(const StrataModel& model, double triangles, std::uint64_t seed) {
  Random random(seed);
  StrataPlan plan{StrataGround(random, model.layers), {}};
  std::vector<StrataRectangle> blocks;
  std::array<std::array<float, kFaults + 2>, 2> faults;
  for (auto& across : faults) {
    for (std::uint32_t i = 0; i < across.size(); ++i) {
      const bool border = i == 0 || i + 1 == across.size();
      const float even = static_cast<float>(i) / static_cast<float>(kFaults + 1) - 0.5f;
      across[i] = kStrataSide * (even + (border ? 0 : random.between(-0.06f, 0.06f)));
    }
  }
  for (std::uint32_t i = 0; i <= kFaults; ++i) {
    for (std::uint32_t j = 0; j <= kFaults; ++j) {
      blocks.push_back({faults[0][i], faults[1][j], faults[0][i + 1], faults[1][j + 1]});
    }
  }
  std::vector<float> thrown;
  for (std::size_t b = 0; b < blocks.size(); ++b) thrown.push_back(random.between(-60, 60));

  // Meshes over blocks and layers as evenly as whole numbers allow.
  const auto shares = static_cast<std::uint32_t>(blocks.size()) * model.layers;
  std::vector<StrataRectangle> pieces;
  for (std::uint32_t share = 0; share < shares; ++share) {
    const std::uint32_t layer = share / static_cast<std::uint32_t>(blocks.size());
    const std::uint32_t block = share % static_cast<std::uint32_t>(blocks.size());
    pieces.clear();
    const std::uint64_t meshes = model.meshes;
    cut(blocks[block], static_cast<std::uint32_t>(meshes * (share + 1) / shares - meshes * share / shares),
        random, pieces);
    for (const StrataRectangle& piece : pieces) {
      const auto [columns, rows] = quads(piece, triangles / model.meshes);
      plan.pieces.push_back({piece, layer, thrown[block], columns, rows});
    }
  }
  return plan;
}

void make_piece(const StrataGround& ground, const StrataPiece& planned, StrataMesh& out) {
  const StrataRectangle& r = planned.area;
  const std::uint32_t layer = planned.layer, n = planned.columns, m = planned.rows;
  const float thrown = planned.thrown;
  const Vec3 middle = ground.at(layer, 0.5f * (r.u0 + r.u1), 0.5f * (r.v0 + r.v1), thrown);
  const auto point = [&](std::uint32_t border, std::uint32_t i, std::uint32_t j) {
    // The far corners are named exactly, so that neighbours share their borders to the bit.
    const float u = i == n ? r.u1 : r.u0 + (r.u1 - r.u0) * static_cast<float>(i) / static_cast<float>(n);
    const float v = j == m ? r.v1 : r.v0 + (r.v1 - r.v0) * static_cast<float>(j) / static_cast<float>(m);
    return minus(ground.at(layer + border, u, v, thrown), middle);
  };
  using U = std::uint32_t;
  out.middle = middle;
  out.positions.clear(), out.normals.clear(), out.indices.clear();
  // u, v and up are (x, z, y): u × v points down, so the top runs v before u.
  add_sheet(out, m, n, [&](U j, U i) { return point(1, i, j); });
  add_sheet(out, n, m, [&](U i, U j) { return point(0, i, j); });
  add_sheet(out, 1, n, [&](U up, U i) { return point(up, i, 0); });
  add_sheet(out, n, 1, [&](U i, U up) { return point(up, i, m); });
  add_sheet(out, m, 1, [&](U j, U up) { return point(up, 0, j); });
  add_sheet(out, 1, m, [&](U up, U j) { return point(up, n, j); });
}

}  // namespace sightline::scene
