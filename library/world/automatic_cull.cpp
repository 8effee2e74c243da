#include "library/world/automatic_cull.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <vector>

#include <sightline/occlusion.hpp>

#include "library/geometry/mutant.h"
#include "library/world/mask_counts.hpp"
#include "library/world/occluder_picks.hpp"

namespace sightline::world {

namespace {

// What is remembered from frame to frame.
struct Memory {
  std::array<OccluderPicks, kMaxViews> picks;           // by the place of the caller's view
  std::array<const OccluderPicks*, kMaxViews> drawn{};  // what was drawn for each place: equal views share
  std::array<Tries, kMaxViews> tries;                   // of each, where there are several
  Tries more{3};                                        // of drawing more, which is cheap
  std::vector<std::uint32_t> hidden;                    // of PassInput
  std::vector<std::uint8_t> seen;                       // what the triangles of each object left of its mask
  std::size_t asking = 0;                               // how many objects' triangles are asked, of the first
  std::uint32_t parts = 0;                              // in so many jobs
};

// One frame's try: look for occluders, draw them, ask for chunks, for objects, for their triangles; draw more
// for what that saved, and ask again. Each step is begun only where the purse affords all of it.
class Try {
public:
  Try(CullerState& state, Memory& memory, std::span<const CullView> views, const DifferentViews& different,
      const CullOptions& options, const CullCosts& costs, CullResult& result)
      : state_(state),
        memory_(memory),
        views_(views),
        different_(different),
        jobs_(options.jobs),
        buffer_(options.buffer),
        costs_(costs),
        result_(result),
        masks_(state.masks),
        before_(count_drawn(state, result.count)),
        purse_(state.account.allowance(result.frustum_cost)) {
    for (std::size_t d = 0; d < different_.count; ++d) in_view_[d] = count_seen(d);
  }

  void run() {
    hide();
    const std::uint64_t gone = before_ - drawn();
    result_.culled_occlusion = gone;
    result_.cost += purse_.spent() - static_cast<double>(gone) * double{costs_.object};
  }

private:
  void hide() {
    if (SIGHTLINE_MUTANT(automatic_by_frustum) || !draw_occluders()) return;
    if (cull_again()) {
      ask_triangles();
      while (draw_and_ask_more()) {
      }
      remember();
    }
    learn_who_pays();
  }

  [[nodiscard]] std::uint64_t drawn() const { return count_drawn(state_, result_.count); }
  // Of what is left: what the view, or where nobody tells them apart some view, sees.
  [[nodiscard]] std::uint64_t count_seen(std::size_t d) const {
    return masks_ ? count_with({masks_, result_.count}, different_.bits[d]) : result_.count;
  }

  // Some of the views, and what they saw before anything was hidden, once for each: no more are asked for.
  struct Asked {
    std::size_t views = 0;
    double in_view = 0;
  };
  [[nodiscard]] Asked with(Asked some, std::size_t d) const {
    return {some.views + 1, some.in_view + static_cast<double>(in_view_[d])};
  }
  [[nodiscard]] Asked drawn_views() const {
    Asked out;
    for (std::size_t d = 0; d < different_.count; ++d) out = drawn_[d] ? with(out, d) : out;
    return out;
  }

  [[nodiscard]] bool draw_occluders() {
    const Zone zone(state_.zones, "sightline: draw occluders");
    for (const GroupEntry& entry : state_.entries) {
      const ChunkMap::Group& group = state_.maps[entry.sector]->groups()[entry.group];
      chunks_ += group.count, objects_ += group.objects;
    }
    // The first ones first, but those that lately did not pay.
    std::array<std::size_t, kMaxViews> order;
    std::size_t count = 0;
    for (std::size_t d = 0; d < different_.count; ++d) {
      Tries& tries = memory_.tries[different_.first[d]];
      if (different_.count == 1 || tries.begin(static_cast<double>(in_view_[d]))) order[count++] = d;
    }
    draw_for_some({order.data(), count});
    return drawn_views().views > 0;
  }

  // The same for each of as many as may be asked for their objects; then the rest for those to whom that was
  // too little, and for others.
  void draw_for_some(std::span<const std::size_t> views) {
    if (views.empty()) return;
    Asked alike = with({}, views[0]);
    while (alike.views < views.size()) {
      const Asked more = with(alike, views[alike.views]);
      if (!(kept_back(more) < purse_.left())) break;
      alike = more;
    }
    std::array<bool, kMaxViews> served{};
    const double share = (purse_.left() - kept_back(alike)) / static_cast<double>(alike.views);
    for (std::size_t i = 0; i < alike.views; ++i) served[i] = draw_for(views[i], share);
    for (std::size_t i = 0; i < views.size() && different_.count > 1; ++i)
      if (!served[i]) draw_for(views[i], purse_.left() - kept_back(with(drawn_views(), views[i])));
  }

