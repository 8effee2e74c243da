// A world that moves beside its flat peer: the same float boxes written at their ids into arrays, then the
// best flat loop. Frame by frame the two take turns at the same moves and the same view, in one process and
// on one thread; means are over all frames, those in which the world settles included.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <tuple>

#include <sightline/frustum.hpp>
#include <sightline/world.hpp>

#include "judged.hpp"
#include "thread_time.hpp"
#include "workbench/scene/random.hpp"
#include "world_case.hpp"

namespace sightline::benchmarks {
namespace {

enum class Where { nearby, anywhere };
enum class Whom { same, anew };         // each frame
enum class Order { by_id, by_chance };  // in which they are listed
enum class Form { corners, centre_half, doubles };

struct Protocol {
  std::size_t objects = 1'000'000, moved = 0;
  Where where = Where::nearby;
  Whom whom = Whom::same;
  Order order = Order::by_id;
  int frames = 600;
  Form form = Form::corners;  // in which the world is given them
  auto operator<=>(const Protocol&) const = default;
};

// An object as engines have it.
template <class Number>
struct Thing {
  std::array<Number, 3> centre, half;
  Handle handle;

  // No smaller than the box, whatever is rounded.
  static Thing of(const Box& b, Handle handle) {
    const auto middle = [](float low, float high) { return (Number{low} + Number{high}) / 2; };
    const auto size = [](float low, float high) {
      constexpr auto kRounding = static_cast<Number>(1e-6);
      return (Number{high} - Number{low}) / 2 + kRounding * (std::fabs(low) + std::fabs(high));
    };
    return {{middle(b.min.x, b.max.x), middle(b.min.y, b.max.y), middle(b.min.z, b.max.z)},
            {size(b.min.x, b.max.x), size(b.min.y, b.max.y), size(b.min.z, b.max.z)},
            handle};
  }
};

template <class Number>
Status move_things(World& world, const std::vector<Thing<Number>>& things) {
  const auto& first = things[0];
  return world.move(
      Strided<const Handle>(&first.handle, things.size(), sizeof first),
      BoxView::centre_half(first.centre.data(), first.half.data(), sizeof first, things.size()));
}

// Who moves, and where to.
struct Moves {
  std::vector<ObjectId> ids;
  std::vector<Handle> handles;
  std::vector<Box> boxes;
  std::vector<Thing<float>> things;
  std::vector<Thing<double>> double_things;
};

// One world and its flat peer, frame after frame.
class Race {
public:
  explicit Race(const Protocol& protocol) : protocol_(protocol), ids_(protocol.objects) {
    const Boxes& all = case_of(1'000'000).flat;
    flat_.reserve(protocol.objects);
    for (std::size_t i = 0; i < protocol.objects; ++i) flat_.push_back(all[i]), stand_.push_back(all[i]);
    handles_.resize(protocol.objects);
    or_throw(world_.insert(flat_.view(), handles_));
    visible_.resize(cull_capacity(world_)), flat_visible_.resize(protocol.objects + kCullPadding);
    std::iota(ids_.begin(), ids_.end(), 0u);
    draw_ids();
    // The first culls fetch and allocate.
    cull_world(), cull_flat();
  }

  // How long a frame took of the world, and of its peer.
  std::pair<double, double> frame() {
    if (protocol_.whom == Whom::anew) draw_ids();
    draw_boxes();
    std::pair<double, double> out;
    const auto of_world = [&] {
      out.first = milliseconds([&] {
        or_throw(move_world());
        cull_world();
      });
    };
    const auto of_flat = [&] {
      out.second = milliseconds([&] {
        for (std::size_t i = 0; i < moves_.ids.size(); ++i) flat_.set(moves_.ids[i], moves_.boxes[i]);
        cull_flat();
      });
    };
    if (++frames_ % 2 == 0) of_world();
    of_flat();
    if (frames_ % 2 == 1) of_world();
    return out;
  }

  // What the world's last answer lost, and kept for nothing.
  void judge_last(benchmark::State& state) const {
    judge(state, flat_, {&view_, 1}, std::span(visible_).first(count_));
    const double lost = state.counters["lost"], excess = state.counters["excess"];
    if (lost > 0 || excess > 10)
      state.SkipWithError(("lost " + std::to_string(lost) + ", in excess " + std::to_string(excess)).c_str());
  }

private:
  void draw_ids() {
    for (std::size_t i = 0; i < protocol_.moved; ++i) {
      const auto left = static_cast<std::uint32_t>(ids_.size() - i);
      std::swap(ids_[i], ids_[i + random_.below(left)]);
    }
    moves_.ids.assign(ids_.begin(), ids_.begin() + static_cast<std::ptrdiff_t>(protocol_.moved));
    if (protocol_.order == Order::by_id) std::sort(moves_.ids.begin(), moves_.ids.end());
    moves_.handles.clear();
    for (const ObjectId id : moves_.ids) moves_.handles.push_back(handles_[id]);
    moves_.boxes.resize(protocol_.moved);
  }

  void draw_boxes() {
    for (std::size_t i = 0; i < moves_.ids.size(); ++i) {
      Box& b = stand_[moves_.ids[i]];
      Vec3 by{random_.between(-1, 1), 0, random_.between(-1, 1)};
      if (protocol_.where == Where::anywhere) {
        const Vec3 to = random_.inside({{-kReach, -50, -kReach}, {kReach, 50, kReach}});
        by = {to.x - b.min.x, to.y - b.min.y, to.z - b.min.z};
      }
      b = {{b.min.x + by.x, b.min.y + by.y, b.min.z + by.z},
           {b.max.x + by.x, b.max.y + by.y, b.max.z + by.z}};
      moves_.boxes[i] = b;
    }
    if (protocol_.form == Form::centre_half) draw_things(moves_.things);
    if (protocol_.form == Form::doubles) draw_things(moves_.double_things);
  }

