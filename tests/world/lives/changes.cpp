#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/snapshots.hpp"
#include "support/solid_boxes.hpp"
#include "world/lives/operations.hpp"

namespace sightline::lives {
namespace {

// Holds what was given, and is no larger than half a millimetre and single precision make it.
void expect_stored(const WorldBox& given, const WorldBox& stored) {
  const auto axis = [](double low, double high, double stored_low, double stored_high) {
    const double rounding = 1e-15 * (std::fabs(low) + std::fabs(high));
    const double most = rounding + 5.1e-4 + 4e-7 * (high - low);
    ASSERT_LE(stored_low, low + rounding);
    ASSERT_GE(stored_high, high - rounding);
    ASSERT_GE(stored_low, low - most);
    ASSERT_LE(stored_high, high + most);
  };
  axis(given.min.x, given.max.x, stored.min.x, stored.max.x);
  axis(given.min.y, given.max.y, stored.min.y, stored.max.y);
  axis(given.min.z, given.max.z, stored.min.z, stored.max.z);
}

void note_stored(Life& life, Object& object) {
  object.stored = life.world().box(object.handle);
  expect_stored(object.given, object.stored);
  for (const auto& lane : life.lanes) ASSERT_EQ(lane->world.box(object.handle), object.stored);
}

// Ids are free and generations new.
void put_all(Life& life, const std::vector<Object>& objects) {
  for (const Object& object : objects) {
    const Handle handle = object.handle;
    if (handle.index < life.model.objects.size()) {
      const Handle before = life.model.objects[handle.index].handle;
      ASSERT_EQ(before.index, kNoObject) << "given twice: " << handle.index;
      ASSERT_GE(handle.generation, before.generation) << "a handle is used again";
    }
    life.model.put(object);
    note_stored(life, life.model.objects[handle.index]);
    if (testing::Test::HasFailure()) return;
  }
}

enum class Way { step, near, anywhere, nowhere };

WorldBox moved(Life& life, const WorldBox& box, Way way) {
  if (way == Way::nowhere) return box;
  if (way == Way::anywhere) return life.any_box();
  const WorldPoint middle{0.5 * (box.min.x + box.max.x), 0.5 * (box.min.y + box.max.y),
                          0.5 * (box.min.z + box.max.z)};
  if (way == Way::near) return life.any_box(&middle);
  const double metres = any_of(life.random, {0.01, 0.3, 2.0, 30.0});
  const double x = within(life.random, metres), y = within(life.random, metres),
               z = within(life.random, metres);
  return {{box.min.x + x, box.min.y + y, box.min.z + z}, {box.max.x + x, box.max.y + y, box.max.z + z}};
}

void move(Life& life, const std::vector<ObjectId>& who, Way way) {
  std::vector<WorldBox> boxes;
  for (const ObjectId id : who) boxes.push_back(moved(life, life.model.objects[id].given, way));
  const LaidOut to = life.lay_out(std::move(boxes));
  const std::vector<Handle> handles = life.model.handles(who);
  life.each([&](Lane& lane) { return lane.world.move(handles, to.view); });
  for (std::size_t i = 0; i < who.size(); ++i) {
    life.model.objects[who[i]].given = to.given[i];
    life.model.note_size(to.given[i]);
  }
  for (const ObjectId id : who) {
    note_stored(life, life.model.objects[id]);
    if (testing::Test::HasFailure()) return;
  }
  life.note_change(who);
}

void shuffle(Random& random, std::vector<ObjectId>& ids) {
  for (std::size_t i = ids.size(); i > 1; --i) std::swap(ids[i - 1], ids[below(random, i)]);
}

// Some of all, or those that always move, listed as before or in another order.
std::vector<ObjectId> any_movers(Life& life) {
  Random& random = life.random;
  const std::size_t count = life.model.all().size();
  const std::uint32_t who = random.below(10);
  if (who < 4) {
    std::vector<ObjectId>& crew = life.crew;
    std::erase_if(crew, [&](ObjectId id) { return !life.model.has(id); });
    if (crew.empty() || one_in(random, 12)) crew = life.model.some(random, 1 + below(random, count));
    if (one_in(random, 3)) shuffle(random, crew);
    return crew;
  }
  if (who < 6) return life.model.all();
  return life.model.some(random, 1 + (who < 8 ? random.below(20) : below(random, count)));
}

// A frame ends with a cull, and begins with what moves.
template <class Begin>
void frames(Life& life, std::uint32_t count, const Begin& begin) {
  const CullView view{.view = life.any_view()};
  for (; count > 0 && !testing::Test::HasFailure(); --count) {
    for (const auto& lane : life.lanes) ask(lane->plain, lane->world, {&view, 1}, {}, {.masks = false});
    begin();
  }
}

// As columns take them: an element an object.
template <class Any>
auto for_each_of(const std::vector<ObjectId>& ids, const Any& any) {
  std::vector<decltype(any())> out;
  for (std::size_t i = 0; i < ids.size(); ++i) out.push_back(any());
  return out;
}

void add_table(Life& life) {
  std::vector<float> sizes;
  float size = std::exp(life.random.between(0.5f, 6.5f));
  for (std::uint32_t i = 1 + life.random.below(7); i > 0; --i) {
    sizes.push_back(size);
    size *= life.random.between(0.2f, 0.9f);
  }
  life.each([&](Lane& lane) {
    const Result<LevelTableId> table = lane.world.add_levels(sizes);
    EXPECT_TRUE(table && *table == life.model.tables.size());
    return table.error();
  });
  life.model.tables.push_back(sizes);
}

}  // namespace

void insert(Life& life) {
  const std::size_t standing = life.model.standing.size(), most = life.plan.objects;
  const std::size_t room = standing < most ? most - standing : 3;
  insert(life, one_in(life.random, 3) ? room : 1 + below(life.random, room));
}

void insert(Life& life, std::size_t count) {
  Random& random = life.random;
  std::vector<WorldBox> boxes;
  for (std::size_t i = 0; i < count; ++i) boxes.push_back(life.any_box());
  const LaidOut laid = life.lay_out(std::move(boxes));
  std::vector<std::uint32_t> layers, values;
  std::vector<DistanceRange> distances;
  ObjectColumns columns;
  for (std::size_t i = 0; i < count; ++i) {
    layers.push_back(life.any_layers());
    values.push_back(random.below(1'000'000));
    distances.push_back(life.any_range());
  }
  if (life.plan.columns && one_in(random, 2)) columns.layers = layers;
  if (life.plan.columns && one_in(random, 2)) columns.values = values;
  if (life.plan.columns && one_in(random, 2)) columns.distances = distances;
  std::vector<Handle> handles(count), others(count);
  life.each([&](Lane& lane) {
    const Status done = lane.world.insert(laid.view, others, columns);
    if (&lane == &life.first()) handles = others;
    EXPECT_EQ(others, handles);
    return done;
  });
  std::vector<Object> objects(count);
  for (std::size_t i = 0; i < count; ++i) {
    Object& object = objects[i];
    object.handle = handles[i], object.given = laid.given[i];
    object.value = columns.values.size() > 0 ? values[i] : handles[i].index;
    if (columns.layers.size() > 0) object.layers = layers[i];
    if (columns.distances.size() > 0) object.distances = distances[i];
    object.changed = life.streaming.has_value();
  }
  put_all(life, objects);
}

void remove(Life& life) {
  const std::size_t count = life.model.all().size();
  if (one_in(life.random, 12)) return remove(life, count);
  remove(life, one_in(life.random, 4) ? count / 2 : 1 + life.random.below(10));
}

void remove(Life& life, std::size_t count) {
  const std::vector<ObjectId> who = life.model.some(life.random, count);
  const std::vector<Handle> handles = life.model.handles(who);
  life.each([&](Lane& lane) { return lane.world.remove(handles); });
  life.model.take_out(who);
  for (const ObjectId id : who) ASSERT_FALSE(life.world().contains(life.world().handle(id)));
}

void move(Life& life) {
  Random& random = life.random;
  if (life.model.all().empty()) return;
  std::vector<ObjectId> who = any_movers(life);
  // Some are listed twice.
  if (one_in(random, 5) && !who.empty())
    for (std::size_t more = 1 + below(random, who.size()); more > 0; --more)
      who.push_back(who[below(random, who.size())]);
  const auto way = one_in(random, 12)   ? Way::anywhere
                   : one_in(random, 6)  ? Way::near
                   : one_in(random, 30) ? Way::nowhere
                                        : Way::step;
  move(life, who, way);
}

void step(Life& life, const std::vector<ObjectId>& who) {
  move(life, who, Way::step);
}

// Frames in which few or none move, so that others settle.
void rest(Life& life) {
  const std::vector<ObjectId> few = life.model.some(life.random, life.random.below(20));
  frames(life, any_of<std::uint32_t>(life.random, {3, 10, 40, 150}), [&] { step(life, few); });
}

// Frames in which the same, or others each time, go on and on, so that they come to stand with what moves.
void keep_moving(Life& life) {
  Random& random = life.random;
  const std::size_t count = life.model.all().size();
  if (count == 0) return;
  std::vector<ObjectId> who = life.model.some(random, 1 + below(random, count));
  const bool others = one_in(random, 2);
  const auto way = any_of(random, {Way::step, Way::step, Way::near, Way::anywhere});
  frames(life, 2 + random.below(8), [&] {
    if (others) who = life.model.some(random, who.size());
    move(life, who, way);
  });
}

void give_columns(Life& life) {
  Random& random = life.random;
  if (!life.plan.columns) return;
  const std::size_t standing = life.model.standing.size();
  const std::vector<ObjectId> who =
      life.model.some(random, one_in(random, 3) ? standing : 1 + random.below(20));
  const std::vector<Handle> handles = life.model.handles(who);
  const auto of = [&](std::size_t i) -> Object& { return life.model.objects[who[i]]; };
  if (const std::uint32_t column = random.below(5); column == 0) {
    const auto layers = for_each_of(who, [&] { return life.any_layers(); });
    life.each([&](Lane& lane) { return lane.world.set_layers(handles, layers); });
    for (std::size_t i = 0; i < who.size(); ++i) of(i).layers = layers[i];
  } else if (column == 1) {
    const auto values = for_each_of(who, [&] { return random.below(1u << 30); });
    life.each([&](Lane& lane) { return lane.world.set_values(handles, values); });
    for (std::size_t i = 0; i < who.size(); ++i) of(i).value = values[i];
  } else if (column == 2) {
    const auto distances = for_each_of(who, [&] { return life.any_range(); });
    life.each([&](Lane& lane) { return lane.world.set_distances(handles, distances); });
    for (std::size_t i = 0; i < who.size(); ++i) of(i).distances = distances[i];
  } else {
    if (life.model.tables.size() < 5) add_table(life);
    const auto count = static_cast<std::uint32_t>(life.model.tables.size());
    const auto tables = for_each_of(who, [&] { return random.below(count); });
    life.each([&](Lane& lane) { return lane.world.set_levels(handles, tables); });
    for (std::size_t i = 0; i < who.size(); ++i) of(i).table = tables[i];
  }
  life.note_change(who);
}

// Some carry a box that fills their own, or no more; or they are switched, or tell their triangles.
void carry(Life& life) {
  Random& random = life.random;
  if (!life.plan.occluders) return;
  const std::vector<ObjectId> who = life.model.some(random, 1 + random.below(20));
  const std::vector<Handle> handles = life.model.handles(who);
  if (one_in(random, 4)) {
    const auto on = for_each_of(who, [&] { return static_cast<std::uint8_t>(random.below(2)); });
    return life.each([&](Lane& lane) { return lane.world.set_occluding(handles, on); });
  }
  const bool none = one_in(random, 6);
  std::vector<Box> boxes;
  std::vector<WorldPoint> origins;
  for (const ObjectId id : who) {
    const WorldBox& box = life.model.objects[id].given;
    origins.push_back(box.min);
    boxes.push_back({{0, 0, 0},
                     {static_cast<float>(box.max.x - box.min.x), static_cast<float>(box.max.y - box.min.y),
                      static_cast<float>(box.max.z - box.min.z)}});
  }
  if (one_in(random, 3)) {
    for (std::size_t i = 0; i < who.size(); ++i) {
      std::vector<Vec3> corners;
      if (!none) corners = {boxes[i].min, boxes[i].max, {boxes[i].max.x, 0, 0}};
      life.each([&](Lane& lane) { return lane.world.set_triangles(handles[i], corners, origins[i]); });
    }
    return;
  }
  life.each([&](Lane& lane) {
    std::vector<OccluderPlacement> placements;
    for (std::size_t i = 0; i < who.size(); ++i) {
      placements.push_back(test::filling(boxes[i], none ? kNoOccluder : lane.occluder));
      placements.back().origin = origins[i];
    }
    return lane.world.set_occluders(handles, placements);
  });
}

void move_the_world(Life& life) {
  for (const auto& lane : life.lanes) {
    World elsewhere(std::move(lane->world));
    lane->world = std::move(elsewhere);
  }
}

void check_all(Life& life) {
  for (const auto& lane : life.lanes) {
    expect_objects(lane->world, life.model, life.model.standing);
    test::expect_sound(lane->world);
  }
}

}  // namespace sightline::lives