  // What asking some views takes: their chunks, and all their objects if that leaves as much for drawing; and
  // what may be too little for all their triangles, but enough to begin with. The rest is written again in
  // any case. Chunks alone for several are not worth it.
  [[nodiscard]] double kept_back(const Asked& some) const {
    const double views = static_cast<double>(some.views);
    // Of chunks in view, as a rule: those that were tested, and those that were not and so are seen.
    const double in_chunks = static_cast<double>(result_.tested) + static_cast<double>(result_.count) * views,
                 object_views = std::min(static_cast<double>(objects_) * views, in_chunks);
    const double chunks =
        static_cast<double>(chunks_) * (2 * double{costs_.node} + views * double{costs_.query});
    const double least = chunks + object_views * double{costs_.test};
    const double whole = least + std::min(object_views, some.in_view) * double{costs_.query};
    constexpr double kForTriangles = 0.1;
    if (2 * whole <= purse_.left())
      return whole + std::min(triangles_cost(some.in_view), kForTriangles * (purse_.left() - whole));
    return some.views == 1 ? least : std::numeric_limits<double>::infinity();
  }

  // False where that was too little.
  bool draw_for(std::size_t d, double share) {
    using Drawn = OccluderPicks::Drawn;
    if (!(share > 0)) return false;
    const std::size_t place = different_.first[d];
    OccluderPicks& picks = memory_.picks[place];
    const double before = purse_.left();
    const Drawn drawn = picks.draw(*state_.world, views_[place], state_.distance_eyes[place],
                                   {state_.out, result_.count}, buffer_, costs_, share, purse_);
    drawn_[d] = drawn == Drawn::some, spent_[d] += before - purse_.left();
    for (std::size_t v = place; drawn_[d] && v < views_.size(); ++v)
      if (different_.bits[d] >> v & 1) memory_.drawn[v] = &picks;
    return drawn != Drawn::too_dear;
  }

  void set_occluders(bool ask) {
    for (std::size_t s = 0; s < state_.maps.size(); ++s) {
      for (std::size_t d = 0; d < different_.count; ++d) {
        if (!drawn_[d]) continue;
        SectorView& view = state_.views[s * different_.count + d];
        const std::size_t place = different_.first[d];
        const occlusion::DepthTiles& tiles = OcclusionAccess::tiles(memory_.picks[place].buffer());
        view.occluders = ask ? &tiles : nullptr;
        if (ask) view.projection = occlusion::eye_projection(tiles.view, state_.origins[s], tiles.scale);
      }
    }
  }

  // What hidden chunks save for certain: known where masks tell views apart, or there is only one.
  [[nodiscard]] double saving(const ChunkTally& tally) const {
    if (!masks_ && different_.count > 1) return 0;
    const int copies = masks_ ? 1 : std::popcount(different_.bits[0]);
    return static_cast<double>(tally.saved) / copies * double{costs_.object};
  }

  bool cull_again() {
    const Zone zone(state_.zones, "sightline: ask for what is hidden");
    const double nodes = static_cast<double>(chunks_) * double{costs_.node};
    const Asked drawn_for = drawn_views();
    const double asking = nodes + static_cast<double>(chunks_ * drawn_for.views) * double{costs_.query};
    if (!purse_.affords(asking)) return false;
    set_occluders(true);
    std::vector<std::uint32_t>& hidden = memory_.hidden;
    hidden.reserve(state_.entries.capacity() * different_.count);
    hidden.resize(state_.entries.size() * different_.count);
    const ChunkTally tally = find_hidden_chunks(state_.input, state_.entries, hidden.data());
    purse_.pay(nodes + static_cast<double>(tally.asked) * double{costs_.query});
    const double sure = std::max(0.0, saving(tally) - earned_);
    purse_.earn(sure);
    const double least = nodes + static_cast<double>(tally.left) * double{costs_.test};
    const double whole =
        least + std::min(static_cast<double>(tally.left), drawn_for.in_view) * double{costs_.query};
    const bool objects = purse_.affords(whole);
    // Without them what they hid before would come back.
    if (!objects && (tally.hidden == 0 || earned_ > 0 || !purse_.affords(least))) {
      purse_.earn(-sure);
      return false;
    }
    if (!objects) set_occluders(false);
    purse_.pay(objects ? whole : least);
    state_.input.hidden = hidden;
    CullResult again;
    run_passes(state_, jobs_, again);
    result_.count = again.count;
    result_.tested += again.tested;
    result_.nodes_visited += again.nodes_visited + chunks_;
    purse_.earn(-sure);
    earn_hidden();
    return true;
  }

