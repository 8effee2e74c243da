// Blocks of towers between streets, with what stands on them: from the street little of it is seen.
#include <algorithm>
#include <array>
#include <cmath>

#include "workbench/scene/city_parts.hpp"
#include "workbench/scene/worlds.hpp"

namespace sightline::scene {

namespace {

constexpr std::uint32_t kPerBlock = 100;
constexpr float kPitch = 90, kBlock = 70,
                kLot = kBlock / 4;  ///< metres: a block with its street, without, a lot
constexpr float kStreetEyeHeight = 1.7f;

constexpr std::array kCityParameters{
    ParameterInfo{"objects", "how many, about a hundred a block", "10000", 100, 1000000, true},
    ParameterInfo{"height", "metres, of the tallest tower", "120", 20, 1000},
    ParameterInfo{"seed", "of the random numbers", "1", 0, 4294967295.0, true},
};

/// One block: ground, towers side by side around a court, then what stands on roofs, walls and pavements.
class Block {
public:
  Block(CityParts& parts, const Vec3& centre, float tallest, Random& random, std::uint32_t quota)
      : parts_(parts), centre_(centre), tallest_(tallest), random_(random), left_(quota) {}

  void build() {
    add(CityPart::ground, centre_, {kPitch, 1, kPitch}, {});
    std::array<float, 12> heights{};
    // Neighbours are of a kind: low houses, or a few towers.
    const float low = random_.between(10, 20), reach = tallest_ - low, share = random_.unit();
    for (std::size_t lot = 0; lot < heights.size(); ++lot) {
      const float u = random_.unit();
      heights[lot] = low + std::max(reach, 0.0f) * share * u * u;
      add(CityPart::tower, lot_centre(lot), {kLot, heights[lot], kLot}, {});
    }
    for (std::size_t lot = 0; lot < heights.size(); ++lot) add_to_tower(lot, heights[lot]);
    while (left_ > 0) add_furniture();
  }

private:
  void add(CityPart part, const Vec3& at, const Vec3& scale, const Turn& turn) {
    if (left_ == 0) return;
    parts_.add(part, placed(at, scale, turn));
    --left_;
  }

  /// Twelve lots around a court of four.
  static std::array<int, 2> cell_of(std::size_t lot) noexcept {
    static constexpr std::array<std::array<int, 2>, 12> kCells{
        {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {3, 3}, {2, 3}, {1, 3}, {0, 3}, {0, 2}, {0, 1}}};
    return kCells[lot];
  }
  /// The street that a lot looks at: a quarter turn whose +z leads there.
  static const Turn& outwards(std::size_t lot) noexcept {
    const auto [x, z] = cell_of(lot);
    return kQuarterTurns[z == 0 ? 2 : z == 3 ? 0 : x == 0 ? 3 : 1];
  }
  [[nodiscard]] Vec3 lot_centre(std::size_t lot) const noexcept {
    const auto [x, z] = cell_of(lot);
    return {centre_.x + kLot * (static_cast<float>(x) - 1.5f), 0,
            centre_.z + kLot * (static_cast<float>(z) - 1.5f)};
  }
  /// A point before the lot's wall: `out` metres from it, `along` to its right, `up` over the ground.
  [[nodiscard]] Vec3 before(std::size_t lot, float out, float along, float up) const noexcept {
    const Vec3 c = lot_centre(lot);
    const Turn& turn = outwards(lot);
    const float z = 0.5f * kLot + out;
    return {c.x + turn.c * along + turn.s * z, up, c.z - turn.s * along + turn.c * z};
  }

  void add_to_tower(std::size_t lot, float height) {
    Vec3 roof = lot_centre(lot);
    roof.y = height;
    const float width = random_.between(3, 0.8f * kLot), rise = random_.between(2, 0.3f * height);
    add(CityPart::roof, roof, {width, rise, width}, {});
    const float along = random_.between(-0.4f * kLot, 0.4f * kLot);
    const Turn& turn = outwards(lot);
    switch (random_.below(4)) {
      case 0:  // a sign that stands out from the wall, read from both sides
        add(CityPart::sign, before(lot, 0.6f, along, 3), {1, random_.between(1, 4), 1}, {-turn.s, turn.c});
        break;
      case 1:
        add(CityPart::awning, before(lot, 0.7f, 0, 2.8f), {random_.between(3, 0.9f * kLot), 1, 1.4f}, turn);
        break;
      case 2:
        add(CityPart::balcony, before(lot, 0.6f, along, random_.between(3, 0.9f * height)), {3, 1, 1.2f},
            turn);
        break;
      default: {
        roof.y = height;
        add(CityPart::billboard, roof, {random_.between(4, 0.9f * kLot), random_.between(2, 5), 1}, turn);
      }
    }
  }

