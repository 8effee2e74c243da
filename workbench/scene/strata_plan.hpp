// The plan of `world:strata`, and its pieces one by one: geology that is made wherever there is room for a
// piece at a time, a web page too.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <sightline/types.hpp>

#include "workbench/scene/random.hpp"

namespace sightline::scene {

/// One of the paper's five models.
struct StrataModel {
  std::uint32_t meshes, layers;
  double triangles;
};
/// Wuzhishan's geology and its strata, Purmont, Northeast Guizhou, and Guizhou overall (table 4).
inline constexpr std::array kStrataModels{StrataModel{1371, 12, 9234330}, StrataModel{2684, 16, 27512307},
                                          StrataModel{4433, 18, 46731152}, StrataModel{6744, 20, 263103774},
                                          StrataModel{17773, 28, 90415179}};

/// Metres in the scene for one of a piece: drawn so, the ground just fits into a picture from the paper's
/// viewpoint, 40 km away.
inline constexpr float kStrataScale = 12;
/// Of the square before it is folded.
inline constexpr float kStrataSide = 2000;

/// The shape of the ground: where a point (u, v) of a layer's border ends up.
class StrataGround {
public:
  StrataGround(Random& random, std::uint32_t layers);
  /// `thrown` is how far the block between faults has slipped.
  [[nodiscard]] Vec3 at(std::uint32_t border, float u, float v, float thrown) const;

private:
  struct Fold {
    float along_u, along_v, phase, height;
  };
  std::array<Fold, 5> folds_;
  std::vector<float> borders_;
};

struct StrataRectangle {
  float u0, v0, u1, v1;
};

/// A piece before it is made: a stratum's between two faults.
struct StrataPiece {
  StrataRectangle area;
  std::uint32_t layer;
  float thrown;
  std::uint32_t columns, rows;  ///< quads along u and v

  // Two sheets each of columns × rows, columns × 1 and rows × 1 quads, with vertices of their own.
  [[nodiscard]] std::uint64_t triangles() const noexcept {
    const std::uint64_t n = columns, m = rows;
    return 4 * (n * m + n + m);
  }
  [[nodiscard]] std::uint64_t vertices() const noexcept {
    const std::uint64_t n = columns, m = rows;
    return 2 * ((n + 1) * (m + 1) + 2 * (n + 1) + 2 * (m + 1));
  }
};

struct StrataPlan {
  StrataGround ground;
  std::vector<StrataPiece> pieces;  ///< one a mesh
};

/// `triangles` in all, about. Cost: some microseconds a piece.
StrataPlan plan_strata(const StrataModel& model, double triangles, std::uint64_t seed);

/// A closed mesh about `middle`, in units of kStrataScale metres: six sheets, facing outwards.
struct StrataMesh {
  Vec3 middle;
  std::vector<Vec3> positions, normals;
  std::vector<std::uint32_t> indices;
};
/// Makes a piece, in the memory of the one before.
void make_piece(const StrataGround& ground, const StrataPiece& planned, StrataMesh& out);

}  // namespace sightline::scene
