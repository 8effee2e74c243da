// The meshes that occluders are made of in tests: closed and open, convex and not, thick and thin.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "workbench/scene/random.hpp"
#include "workbench/scene/shapes.hpp"

namespace sightline::test {

enum class Form { convex, concave, open, thin };

struct NamedMesh {
  std::string name;
  Form form;
  scene::Shape shape;
};

/// across × along quads over (0 … 1)², turned counter-clockwise where u runs to the right and v upwards;
/// the last column or row is the first where `round` or `closed` says so.
inline scene::Shape surface(std::uint32_t across, std::uint32_t along, bool round, bool closed,
                            const std::function<Vec3(float, float)>& at) {
  scene::Shape out;
  const std::uint32_t columns = across + !round, rows = along + !closed;
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i)
      out.positions.push_back(at(static_cast<float>(i) / static_cast<float>(across),
                                 static_cast<float>(j) / static_cast<float>(along)));
  }
  const auto index = [&](std::uint32_t i, std::uint32_t j) { return j % rows * columns + i % columns; };
  for (std::uint32_t j = 0; j < along; ++j) {
    for (std::uint32_t i = 0; i < across; ++i) {
      const std::uint32_t a = index(i, j), b = index(i + 1, j), c = index(i + 1, j + 1), d = index(i, j + 1);
      out.indices.insert(out.indices.end(), {a, b, c, a, c, d});
    }
  }
  return out;
}

inline scene::Shape moved(scene::Shape shape, const std::function<Vec3(const Vec3&)>& to) {
  for (Vec3& p : shape.positions) p = to(p);
  return shape;
}

inline Vec3 scaled(const Vec3& p, float by) {
  return {by * p.x, by * p.y, by * p.z};
}

inline scene::Shape together(scene::Shape a, const scene::Shape& b) {
  a.append(b);
  return a;
}

inline constexpr float kTurn = 2 * std::numbers::pi_v<float>;

/// A box whose sides are steps × steps quads.
inline scene::Shape fine_box(const Box& b, std::uint32_t steps) {
  scene::Shape out;
  for (int side = 0; side < 6; ++side) {
    const int a = side / 2;
    const bool up = side % 2 == 1;
    out.append(surface(steps, steps, false, false, [&](float u, float v) {
      float p[3];
      const float low[3] = {b.min.x, b.min.y, b.min.z}, high[3] = {b.max.x, b.max.y, b.max.z};
      const auto mix = [&](int axis, float t) { return low[axis] + t * (high[axis] - low[axis]); };
      p[a] = up ? high[a] : low[a];
      p[(a + 1) % 3] = mix((a + 1) % 3, up ? u : v), p[(a + 2) % 3] = mix((a + 2) % 3, up ? v : u);
      return Vec3{p[0], p[1], p[2]};
    }));
  }
  return out;
}

/// A tube about a closed curve.
inline scene::Shape tube(std::uint32_t along, std::uint32_t around, float radius,
                         const std::function<Vec3(float)>& centre) {
  return surface(around, along, true, true, [&](float u, float v) {
    const Vec3 p = centre(v), q = centre(v + 1e-3f);
    Vec3 t{q.x - p.x, q.y - p.y, q.z - p.z};
    t = scaled(t, 1 / std::sqrt(t.x * t.x + t.y * t.y + t.z * t.z));
    Vec3 s{t.z, 0, -t.x};
    s = scaled(s, 1 / std::sqrt(s.x * s.x + s.z * s.z));
    const Vec3 n{t.y * s.z - t.z * s.y, t.z * s.x - t.x * s.z, t.x * s.y - t.y * s.x};
    const float c = radius * std::cos(kTurn * u), d = -radius * std::sin(kTurn * u);
    return Vec3{p.x + c * n.x + d * s.x, p.y + c * n.y + d * s.y, p.z + c * n.z + d * s.z};
  });
}

/// Closed about the axis y: `profile` from the lower pole to the upper one, x the radius there.
inline scene::Shape turned(std::uint32_t sides, const std::vector<Vec3>& profile) {
  const auto rows = static_cast<std::uint32_t>(profile.size() - 1);
  return surface(sides, rows, true, false, [&](float u, float v) {
    const Vec3& p = profile[static_cast<std::size_t>(std::lround(v * static_cast<float>(rows)))];
    return Vec3{p.x * std::cos(kTurn * u), p.y, p.x * -std::sin(kTurn * u)};
  });
}