  template <class Number>
  void draw_things(std::vector<Thing<Number>>& things) {
    things.clear();
    for (std::size_t i = 0; i < moves_.ids.size(); ++i)
      things.push_back(Thing<Number>::of(moves_.boxes[i], moves_.handles[i]));
  }

  Status move_world() {
    if (protocol_.form == Form::centre_half) return move_things(world_, moves_.things);
    if (protocol_.form == Form::doubles) return move_things(world_, moves_.double_things);
    return world_.move(moves_.handles, BoxView(moves_.boxes));
  }

  void cull_world() { count_ = culler_.cull(world_, CullView{.view = {view_, {}}}, visible_)->count; }
  void cull_flat() { flat_count_ = *cull_boxes(make_frustum(view_), flat_.view(), flat_visible_); }

  Protocol protocol_;
  scene::Random random_{5};
  View view_ = looking(0.3f, tenth_of_view());
  // Where a simulation has its objects: drawn from the peer's arrays, moves would bring those into the cache.
  std::vector<Box> stand_;
  Boxes flat_;
  World world_;
  Culler culler_;
  std::vector<Handle> handles_;
  std::vector<ObjectId> ids_, visible_, flat_visible_;
  Moves moves_;
  std::size_t count_ = 0, flat_count_ = 0, frames_ = 0;
};

struct Outcome {
  double world = 0, flat = 0, worst = 0;  // means, and the world's slowest frame, ms
};

// Every run of a protocol does the same work frame by frame: what a frame took beyond the least of the runs,
// the machine did.
Outcome race(const Protocol& protocol, benchmark::State& state) {
  constexpr int kRuns = 2;
  std::vector<std::pair<double, double>> least(static_cast<std::size_t>(protocol.frames), {1e9, 1e9});
  for (int run = 0; run < kRuns; ++run) {
    Race race(protocol);
    for (auto& best : least) {
      const auto took = race.frame();
      best.first = std::min(best.first, took.first), best.second = std::min(best.second, took.second);
    }
    race.judge_last(state);
  }
  Outcome out;
  for (const auto& [world, flat] : least) {
    out.world += world / protocol.frames, out.flat += flat / protocol.frames;
    out.worst = std::max(out.worst, world);
  }
  return out;
}

enum class Side { world, flat, worst };

void movers(benchmark::State& state, const Protocol& protocol, Side side) {
  static std::map<Protocol, Outcome> outcomes;
  auto found = outcomes.find(protocol);
  if (found == outcomes.end()) found = outcomes.emplace(protocol, race(protocol, state)).first;
  const Outcome& out = found->second;
  for (auto _ : state)
    state.SetIterationTime((side == Side::world  ? out.world
                            : side == Side::flat ? out.flat
                                                 : out.worst) /
                           1e3);
}

void add(const std::string& name, const Protocol& protocol) {
  for (const auto& [side, of] :
       {std::pair{Side::world, "world"}, {Side::flat, "flat"}, {Side::worst, "worst_frame"}}) {
    benchmark::RegisterBenchmark((name + "/" + of).c_str(), movers, protocol, side)
        ->UseManualTime()
        ->Iterations(1)
        ->Unit(benchmark::kMillisecond);
  }
}

struct Share {
  std::size_t moved;
  const char* percent;
};
constexpr std::array kShares{Share{1000, "0.1"}, Share{10'000, "1"}, Share{100'000, "10"},
                             Share{500'000, "50"}, Share{1'000'000, "100"}};

void add_shares(const std::string& name, Protocol protocol) {
  for (const Share& share : kShares) {
    // Of all that are listed by id, another share drawn anew is the same.
    if (share.moved == protocol.objects && protocol.whom == Whom::anew && protocol.order == Order::by_id)
      continue;
    protocol.moved = share.moved;
    add(name + "/" + share.percent, protocol);
  }
}

void add_forms(const std::string& name, int frames) {
  for (const auto& [given, form] :
       {std::pair{"/centre_half", Form::centre_half}, {"/doubles", Form::doubles}}) {
    for (const Share& share : {kShares[2], kShares[4]})
      add(name + given + "/" + share.percent, {.moved = share.moved, .frames = frames, .form = form});
  }
}

// Those that begin with "short" run fewer frames.
const bool registered = [] {
  for (const auto& [length, frames] : {std::pair<std::string, int>{"movers", 600}, {"short", 60}}) {
    for (const auto& [listed, order] :
         {std::pair{"/by_id", Order::by_id}, {"/by_chance", Order::by_chance}}) {
      for (const auto& [of, where] : {std::pair{"/nearby", Where::nearby}, {"/anywhere", Where::anywhere}}) {
        for (const auto& [set, whom] : {std::pair{"/same", Whom::same}, {"/anew", Whom::anew}})
          add_shares(length + of + set + listed, {1'000'000, 0, where, whom, order, frames});
      }
      add(length + "/all_of_100000" + listed, {100'000, 100'000, Where::nearby, Whom::same, order, frames});
    }
  }
  add_forms("forms", 600), add_forms("short_forms", 60);
  return true;
}();

}  // namespace
}  // namespace sightline::benchmarks