  void add_furniture() {
    const std::size_t lot = random_.below(12);
    const Turn& turn = outwards(lot);
    const float along = random_.between(-0.5f * kLot, 0.5f * kLot), size = random_.between(0.8f, 1.2f);
    const Vec3 curb = before(lot, 2.8f, along, 0), wall = before(lot, 0.6f, along, 0);
    switch (random_.below(12)) {
      case 0:
        return add(CityPart::lamp, curb, {size, size, size}, turn);
      case 1:
        return add(CityPart::bench, wall, {1.8f * size, size, size}, turn);
      case 2:
        return add(CityPart::bin, curb, {size, size, size}, turn);
      case 3:
        return add(CityPart::shelter, before(lot, 1.8f, along, 0), {3, size, 1}, turn);
      case 4:
      case 5:
      case 6:
        return add(CityPart::car, before(lot, 5, along, 0), {size, size, size}, {-turn.s, turn.c});
      case 7:
        return add(CityPart::fence, before(lot, 3.2f, along, 0), {3, 1, 1}, turn);
      case 8:
        return add(CityPart::hoarding, wall, {2.5f, 2, 1}, turn);
      default:
        return add_tree(lot, along);
    }
  }

  /// On the pavement, or in the court.
  void add_tree(std::size_t lot, float along) {
    const float height = random_.between(4, 9);
    const bool in_court = random_.below(2) == 0;
    const float court = 0.8f * kLot;
    Vec3 at = before(lot, 3, along, 0);
    if (in_court) {
      at = {centre_.x + random_.between(-court, court), 0, centre_.z + random_.between(-court, court)};
    }
    const Turn turn = random_turn(random_);
    add(CityPart::trunk, at, {0.05f * height, height, 0.05f * height}, turn);
    add(CityPart::crown, {at.x, 0.35f * height, at.z}, {0.6f * height, 0.65f * height, 0.6f * height}, turn);
  }

  CityParts& parts_;
  Vec3 centre_;
  float tallest_;
  Random& random_;
  std::uint32_t left_;
};

void add_places(Scene& scene, std::uint32_t side, float tallest) {
  const auto street = [&](std::uint32_t number) {
    return kPitch * (static_cast<float>(number) - 0.5f * static_cast<float>(side));
  };
  const std::uint32_t middle = side / 2;
  const float x = street(middle), half = 0.5f * kPitch * static_cast<float>(side);
  scene.viewpoints.push_back({"street", {x, kStreetEyeHeight, street(middle) + 0.5f * kPitch}, {0, 0, -1}});
  scene.viewpoints.push_back({"crossing", {x, kStreetEyeHeight, street(middle)}, {1, 0, -1}});
  scene.viewpoints.push_back(
      {"pavement", {x + 8, kStreetEyeHeight, street(middle) + 0.5f * kPitch}, {0.2f, 0.1f, 1}});
  scene.viewpoints.push_back(
      {"court", {x + 0.5f * kPitch, kStreetEyeHeight, street(middle) + 0.5f * kPitch}, {-1, 0.3f, 0}});
  scene.viewpoints.push_back({"over the roofs", {x, tallest + 20, half}, {0, -0.3f, -1}});
  scene.viewpoints.push_back({"aerial", {-half, tallest + half, half}, {1, -1, -1}});
  const std::uint32_t first = middle - std::min(middle, 4u), last = std::min(side, middle + 4);
  for (std::uint32_t row = first; row <= last; ++row) {
    for (std::uint32_t column = first; column <= last; ++column)
      scene.waypoints.push_back({street(column), kStreetEyeHeight, street(row)});
  }
}

Scene make_city(const Parameters& parameters) {
  Scene scene;
  CityParts parts(scene);
  const std::uint64_t objects = parameters.count("objects");
  const auto side =
      static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(objects) / kPerBlock)));
  const std::uint64_t blocks = std::uint64_t{side} * side;
  const float tallest = static_cast<float>(parameters.number("height"));
  Random random(parameters.count("seed"));
  scene.bounds.reserve(objects);
  for (std::uint64_t b = 0; b < blocks; ++b) {
    const auto at = [&](std::uint64_t number) {
      return kPitch * (static_cast<float>(number) + 0.5f - 0.5f * static_cast<float>(side));
    };
    const auto quota = static_cast<std::uint32_t>(objects * (b + 1) / blocks - objects * b / blocks);
    Block(parts, {at(b % side), 0, at(b / side)}, tallest, random, quota).build();
  }
  add_places(scene, side, tallest);
  return scene;
}

}  // namespace

const WorldInfo kCityWorld{"city", "streets between towers, with all that stands on them", kCityParameters,
                           make_city};

}  // namespace sightline::scene