inline float hills(float x, float z) {
  return 0.25f + 0.12f * std::sin(5 * x + 1) * std::cos(4 * z) + 0.05f * std::sin(13 * x * z + 2);
}

/// Ground seen from above; `steps` × `steps` quads.
inline scene::Shape ground(std::uint32_t steps) {
  return surface(steps, steps, false, false, [](float u, float v) {
    return Vec3{u, hills(u, 1 - v), 1 - v};
  });
}

/// The same with walls down to its floor.
inline scene::Shape block_of_ground(std::uint32_t steps) {
  scene::Shape box = fine_box({{0, 0, 0}, {1, 1, 1}}, steps);
  return moved(std::move(box), [](const Vec3& p) { return Vec3{p.x, p.y * hills(p.x, p.z), p.z}; });
}

/// Loose triangles of all sizes and shapes that share corners: rims of every kind, folds, three at an edge.
inline scene::Shape loose_triangles(scene::Random& random, std::uint32_t corners, std::uint32_t triangles) {
  scene::Shape out;
  for (std::uint32_t i = 0; i < corners; ++i)
    out.positions.push_back(random.inside({{-1, -1, -1}, {1, 1, 1}}));
  for (std::uint32_t i = 0; i < 3 * triangles; ++i) out.indices.push_back(random.below(corners));
  return out;
}

inline std::vector<NamedMesh> closed_convex_meshes() {
  std::vector<NamedMesh> out;
  const auto add = [&](const char* name, scene::Shape shape) {
    out.push_back({name, Form::convex, std::move(shape)});
  };
  add("sphere", scene::sphere(3));
  add("fine sphere", scene::sphere(5));
  add("egg", moved(scene::sphere(4), [](const Vec3& p) {
        return Vec3{3 * p.x, p.y * (1 + 0.2f * p.y), 0.7f * p.z};
      }));
  add("fine box", fine_box({{-2, 0, 1}, {5, 3, 3}}, 20));
  add("turned box", moved(fine_box({{-2, -1, -1}, {2, 1, 1}}, 9), [](const Vec3& p) {
        return Vec3{0.8f * p.x - 0.6f * p.y, 0.6f * p.x + 0.8f * p.y, 0.28f * p.x + 0.96f * p.z};
      }));
  add("drum", turned(96, {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {2, 3, 0}, {0, 3, 0}}));
  add("post", turned(48, {{0, 0, 0}, {0.2f, 0, 0}, {0.18f, 2, 0}, {0.15f, 4, 0}, {0, 4, 0}}));
  add("cone", turned(128, {{0, 0, 0}, {2, 0, 0}, {1.5f, 1, 0}, {1, 2, 0}, {0, 4, 0}}));
  add("cushion", moved(scene::sphere(4), [](const Vec3& p) {
        const auto root = [](float x) { return std::copysign(std::sqrt(std::fabs(x)), x); };
        return Vec3{2 * root(p.x), 0.6f * root(p.y), 2 * root(p.z)};
      }));
  return out;
}

