#include "world/lives/checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace sightline::lives {
namespace {

// A column with some room behind it that must stay as it is.
template <class T>
struct Column {
  Column(std::size_t count, bool asked) : room(asked ? count : 0), rows(asked ? count + kBehind : 0, kMark) {}

  [[nodiscard]] std::span<T> all() { return std::span(rows).first(room); }
  [[nodiscard]] std::vector<T> first(std::size_t count) {
    EXPECT_TRUE(std::all_of(rows.begin() + static_cast<std::ptrdiff_t>(room), rows.end(), [](T row) {
      return row == kMark;
    })) << "written beyond the room";
    rows.resize(std::min(count, room));
    return std::move(rows);
  }

  static constexpr std::size_t kBehind = 64;
  static constexpr T kMark = 0xc5;
  std::size_t room;
  std::vector<T> rows;
};

Verdict verdict_of(const Object& object, const CullView& view, const ViewTruth& own,
                   const ViewTruth& distances, double largest) {
  if ((object.layers & view.layers) == 0) return Verdict::unseen;
  const Verdict range = distances.in_range(object.stored, object.distances, view.distance_scale);
  const Verdict frustum = own.in_frustum(object.stored, largest);
  if (range == Verdict::unseen || frustum == Verdict::unseen) return Verdict::unseen;
  const bool dropped_by_more = view.min_area > 0 || view.occlusion != nullptr || view.casters != nullptr;
  if (range == Verdict::either || dropped_by_more) return Verdict::either;
  return frustum;
}

std::uint32_t level_of(const std::vector<float>& sizes, double pixels) {
  std::uint32_t level = 0;
  while (level < sizes.size() && pixels < double{sizes[level]}) ++level;
  return level;
}

// Whether it is too near to a limit, or to one times a factor, to say on which side it lies.
bool near_a_limit(const std::vector<float>& sizes, double pixels, double doubt, float hysteresis) {
  for (const double size : sizes)
    for (const double by : {-double{hysteresis}, 0.0, double{hysteresis}})
      if (std::fabs(pixels - size * (1 + by)) < doubt * pixels) return true;
  return doubt >= 1;
}

void expect_fade(const std::vector<float>& sizes, std::uint32_t level, double pixels, double doubt,
                 const LevelOptions& options, std::uint8_t fade) {
  double share = 0;
  if (options.fade > 0 && level < sizes.size()) {
    const double end = double{sizes[level]} * (1 + double{options.hysteresis});
    share = (end * (1 + double{options.fade}) - pixels) / (end * double{options.fade});
  }
  const double steep = 1 / std::max(double{options.fade}, 1e-3);
  ASSERT_NEAR(fade, 255 * std::clamp(share, 0.0, 1.0), 1.1 + steep * (0.1 + 2 * 255 * doubt));
}

}  // namespace

Answer ask(Culler& culler, const World& world, std::span<const CullView> views, const CullOptions& options,
           const Asked& asked) {
  const std::size_t room = cull_capacity(world, options);
  Column<std::uint32_t> ids(room, true);
  Column<std::uint8_t> masks(room, asked.masks), levels(room, asked.levels), fades(room, asked.fades);
  const Result<CullResult> result =
      culler.cull(world, views, options, {ids.all(), masks.all(), levels.all(), fades.all()});
  EXPECT_TRUE(result) << result.error().message();
  if (!result) return {};
  const std::size_t count = result->count;
  EXPECT_LE(count, room);
  return {*result, ids.first(count), masks.first(count), levels.first(count), fades.first(count)};
}

void expect_same(const Answer& expected, const Answer& found) {
  ASSERT_EQ(found.ids, expected.ids);
  ASSERT_EQ(found.masks, expected.masks);
  ASSERT_EQ(found.levels, expected.levels);
  ASSERT_EQ(found.fades, expected.fades);
  ASSERT_EQ(found.result.tested, expected.result.tested);
  ASSERT_EQ(found.result.nodes_visited, expected.result.nodes_visited);
  ASSERT_EQ(found.result.culled_occlusion, expected.result.culled_occlusion);
  ASSERT_EQ(found.result.cost, expected.result.cost);
}

std::vector<std::uint8_t> masks_by_id(const Model& model, std::span<const std::uint32_t> ids,
                                      std::span<const std::uint8_t> masks) {
  std::vector<std::uint8_t> out(model.objects.size());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    EXPECT_TRUE(model.has(ids[i])) << "nobody has the id " << ids[i];
    if (!model.has(ids[i])) return out;
    EXPECT_EQ(out[ids[i]], 0) << "written twice: " << ids[i];
    out[ids[i]] = masks.empty() ? 0xff : masks[i];
    EXPECT_NE(out[ids[i]], 0) << "written, but seen by nobody: " << ids[i];
  }
  return out;
}

Sight::Sight(std::span<const CullView> all) : views(all) {
  for (const CullView& view : views) truths.emplace_back(view.view);
}

Sight::Sight(std::span<const CullView> all, const InstancePlacement& placement, std::uint32_t of_the_instance)
    : views(all), layers(of_the_instance) {
  for (const CullView& view : views) truths.emplace_back(view.view, placement);
}