  // What is hidden by now, as far as it was not earned before.
  void earn_hidden() {
    const double saved = static_cast<double>(before_ - drawn()) * double{costs_.object};
    purse_.earn(saved - earned_);
    earned_ = saved;
  }

  // A frame of few objects affords few of a large mesh's triangles at first; what these hide pays for more.
  // Whether that paid.
  bool draw_and_ask_more() {
    const double spent = purse_.spent(), earned = earned_, size = static_cast<double>(drawn());
    const auto worth_more = [&](std::size_t d) {
      return drawn_[d] && memory_.picks[different_.first[d]].worth_more();
    };
    std::size_t count = 0;
    double drawing = 0;
    for (std::size_t d = 0; d < different_.count; ++d) count += worth_more(d), drawing += spent_[d];
    // No more than what that can save, and not for a little more than there was.
    constexpr double kLeastMore = 1.5, kMostShare = 0.25;
    const double most =
        std::min(purse_.left() - kept_back(drawn_views()), kMostShare * size * double{costs_.object});
    if (count == 0 || !(most > kLeastMore * drawing) || !memory_.more.begin(size)) return false;
    for (std::size_t d = 0; d < different_.count; ++d) {
      if (!worth_more(d)) continue;
      const std::size_t place = different_.first[d];
      const double before = purse_.left();
      memory_.picks[place].draw_on(*state_.world, views_[place], state_.distance_eyes[place], costs_,
                                   most / static_cast<double>(count), purse_);
      spent_[d] += before - purse_.left();
    }
    // What triangles hid would come back with all others of its chunk.
    if (has_triangles())
      ask_triangles();
    else
      cull_again();
    const bool paid = earned_ - earned > purse_.spent() - spent;
    if (paid)
      memory_.more.paid();
    else
      memory_.more.failed(size);
    return paid;
  }

  // --- triangles ---

  [[nodiscard]] bool has_triangles() const { return state_.world->occluders->triangle_count > 0; }
  // As a rule, of so many objects.
  [[nodiscard]] double triangles_cost(double objects) const {
    if (!has_triangles()) return 0;
    const double each = static_cast<double>(state_.world->occluders->triangle_count) /
                        static_cast<double>(state_.world->size);
    return objects * (double{costs_.candidate} + each * double{costs_.occludee});
  }
  [[nodiscard]] std::uint64_t triangles_of(ObjectId id) const {
    const WorldOccluders& o = *state_.world->occluders;
    const std::uint32_t set = o.triangle_set(id);
    return set == kNothing ? 0 : o.triangles[set].count;
  }

  void ask_triangles() {
    const Zone zone(state_.zones, "sightline: ask for triangles");
    const double looking = static_cast<double>(result_.count) * double{costs_.candidate};
    if (!has_triangles() || !purse_.affords(looking)) return;
    purse_.pay(looking);
    const double each = static_cast<double>(different_.count) * double{costs_.occludee};
    std::size_t count = 0;
    for (; count < result_.count; ++count) {
      const double cost = static_cast<double>(triangles_of(state_.out[count])) * each;
      if (!purse_.affords(cost)) break;
      purse_.pay(cost);
    }
    if (memory_.seen.size() < count) memory_.seen.resize(state_.world->size);
    memory_.asking = count;
    constexpr std::size_t kWorthAJob = 64;
    memory_.parts = static_cast<std::uint32_t>(
        std::clamp<std::size_t>(count / kWorthAJob, 1, jobs_.run ? jobs_.threads : 1));
    if (memory_.parts > 1) {
      jobs_.run(jobs_.user, memory_.parts, ask_part, this);
    } else {
      ask_part(this, 0);
    }
    keep_seen();
  }

  static constexpr std::size_t kAtOnce = 64;  // objects

  static void ask_part(void* data, std::uint32_t part) {
    const auto& self = *static_cast<const Try*>(data);
    Memory& memory = self.memory_;
    const std::size_t count = memory.asking, first = count * part / memory.parts,
                      end = count * (part + 1) / memory.parts;
    for (std::size_t at = first; at < end; at += kAtOnce)
      self.find_views_that_see(at, std::min(kAtOnce, end - at));
  }

  // Of objects from the first on: bits of the masks that their triangles leave; without masks, any or none.
  void find_views_that_see(std::size_t first, std::size_t count) const {
    std::uint8_t* const seen = &memory_.seen[first];
    std::array<std::uint8_t, kAtOnce> all;
    std::uint8_t asked = 0;
    for (std::size_t d = 0; d < different_.count; ++d) asked |= different_.bits[d];
    for (std::size_t i = 0; i < count; ++i) seen[i] = all[i] = masks_ ? masks_[first + i] & asked : asked;
    for (std::size_t d = 0; d < different_.count; ++d) {
      if (drawn_[d]) ask_of_view(d, first, count, seen);
    }
    // Found last, for most are seen: whether the triangles are where the object is.
    const WorldOccluders& o = *state_.world->occluders;
    for (std::size_t i = 0; i < count; ++i) {
      if (seen[i] == all[i]) continue;
      const ObjectId id = state_.out[first + i];
      const ObjectTriangles& set = o.triangles[o.triangle_set(id)];
      if (!stands(set.bounds, set.origin, set.object_box, stored_box(*state_.world, id))) seen[i] = all[i];
    }
  }