inline std::vector<NamedMesh> closed_concave_meshes() {
  std::vector<NamedMesh> out;
  const auto add = [&](const char* name, scene::Shape shape) {
    out.push_back({name, Form::concave, std::move(shape)});
  };
  add("ring", tube(64, 32, 0.4f, [](float v) { return Vec3{std::cos(kTurn * v), 0, std::sin(kTurn * v)}; }));
  add("rock", moved(scene::sphere(5), [](const Vec3& p) {
        return scaled(p, 1 + 0.12f * std::sin(5 * p.x + 1) * std::cos(6 * p.y) + 0.08f * std::sin(9 * p.z));
      }));
  add("star", moved(scene::sphere(5), [](const Vec3& p) {
        return scaled(p, 1 + 0.45f * std::sin(3 * p.x) * std::sin(4 * p.y + 1) * std::cos(3 * p.z));
      }));
  add("bell",
      turned(64, {{0, 0, 0}, {1, 0, 0}, {0.4f, 0.8f, 0}, {0.35f, 1.2f, 0}, {0.8f, 1.9f, 0}, {0, 2.2f, 0}}));
  add("bowl", turned(64, {{0, 0, 0},
                          {0.6f, 0.1f, 0},
                          {1, 0.6f, 0},
                          {1.1f, 1, 0},
                          {0.8f, 1, 0},
                          {0.7f, 0.7f, 0},
                          {0.4f, 0.4f, 0},
                          {0, 0.3f, 0}}));
  add("knot", tube(160, 16, 0.4f, [](float v) {
        const float t = kTurn * v, r = 2 + std::cos(3 * t);
        return Vec3{r * std::cos(2 * t), std::sin(3 * t), r * std::sin(2 * t)};
      }));
  add("ground block", block_of_ground(40));
  add("angle", moved(fine_box({{0, 0, 0}, {1, 1, 1}}, 24), [](const Vec3& p) {
        return Vec3{3 * p.x + 0.02f * std::sin(9 * p.y), 2 * p.y * (p.x < 0.4f ? 1.0f : 0.5f), p.z};
      }));
  add("two stones", together(moved(scene::sphere(4),
                                   [](const Vec3& p) {
                                     return Vec3{p.x - 2, 0.8f * p.y, p.z};
                                   }),
                             moved(scene::sphere(3), [](const Vec3& p) {
                               return Vec3{0.7f * p.x + 1, p.y, p.z + 1};
                             })));
  add("tower", together(fine_box({{-1, 0, -1}, {1, 4, 1}}, 8), moved(scene::sphere(3), [](const Vec3& p) {
                          return Vec3{1.5f * p.x, 4.5f + p.y, 1.5f * p.z};
                        })));
  return out;
}

inline std::vector<NamedMesh> open_meshes() {
  std::vector<NamedMesh> out;
  const auto add = [&](const char* name, scene::Shape shape) {
    out.push_back({name, Form::open, std::move(shape)});
  };
  add("card", scene::card(2, 3));
  add("fine wall", surface(20, 30, false, false, [](float u, float v) {
        return Vec3{4 * u, 3 * v, 0.3f * u};
      }));
  scene::Shape hut = fine_box({{0, 0, 0}, {4, 3, 5}}, 6);
  hut.indices.resize(hut.indices.size() - hut.indices.size() / 6);
  add("hut without a wall", std::move(hut));
  scene::Shape holed = scene::sphere(4);
  holed.indices.resize(holed.indices.size() - 30);
  add("sphere with a hole", std::move(holed));
  scene::Shape window = surface(24, 24, false, false, [](float u, float v) { return Vec3{u, v, 0}; });
  std::vector<std::uint32_t> kept;
  for (std::size_t q = 0; q < 576; ++q) {
    const std::size_t x = q % 24, y = q / 24;
    if (x >= 8 && x < 16 && y >= 6 && y < 18) continue;
    kept.insert(kept.end(), window.indices.begin() + static_cast<std::ptrdiff_t>(6 * q),
                window.indices.begin() + static_cast<std::ptrdiff_t>(6 * q + 6));
  }
  window.indices = std::move(kept);
  add("window", std::move(window));
  add("ground", ground(48));
  add("lid", turned(32, {{1, 0, 0}, {0.8f, 0.5f, 0}, {0.4f, 0.8f, 0}, {0, 0.9f, 0}}));
  return out;
}

/// Nothing of these occludes.
inline std::vector<NamedMesh> thin_meshes() {
  std::vector<NamedMesh> out;
  out.push_back({"wire", Form::thin, tube(400, 6, 0.004f, [](float v) {
                   const float t = kTurn * v, r = 2 + std::cos(7 * t);
                   return Vec3{r * std::cos(3 * t), std::sin(7 * t), r * std::sin(3 * t)};
                 })});
  scene::Shape grass;
  scene::Random random(4);
  for (std::uint32_t i = 0; i < 500; ++i) {
    const Vec3 p{random.unit(), 0, random.unit()};
    grass.positions.insert(grass.positions.end(), {p, {p.x + 0.01f, 0, p.z}, {p.x, 0.1f, p.z + 0.01f}});
    grass.indices.insert(grass.indices.end(), {3 * i, 3 * i + 1, 3 * i + 2});
  }
  out.push_back({"grass", Form::thin, std::move(grass)});
  return out;
}

}  // namespace sightline::test
