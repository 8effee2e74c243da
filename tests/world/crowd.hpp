// A world, what stands in it and what moves, frame by frame.
#pragma once

#include <sightline/world.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <vector>

#include "library/world/world_state.hpp"
#include "support/random_views.hpp"
#include "support/snapshots.hpp"
#include "support/world_twin.hpp"
#include "workbench/scene/random.hpp"

namespace sightline::test {

inline std::size_t movers_of(const World& world) {
  std::size_t count = 0;
  for (const world::Sector& sector : WorldAccess::state(world).sectors)
    count += sector.map ? sector.map->movers() : 0;
  return count;
}

inline std::size_t sectors_with_pages(const World& world) {
  std::size_t count = 0;
  for (const world::Sector& sector : WorldAccess::state(world).sectors)
    count += sector.map && sector.map->keeps_pages();
  return count;
}

inline bool keeps_pages(const World& world) {
  return sectors_with_pages(world) > 0;
}

inline constexpr Box kOneSector{{-1000, -50, -1000}, {1000, 50, 1000}},
    kTwoSectors{{-1000, -50, -1000}, {1800, 50, 1000}};

// How boxes are given.
enum class Form { structs, arrays, doubles, centre_half };
inline constexpr std::array kForms{Form::structs, Form::arrays, Form::doubles, Form::centre_half};

// Boxes in one of the forms, and what they are in that form.
class Given {
public:
  Given(std::span<const Box> boxes, Form form) : form_(form), boxes_(boxes.begin(), boxes.end()) {
    for (const Box& b : boxes) {
      arrays_.push_back(b), wide_.push_back(wide(b));
      const auto middle = [](float low, float high) { return 0.5f * (low + high); };
      things_.push_back({{middle(b.min.x, b.max.x), middle(b.min.y, b.max.y), middle(b.min.z, b.max.z)},
                         {middle(-b.min.x, b.max.x), middle(-b.min.y, b.max.y), middle(-b.min.z, b.max.z)}});
      if (form != Form::centre_half) continue;
      const auto& [c, h] = things_.back();
      const auto at = [](float centre, float half) { return double{centre} + double{half}; };
      wide_.back() = {{at(c.x, -h.x), at(c.y, -h.y), at(c.z, -h.z)},
                      {at(c.x, h.x), at(c.y, h.y), at(c.z, h.z)}};
    }
  }
  [[nodiscard]] BoxView view() const {
    switch (form_) {
      case Form::structs:
        return BoxView(boxes_);
      case Form::arrays:
        return arrays_.view();
      case Form::doubles:
        return BoxView(wide_);
      default:
        return BoxView::centre_half(&things_[0].centre.x, &things_[0].half.x, sizeof(Thing), things_.size());
    }
  }
  [[nodiscard]] const WorldBox& operator[](std::size_t i) const { return wide_[i]; }

private:
  struct Thing {
    Vec3 centre, half;
  };
  Form form_;
  std::vector<Box> boxes_;
  Boxes arrays_;
  std::vector<WorldBox> wide_;
  std::vector<Thing> things_;
};

// A world and what stands in it, frame by frame.
class Crowd {
public:
  Crowd(std::uint32_t seed, const Box& around) : random_(seed), around_(around) {}

  void insert(std::size_t count) {
    std::vector<WorldBox> boxes;
    for (std::size_t i = 0; i < count; ++i) boxes.push_back(wide(test::random_box(random_, around_)));
    std::vector<Handle> handles(count);
    ASSERT_TRUE(world_.insert(boxes, handles));
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_TRUE(twin_.emplace(handles[i].index, boxes[i]).second);
      standing_.push_back(handles[i]);
    }
  }

  // Those from first on, in the order in which they stand in the list; after `round` of it from its begin.
  void move(std::size_t first, std::size_t count, float by) { move(first, count, by, standing_.size()); }
  void move(std::size_t first, std::size_t count, float by, std::size_t round) {
    std::vector<Handle> handles;
    std::vector<Box> boxes;
    for (std::size_t i = first; i < first + count; ++i) {
      const Handle handle = standing_[i % round];
      const WorldBox& old = twin_[handle.index];
      const auto x = static_cast<float>(old.min.x), y = static_cast<float>(old.min.y),
                 z = static_cast<float>(old.min.z);
      const Vec3 at = by > 0 ? Vec3{x + random_.between(-by, by), y, z + random_.between(-by, by)}
                             : random_.inside(around_);
      const auto side = [](double low, double high) { return static_cast<float>(high - low); };
      boxes.push_back({at,
                       {at.x + side(old.min.x, old.max.x), at.y + side(old.min.y, old.max.y),
                        at.z + side(old.min.z, old.max.z)}});
      handles.push_back(handle);
    }
    const Given given(boxes, form_);
    ASSERT_TRUE(world_.move(handles, given.view()));
    for (std::size_t i = 0; i < handles.size(); ++i) twin_[handles[i].index] = given[i];
  }

  void give(Form form) { form_ = form; }
  // Where those that go anywhere go from now on.
  void go(const Box& around) { around_ = around; }

  // Lists them in another order.
  void shuffle() {
    for (std::size_t i = standing_.size(); i > 1; --i)
      std::swap(standing_[i - 1], standing_[random_.below(static_cast<std::uint32_t>(i))]);
  }

  // Lists others first, as many, in the order of their ids.
  void choose(std::size_t count) {
    shuffle();
    std::sort(standing_.begin(), standing_.begin() + static_cast<std::ptrdiff_t>(count),
              [](Handle a, Handle b) { return a.index < b.index; });
  }

  void remove(std::size_t count) {
    std::vector<Handle> handles;
    for (; count > 0 && !standing_.empty(); --count) {
      std::swap(standing_[random_.below(static_cast<std::uint32_t>(standing_.size()))], standing_.back());
      handles.push_back(standing_.back());
      twin_.erase(standing_.back().index);
      standing_.pop_back();
    }
    ASSERT_TRUE(world_.remove(handles));
  }

  void expect_right() {
    std::vector<WorldView> views;
    for (std::size_t v = 1 + random_.below(3); v > 0; --v)
      views.push_back({test::random_view(random_, around_), {}});
    test::expect_right(world_, culler_, twin_, views, 0.02);
  }

  // To within what sectors round them by.
  void expect_boxes() {
    for (const Handle handle : standing_) {
      const WorldBox is = world_.box(handle), &was = twin_[handle.index];
      ASSERT_NEAR(is.min.x, was.min.x, 1e-3) << handle.index;
      ASSERT_NEAR(is.max.z, was.max.z, 1e-3) << handle.index;
    }
  }

  void cull() {
    std::vector<ObjectId> visible(cull_capacity(world_));
    (void)test::cull(culler_, world_, test::cull_views(std::array{WorldView{*make_view({}, 64, 64), {}}}),
                     visible);
  }

  [[nodiscard]] const World& world() const { return world_; }
  [[nodiscard]] std::size_t size() const { return standing_.size(); }
  scene::Random& random() { return random_; }

private:
  scene::Random random_;
  Box around_;
  Form form_ = Form::structs;
  World world_;
  Culler culler_;
  std::map<ObjectId, WorldBox> twin_;
  std::vector<Handle> standing_;
};

}  // namespace sightline::test