  void ask_of_view(std::size_t d, std::size_t first, std::size_t count, std::uint8_t* seen) const {
    const WorldOccluders& o = *state_.world->occluders;
    const std::size_t place = different_.first[d];
    std::array<occlusion::TriangleRun, kAtOnce> runs;
    std::array<std::uint8_t, kAtOnce> whose, sees;
    std::size_t size = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t at = o.triangle_set(state_.out[first + i]);
      if (at == kNothing || (seen[i] & different_.bits[d]) == 0) continue;
      const ObjectTriangles& set = o.triangles[at];
      if (!(set.origin == views_[place].view.origin)) continue;
      whose[size] = static_cast<std::uint8_t>(i);
      runs[size++] = {set.blocks.data(), set.count, set.sides};
    }
    const occlusion::DepthTiles& tiles = OcclusionAccess::tiles(memory_.picks[place].buffer());
    occlusion::query_triangles(tiles, std::span(runs).first(size), sees.data());
    for (std::size_t i = 0; i < size; ++i) {
      if (!sees[i]) seen[whose[i]] &= static_cast<std::uint8_t>(~different_.bits[d]);
    }
  }

  void keep_seen() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < result_.count; ++i) {
      state_.out[kept] = state_.out[i];
      const bool asked = i < memory_.asking;
      if (masks_) masks_[kept] = asked ? memory_.seen[i] : masks_[i];
      kept += !asked || memory_.seen[i] != 0;
    }
    result_.count = kept;
    earn_hidden();
  }

  // --- what helps the next frame ---

  void remember() {
    const double looking = static_cast<double>(result_.count) * double{costs_.candidate};
    if (!purse_.affords(looking)) return;
    purse_.pay(looking);
    auto& picks = memory_.picks;
    for (std::size_t d = 0; d < different_.count; ++d) picks[different_.first[d]].begin_seen();
    for (std::size_t i = 0; i < result_.count; ++i) {
      const std::uint32_t carrier = state_.world->occluders->carrier(state_.out[i]);
      if (carrier == kNothing) continue;
      for (std::size_t d = 0; d < different_.count; ++d)
        if (!masks_ || (masks_[i] & different_.bits[d]) != 0) picks[different_.first[d]].saw(carrier);
    }
  }

  // Which views' tries paid; of several alone who has masks knows.
  void learn_who_pays() {
    if (!masks_ || different_.count == 1) return;
    for (std::size_t d = 0; d < different_.count; ++d) {
      if (!drawn_[d]) continue;
      const auto seen = static_cast<double>(in_view_[d]);
      const int copies = std::popcount(different_.bits[d]);
      const double saved = (seen - static_cast<double>(count_seen(d))) * copies * double{costs_.object},
                   asked = (static_cast<double>(chunks_) + seen) * double{costs_.query};
      Tries& tries = memory_.tries[different_.first[d]];
      if (saved < spent_[d] + asked)
        tries.failed(seen);
      else
        tries.paid();
    }
  }

  CullerState& state_;
  Memory& memory_;
  std::span<const CullView> views_;
  const DifferentViews& different_;
  const JobSystem& jobs_;
  const OcclusionOptions& buffer_;
  const CullCosts& costs_;
  CullResult& result_;
  std::uint8_t* masks_;  // the caller's
  std::uint64_t before_, chunks_ = 0, objects_ = 0;
  std::array<std::uint64_t, kMaxViews> in_view_{};  // what each view sees by frustum
  std::array<double, kMaxViews> spent_{};           // on drawing for it
  double earned_ = 0;                               // in the purse already, of what is hidden
  std::array<bool, kMaxViews> drawn_{};
  Purse purse_;
};

class Automatic final : public Hiding {
public:
  void hide(CullerState& state, std::span<const CullView> views, const DifferentViews& different,
            const CullOptions& options, const CullCosts& costs, CullResult& result) override {
    Try(state, memory_, views, different, options, costs, result).run();
  }
  void forget_drawn() noexcept override { memory_.drawn.fill(nullptr); }
  [[nodiscard]] const OccluderPicks* drawn(std::size_t place) const noexcept override {
    return memory_.drawn[place];
  }

private:
  Memory memory_;
};

}  // namespace

std::unique_ptr<Hiding> make_hiding() {
  return std::make_unique<Automatic>();
}

}  // namespace sightline::world
