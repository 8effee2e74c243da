#include "workbench/measure/compare.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <sightline/workbench/error.hpp>

#include "workbench/measure/mover.hpp"
#include "workbench/measure/turns.hpp"
#include "workbench/submission/draw_list.hpp"

namespace sightline::measure {

namespace {

constexpr std::size_t kMostFinalists = 8;

/// What one subject's frames of one view took.
struct Samples {
  std::vector<double> cpu, gpu, occluders, frame;
  double spent = 0;  ///< milliseconds, warm-up included
};

/// Draws what it is told.
class Told final : public Method {
public:
  explicit Told(const Scene& scene) : Method(scene), draw_list_(scene) {}

  std::vector<ObjectId> visible;

  [[nodiscard]] Guarantee guarantee() const noexcept override { return Guarantee::exact; }
  void do_update(std::span<const ObjectId>) override {}
  void do_record(FrameContext& context) override {
    context.output.clear();
    context.output.visible.assign(visible.begin(), visible.end());
    draw_list_.build(scene_, context.view, context.output);
  }

private:
  submission::DrawList draw_list_;
};

/// The subject kLimit, on the bench for as long as this stands.
class Limit {
public:
  explicit Limit(Bench& bench) : bench_(bench) {
    auto method = std::make_unique<Told>(bench.scene());
    told_ = method.get();
    bench.add(std::string(kLimit), std::move(method));
  }
  ~Limit() { bench_.remove_last(); }
  Limit(const Limit&) = delete;
  Limit& operator=(const Limit&) = delete;

