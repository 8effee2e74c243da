// Layered, faulted and folded geology with the meshes and triangles of Ye et al. 2023, table 4, whose models
// are not public: every mesh is a closed piece of one stratum between two faults.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "library/geometry/elementary.hpp"
#include "workbench/scene/random.hpp"
#include "workbench/scene/strata.hpp"
#include "workbench/scene/worlds.hpp"

namespace sightline::scene {

namespace {

constexpr std::array kStrataParameters{
    ParameterInfo{"model", "of the paper's five: 1,371, 2,684, 4,433, 6,744 or 17,773 meshes", "1", 1, 5,
                  true},
    ParameterInfo{"triangles", "about how many in all; 0: a hundredth of the paper's", "0", 0, 1e9, true},
    ParameterInfo{"full", "as many triangles as the paper's model", "no", 0, 0, false, "no|yes"},
    ParameterInfo{"seed", "of the random numbers", "1", 0, 4294967295.0, true},
};

// Wuzhishan's geology and its strata, Purmont, Northeast Guizhou, and Guizhou overall.
struct Model {
  std::uint32_t meshes, layers;
  double triangles;
};
constexpr std::array kModels{Model{1371, 12, 9234330}, Model{2684, 16, 27512307}, Model{4433, 18, 46731152},
                             Model{6744, 20, 263103774}, Model{17773, 28, 90415179}};

// Drawn at this scale, the ground just fits into a picture from the paper's viewpoint, 40 km away.
constexpr float kScale = 12;
constexpr Vec3 kPaperViewpoint{40000, 0, 0};
constexpr float kSide = 2000;         // of the square before it is folded
constexpr float kHeight = 600;        // all layers together
constexpr std::uint32_t kFaults = 3;  // each way across
constexpr float kHeading = 0.45f;     // radians: faults do not run along the axes
constexpr float kDip = 0.2f;          // how far a fault moves aside for each unit of depth

struct Fold {
  float along_u, along_v, phase, height;
};

struct Rectangle {
  float u0, v0, u1, v1;
};

// The shape of the ground: where a point (u, v) of a layer's border ends up.
class Ground {
public:
  Ground(Random& random, std::uint32_t layers) {
    for (Fold& fold : folds_) {
      const float wave = random.between(2, 7) / kSide, heading = random.between(-0.6f, 0.6f);
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

  // `thrown` is how far the block between faults has slipped.
  [[nodiscard]] Vec3 at(std::uint32_t border, float u, float v, float thrown) const {
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

private:
  std::array<Fold, 5> folds_;
  std::vector<float> borders_;
};

// Cuts a rectangle into `pieces`, each time across its longer side, about in proportion.
void cut(const Rectangle& r, std::uint32_t pieces, Random& random, std::vector<Rectangle>& out) {
  if (pieces == 1) {
    out.push_back(r);
    return;
  }
  const std::uint32_t first = pieces / 2;
  const float share = std::clamp(
      static_cast<float>(first) / static_cast<float>(pieces) + random.between(-0.12f, 0.12f), 0.2f, 0.8f);
  Rectangle a = r, b = r;
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
Vec3 scaled(const Vec3& a) {
  return {kScale * a.x, kScale * a.y, kScale * a.z};
}
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// A piece of a stratum: six sheets of quads, each with its own vertices, facing outwards.
class Piece {
public:
  std::vector<Vec3> positions, normals;
  std::vector<std::uint32_t> indices;

  // `point(i, j)` runs counter-clockwise from i to j as seen from outside.
  template <class Point>
  void add_sheet(std::uint32_t columns, std::uint32_t rows, const Point& point) {
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
};

// `triangles` shared out as 4nm + 4n + 4m with n quads along u and m along v, in proportion to the sides.
std::pair<std::uint32_t, std::uint32_t> quads(const Rectangle& r, double triangles) {
  const double ratio = (r.u1 - r.u0) / (r.v1 - r.v0);
  const double along_v =
      std::max(1.0, std::sqrt(triangles / 4 / ratio + 0.25 * (1 + 1 / ratio) * (1 + 1 / ratio)) -
                        0.5 * (1 + 1 / ratio));
  const auto m = static_cast<std::uint32_t>(std::lround(along_v));
  const double along_u = (triangles - 4.0 * m) / (4.0 * m + 4.0);
  return {static_cast<std::uint32_t>(std::lround(std::max(1.0, along_u))), m};
}

// A piece before it is made.
struct PlannedPiece {
  Rectangle area;
  std::uint32_t layer;
  float thrown;
  std::uint32_t columns, rows;  // quads along u and v
};

struct Plan {
  Ground ground;
  std::vector<PlannedPiece> pieces;
};

void add_piece(Scene& scene, const Ground& ground, const PlannedPiece& planned) {
  const Rectangle& r = planned.area;
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
  Piece piece;
  // u, v and up are (x, z, y): u × v points down, so the top runs v before u.
  piece.add_sheet(m, n, [&](U j, U i) { return point(1, i, j); });
  piece.add_sheet(n, m, [&](U i, U j) { return point(0, i, j); });
  piece.add_sheet(1, n, [&](U up, U i) { return point(up, i, 0); });
  piece.add_sheet(n, 1, [&](U i, U up) { return point(up, i, m); });
  piece.add_sheet(m, 1, [&](U j, U up) { return point(up, 0, j); });
  piece.add_sheet(1, m, [&](U up, U j) { return point(up, n, j); });
  scene.add_object(scene.add_mesh(piece.positions, piece.normals, piece.indices),
                   place(scaled(middle), kScale));
}

Plan plan_strata(const Parameters& parameters) {
  const Model& model = kModels[parameters.count("model") - 1];
  double triangles = parameters.number("triangles");
  if (triangles == 0) triangles = model.triangles / 100;
  if (parameters.word("full") == "yes") triangles = model.triangles;

  Random random(parameters.count("seed"));
  Plan plan{Ground(random, model.layers), {}};
  std::vector<Rectangle> blocks;
  std::array<std::array<float, kFaults + 2>, 2> faults;
  for (auto& across : faults) {
    for (std::uint32_t i = 0; i < across.size(); ++i) {
      const bool border = i == 0 || i + 1 == across.size();
      const float even = static_cast<float>(i) / static_cast<float>(kFaults + 1) - 0.5f;
      across[i] = kSide * (even + (border ? 0 : random.between(-0.06f, 0.06f)));
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
  std::vector<Rectangle> pieces;
  for (std::uint32_t share = 0; share < shares; ++share) {
    const std::uint32_t layer = share / static_cast<std::uint32_t>(blocks.size());
    const std::uint32_t block = share % static_cast<std::uint32_t>(blocks.size());
    pieces.clear();
    const std::uint64_t meshes = model.meshes;
    cut(blocks[block], static_cast<std::uint32_t>(meshes * (share + 1) / shares - meshes * share / shares),
        random, pieces);
    for (const Rectangle& piece : pieces) {
      const auto [columns, rows] = quads(piece, triangles / model.meshes);
      plan.pieces.push_back({piece, layer, thrown[block], columns, rows});
    }
  }
  return plan;
}

Scene make_strata(const Parameters& parameters) {
  const Plan plan = plan_strata(parameters);
  Scene scene;
  for (const PlannedPiece& piece : plan.pieces) add_piece(scene, plan.ground, piece);

  // Centred on the origin, as the paper has it.
  const Box all = extent(scene);
  for (ObjectId object = 0; object < scene.size(); ++object) {
    Affine moved = scene.transform[object];
    moved.rows[0].w -= 0.5f * (all.min.x + all.max.x);
    moved.rows[1].w -= 0.5f * (all.min.y + all.max.y);
    moved.rows[2].w -= 0.5f * (all.min.z + all.max.z);
    scene.move_object(object, moved);
  }
  scene.viewpoints.push_back(
      {"near", scaled({0.1f * kSide, 0.25f * kSide, 0.8f * kSide}), {-0.1f, -0.25f, -0.6f}});
  scene.viewpoints.push_back({"far", kPaperViewpoint, {-1, 0, 0}});
  return scene;
}

}  // namespace

const WorldInfo kStrataWorld{"strata", "layered, faulted and folded ground (Ye et al. 2023)",
                             kStrataParameters, make_strata};

StrataCount count_strata(std::string_view specification) {
  const Plan plan = plan_strata(parse_parameters("world", specification, kStrataParameters));
  StrataCount count;
  for (const PlannedPiece& piece : plan.pieces) {
    // Two sheets each of columns × rows, columns × 1 and rows × 1 quads, with vertices of their own.
    const std::uint64_t n = piece.columns, m = piece.rows;
    ++count.meshes;
    count.triangles += 4 * (n * m + n + m);
    count.vertices += 2 * ((n + 1) * (m + 1) + 2 * (n + 1) + 2 * (m + 1));
  }
  return count;
}

}  // namespace sightline::scene
