#include "workbench/io/quake3_entities.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "library/geometry/elementary.hpp"

namespace sightline::io::quake3 {

namespace {

// The player's origin is 24 units over the floor, the eye 26 over the origin.
constexpr float kEyeOverOrigin = 26;

class Tokens {
public:
  explicit Tokens(std::string_view text) : text_(text.substr(0, text.find('\0'))) {}

  /// The next brace or quoted string (without its quotes); nothing at the end.
  std::optional<std::string_view> next() {
    at_ = text_.find_first_not_of(" \t\r\n", at_);
    if (at_ == std::string_view::npos) return {};
    quoted = text_[at_] == '"';
    if (!quoted) return text_.substr(at_++, 1);
    const std::size_t end = text_.find('"', at_ + 1);
    if (end == std::string_view::npos) {
      throw Error("the entities have a string without an end at byte " + std::to_string(at_));
    }
    const std::string_view token = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return token;
  }
  [[nodiscard]] std::string where() const {
    return " before byte " + std::to_string(std::min(at_, text_.size()));
  }

  bool quoted = false;

private:
  std::string_view text_;
  std::size_t at_ = 0;
};

/// Up to `out.size()` numbers separated by blanks; how many there were.
std::size_t parse_numbers(std::string_view text, std::span<float> out) {
  std::size_t count = 0;
  while (count < out.size()) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out[count]);
    if (error != std::errc{} || !std::isfinite(out[count])) break;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    ++count;
  }
  return count;
}

std::string_view value(const Entity& entity, std::string_view key) {
  const auto found = entity.find(key);
  return found == entity.end() ? std::string_view() : std::string_view(found->second);
}

/// Which way the entity looks: "angle" is a heading in degrees, "angles" is pitch, yaw, roll; pitch down.
Vec3 forward(const Entity& entity) {
  float pitch = 0, yaw = 0;
  std::array<float, 3> angles{};
  if (parse_numbers(value(entity, "angles"), angles) == 3) {
    pitch = angles[0], yaw = angles[1];
  } else if (parse_numbers(value(entity, "angle"), std::span(angles).first(1)) == 1) {
    yaw = angles[0];
  }
  constexpr float kRadians = std::numbers::pi_v<float> / 180;
  // Straight up or down has no heading; a camera needs one.
  pitch = std::clamp(std::remainder(pitch, 360.0f), -80.0f, 80.0f) * kRadians;
  yaw = std::remainder(yaw, 360.0f) * kRadians;
  return to_axes({portable::cos(pitch) * portable::cos(yaw), portable::cos(pitch) * portable::sin(yaw),
                  -portable::sin(pitch)});
}

bool starts_with_any(std::string_view name, std::initializer_list<std::string_view> prefixes) {
  for (std::string_view prefix : prefixes) {
    if (name.starts_with(prefix)) return true;
  }
  return false;
}

bool is_free(const LevelPvs& level, const Vec3& point) {
  return level.leaves[level.leaf_at(point)].cluster >= 0;
}

}  // namespace

std::vector<Entity> parse_entities(std::string_view text) {
  std::vector<Entity> entities;
  Tokens tokens(text);
  while (const auto open = tokens.next()) {
    if (tokens.quoted || *open != "{") throw Error("the entities lack a '{'" + tokens.where());
    Entity entity;
    while (true) {
      const auto key = tokens.next();
      if (!key) throw Error("the entities lack a '}'" + tokens.where());
      if (!tokens.quoted) {
        if (*key == "}") break;
        throw Error("the entities have '" + std::string(*key) + "' for a quoted key" + tokens.where());
      }
      const auto entry = tokens.next();
      if (!entry || !tokens.quoted) throw Error("the entities lack a quoted value" + tokens.where());
      entity.insert_or_assign(std::string(*key), std::string(*entry));
    }
    entities.push_back(std::move(entity));
  }
  return entities;
}

std::map<std::size_t, Float3> model_origins(const std::vector<Entity>& entities) {
  std::map<std::size_t, Float3> origins;
  for (const Entity& entity : entities) {
    const std::string_view model = value(entity, "model");
    Float3 origin;
    if (!model.starts_with('*') || parse_numbers(value(entity, "origin"), origin) != 3) continue;
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(model.data() + 1, model.data() + model.size(), number);
    if (error == std::errc{} && end == model.data() + model.size()) origins.insert_or_assign(number, origin);
  }
  return origins;
}

float far_plane(const std::vector<Entity>& entities) {
  for (const Entity& entity : entities) {
    if (value(entity, "classname") != "worldspawn") continue;
    std::array<float, 1> units{};
    const bool given = parse_numbers(value(entity, "_farplanedist"), units) == 1 && units[0] > 0;
    return given ? units[0] * kMetresPerUnit : std::numeric_limits<float>::infinity();
  }
  return std::numeric_limits<float>::infinity();
}

void add_places(const std::vector<Entity>& entities, Scene& scene) {
  std::map<std::string, int, std::less<>> numbers;
  for (const Entity& entity : entities) {
    Float3 origin;
    if (parse_numbers(value(entity, "origin"), origin) != 3) continue;
    const std::string name(value(entity, "classname"));
    const bool spawn = starts_with_any(name, {"info_player_", "team_CTF_redplayer", "team_CTF_blueplayer",
                                              "team_CTF_redspawn", "team_CTF_bluespawn"}) &&
                       name != "info_player_intermission";
    if (!spawn && name != "info_player_intermission" &&
        !starts_with_any(name, {"item_", "weapon_", "ammo_", "holdable_", "team_CTF_"})) {
      continue;
    }
    Vec3 eye = to_point({origin[0], origin[1], origin[2] + kEyeOverOrigin});
    if (name == "info_player_intermission" || !is_free(*scene.level, eye)) eye = to_point(origin);
    if (!std::isfinite(eye.x) || !std::isfinite(eye.y) || !std::isfinite(eye.z) ||
        !is_free(*scene.level, eye))
      continue;
    if (spawn || name == "info_player_intermission") {
      scene.viewpoints.push_back({name + "_" + std::to_string(++numbers[name]), eye, forward(entity)});
    }
    if (name != "info_player_intermission") scene.waypoints.push_back(eye);
  }
}

}  // namespace sightline::io::quake3