  void look(const View& view) {
    const oracle::ItemBuffer& seen = bench_.oracle().look(view);
    told_->visible.clear();
    for (ObjectId o = 0; o < seen.pixels.size(); ++o) {
      if (seen.sees(o)) told_->visible.push_back(o);
    }
  }

private:
  Bench& bench_;
  Told* told_;
};

void take(Samples& samples, const device::FrameTimes& times, bool drawn, device::Timed timed) {
  if (timed == device::Timed::passes) {
    samples.gpu.push_back(times.gpu_ms(device::PassKind::cull));
    samples.occluders.push_back(times.gpu_ms(device::PassKind::occluders));
    return;
  }
  samples.cpu.push_back(times.record_ms);
  if (drawn) samples.frame.push_back(times.frame_ms);
}

/// Whose turns they are, and what changes between them.
struct Contest {
  Bench& bench;
  std::optional<Limit> limit;
  Mover mover;
};

/// Subjects of one view by turns, each of which keeps its last answer.
void take_times(Contest& contest, std::span<const std::size_t> who, const View& view, std::size_t view_index,
                const MeasureOptions& options, std::span<Samples> samples) {
  using Timed = device::Timed;
  auto& [bench, limit, mover] = contest;
  if (limit) limit->look(view);
  const auto subjects = bench.subjects();
  // Where objects move, every frame is another answer.
  const bool drawn = bench.renderer() != nullptr, still = options.moving == 0;
  Turns turns(who.size(), 1 + view_index);
  const std::size_t whole_frames = options.warm_up + options.repeats,
                    frames = whole_frames + (drawn ? options.timed_passes : 0);
  for (std::size_t repeat = 0; repeat < frames; ++repeat) {
    const Timed timed = repeat < whole_frames ? Timed::frame : Timed::passes;
    if (!still) bench.update(mover.move());
    const bool counts = repeat >= options.warm_up;
    for (const std::size_t k : turns.next()) {
      const std::size_t m = who[k];
      const bool enough = !drawn && still && samples[m].spent > options.patience_ms;
      if (enough && (!counts || !samples[m].cpu.empty())) continue;
      if (drawn && still && counts && timed == Timed::frame) bench.run(subjects[m], view, timed);
      const device::FrameTimes times = bench.run(subjects[m], view, timed);
      samples[m].spent += times.record_ms;
      if (counts) take(samples[m], times, drawn, timed);
    }
  }
}

Row row_of(Bench& bench, Subject& subject, const View& view, std::size_t index, Samples& samples) {
  const oracle::Judgement judged = bench.judge(subject, view);
  Row row;
  row.method = subject.name;
  row.guarantee = subject.method->guarantee();
  row.view = index;
  row.stats = subject.frame.stats;
  row.stats.objects = bench.scene().size();
  row.kept = subject.frame.visible.size();
  row.truly_visible = judged.truly_visible;
  row.cull = timing_of(samples.cpu);
  if (bench.renderer()) {
    row.cull_gpu = timing_of(samples.gpu), row.frame = timing_of(samples.frame);
    row.occluders = timing_of(samples.occluders);
  }
  row.lost_objects = judged.loss.lost.size();
  row.lost_pixels = judged.loss.lost_pixels;
  row.excess_objects = judged.loss.excess.size();
  return row;
}

/// Eight, then the quicker four, then two, each round as long as the one before; the limit in all of them.
void run_finals(Contest& contest, MeasureOptions options, std::vector<std::vector<Samples>>& samples,
                Comparison& result) {
  options.timed_passes = 0;
  for (std::size_t most = kMostFinalists; most >= 2; most /= 2) {
    const std::vector<std::size_t> who = finalists(result, most);
    if (who.size() < 2) return;
    options.repeats = options.finals * kMostFinalists / most;
    for (std::size_t v = 0; v < samples.size(); ++v) {
      const View view = or_throw(make_view(result.cameras[v], options.width, options.height));
      take_times(contest, who, view, v, options, samples[v]);
      for (const std::size_t m : who) {
        Row& row = result.rows[v * result.methods.size() + m];
        row.cull = timing_of(samples[v][m].cpu), row.frame = timing_of(samples[v][m].frame);
      }
    }
  }
}

}  // namespace

std::vector<std::size_t> finalists(const Comparison& so_far, std::size_t most) {
  constexpr double kClose = 1.3;  // a few frames among many methods' tell no closer
  const std::size_t methods = so_far.methods.size();
  std::vector<double> frame(methods);
  for (std::size_t i = 0; i < so_far.rows.size(); ++i) {
    const Row& row = so_far.rows[i];
    const bool safe =
        row.lost_objects == 0 && row.guarantee != Guarantee::approximate && row.method != kLimit;
    frame[i % methods] += safe ? row.frame->median : std::numeric_limits<double>::infinity();
  }
  std::vector<std::size_t> order(methods);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t m) { return frame[m]; });
  const double slowest = kClose * frame[order.front()];
  std::erase_if(order, [&](std::size_t m) { return !(frame[m] <= slowest) || std::isinf(frame[m]); });
  order.resize(std::min(order.size(), most));
  const auto limit = std::ranges::find(so_far.methods, kLimit);
  if (!order.empty() && limit != so_far.methods.end())
    order.push_back(static_cast<std::size_t>(limit - so_far.methods.begin()));
  return order;
}

Comparison compare(Bench& bench, const camera::CameraPath& path, const MeasureOptions& options,
                   const Progress& progress) {
  if (options.limit && options.moving > 0) throw Error("--limit: expected objects that do not move");
  Contest contest{bench, {}, Mover(bench.scene(), options.moving, 1)};
  if (options.limit) contest.limit.emplace(bench);
  Comparison result;
  result.scene = bench.scene().name;
  result.raster_state = bench.scene().raster_state;
  result.path = path.name;
  result.machine = this_machine();
  result.device = bench.device_name();
  result.width = options.width, result.height = options.height;
  result.cameras = path.cameras;
  for (const Subject& subject : bench.subjects()) result.methods.push_back(subject.name);
  std::vector<std::size_t> all(result.methods.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::vector samples(path.cameras.size(), std::vector<Samples>(all.size()));
  for (std::size_t v = 0; v < path.cameras.size(); ++v) {
    const View view = or_throw(make_view(path.cameras[v], options.width, options.height));
    take_times(contest, all, view, v, options, samples[v]);
    for (const std::size_t m : all)
      result.rows.push_back(row_of(bench, bench.subjects()[m], view, v, samples[v][m]));
    if (progress) progress(v + 1, path.cameras.size());
  }
  if (bench.renderer() && options.finals > 0) run_finals(contest, options, samples, result);
  return result;
}

}  // namespace sightline::measure