void expect_right(const Model& model, const Sight& sight, std::span<const std::uint8_t> masks, bool masked) {
  const std::size_t count = sight.views.size();
  const auto all = static_cast<std::uint8_t>((1u << count) - 1);
  for (const ObjectId id : model.standing) {
    const Object& object = model.objects[id];
    if (!object.in) continue;
    std::uint8_t seen = 0, unseen = 0;
    for (std::size_t v = 0; v < count; ++v) {
      const CullView& view = sight.views[v];
      const ViewTruth& eye = sight.truths[view.distance_view == kOwnView ? v : view.distance_view];
      Verdict verdict = verdict_of(object, view, sight.truths[v], eye, model.largest);
      if ((sight.layers & view.layers) == 0) verdict = Verdict::unseen;
      if (verdict == Verdict::seen) seen = static_cast<std::uint8_t>(seen | 1u << v);
      if (verdict == Verdict::unseen) unseen = static_cast<std::uint8_t>(unseen | 1u << v);
    }
    const std::uint8_t found = masks[id];
    const bool lost = masked ? (seen & ~found) != 0 : seen != 0 && found == 0;
    const bool kept = masked ? (unseen & found) != 0 || (found & ~all) != 0 : unseen == all && found != 0;
    if (!lost && !kept) continue;
    std::string depths;
    for (const ViewTruth& truth : sight.truths) depths += ' ' + std::to_string(truth.depth(object.stored));
    FAIL() << (lost ? "lost" : "kept") << " object " << id << ": mask " << int{found} << ", seen by "
           << int{seen} << ", unseen by " << int{unseen} << ", metres within the views:" << depths;
  }
}

void expect_right(const Model& model, std::span<const CullView> views, const Answer& answer) {
  expect_right(model, Sight(views), masks_by_id(model, answer.ids, answer.masks), !answer.masks.empty());
}

void LevelMemory::expect_right(const Model& model, std::span<const CullView> views,
                               const LevelOptions& options, const Answer& answer) {
  if (model.tables.size() == 1) {  // nothing is learned as long as there are no others
    ASSERT_EQ(std::count(answer.levels.begin(), answer.levels.end(), 0), std::ssize(answer.levels));
    return;
  }
  ++culls_;
  shown_.resize(std::max(shown_.size(), model.objects.size()));
  const ViewTruth truth(views[options.view].view);
  const double hysteresis = options.hysteresis;
  for (std::size_t i = 0; i < answer.ids.size(); ++i) {
    const Object& object = model.objects[answer.ids[i]];
    const std::vector<float>& sizes = model.tables[object.table];
    const double pixels = double{options.scale} * truth.pixels(object.stored);
    const double doubt = truth.pixels_doubt(object.stored);
    Shown& shown = shown_[answer.ids[i]];
    std::uint32_t expected = level_of(sizes, pixels);
    if (shown.cull + 1 == culls_ && !options.cut) {
      expected = std::min(shown.level, static_cast<std::uint32_t>(sizes.size()));
      while (expected > 0 && pixels >= double{sizes[expected - 1]} * (1 + hysteresis)) --expected;
      while (expected < sizes.size() && pixels < double{sizes[expected]} * (1 - hysteresis)) ++expected;
    }
    const std::uint32_t level = answer.levels[i];
    ASSERT_LE(level, sizes.size());
    if (!near_a_limit(sizes, pixels, doubt, options.hysteresis)) {
      ASSERT_EQ(level, expected) << "of object " << answer.ids[i] << " of " << pixels
                                 << " pixels, shown at level " << shown.level << " by cull " << shown.cull
                                 << ", now " << culls_;
      if (!answer.fades.empty()) expect_fade(sizes, level, pixels, doubt, options, answer.fades[i]);
    }
    shown = {level, culls_};
  }
}

void expect_level(const Model& model, ObjectId id, const ViewTruth& truth, std::uint8_t level) {
  const Object& object = model.objects[id];
  const std::vector<float>& sizes = model.tables[object.table];
  ASSERT_LE(level, sizes.size());
  const double pixels = truth.pixels(object.stored);
  if (!near_a_limit(sizes, pixels, truth.pixels_doubt(object.stored), 0))
    ASSERT_EQ(level, level_of(sizes, pixels)) << "of object " << id << " of " << pixels << " pixels";
}

void expect_objects(const World& world, const Model& model, std::span<const ObjectId> ids) {
  for (const ObjectId id : ids) {
    const Object& object = model.objects[id];
    ASSERT_EQ(world.contains(object.handle), object.in) << id;
    if (!object.in) continue;
    ASSERT_EQ(world.handle(id), object.handle);
    ASSERT_EQ(world.box(object.handle), object.stored) << id;
    ASSERT_EQ(world.layers(object.handle), object.layers) << id;
    ASSERT_EQ(world.value(object.handle), object.value) << id;
    ASSERT_EQ(world.distances(object.handle), object.distances) << id;
    ASSERT_EQ(world.levels(object.handle), object.table) << id;
  }
  for (const Handle stale : model.gone) {
    ASSERT_FALSE(world.contains(stale));
    ASSERT_EQ(world.box(stale), WorldBox{});
    ASSERT_EQ(world.layers(stale), 0u);
    ASSERT_EQ(world.value(stale), kNoObject);
    ASSERT_EQ(world.levels(stale), kNoLevels);
  }
  ASSERT_EQ(world.size(), model.all().size());
}

}  // namespace sightline::lives
