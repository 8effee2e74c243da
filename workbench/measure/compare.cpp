#include "workbench/measure/compare.hpp"

#include <sightline/workbench/error.hpp>

#include "workbench/measure/mover.hpp"
#include "workbench/submission/draw_list.hpp"

namespace sightline::measure {

namespace {

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

/// All subjects of one view by turns; each keeps its last answer.
std::vector<Samples> take_times(Bench& bench, const View& view, std::size_t turn,
                                const MeasureOptions& options, Mover& mover) {
  using Timed = device::Timed;
  const auto subjects = bench.subjects();
  const bool drawn = bench.renderer() != nullptr;
  std::vector<Samples> samples(subjects.size());
  const std::size_t whole_frames = options.warm_up + options.repeats,
                    frames = whole_frames + (drawn ? options.timed_passes : 0);
  for (std::size_t repeat = 0; repeat < frames; ++repeat) {
    const Timed timed = repeat < whole_frames ? Timed::frame : Timed::passes;
    if (options.moving > 0) bench.update(mover.move());
    for (std::size_t k = 0; k < subjects.size(); ++k) {
      const std::size_t m = (k + turn + repeat) % subjects.size();
      const bool counts = repeat >= options.warm_up;
      // Where objects move, every frame is another answer.
      const bool enough = !drawn && options.moving == 0 && samples[m].spent > options.patience_ms;
      if (enough && (!counts || !samples[m].cpu.empty())) continue;
      const device::FrameTimes times = bench.run(subjects[m], view, timed);
      samples[m].spent += times.record_ms;
      if (counts) take(samples[m], times, drawn, timed);
    }
  }
  return samples;
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

}  // namespace

Comparison compare(Bench& bench, const camera::CameraPath& path, const MeasureOptions& options,
                   const Progress& progress) {
  if (options.limit && options.moving > 0) throw Error("--limit: expected objects that do not move");
  std::optional<Limit> limit;
  if (options.limit) limit.emplace(bench);
  Comparison result;
  result.scene = bench.scene().name;
  result.raster_state = bench.scene().raster_state;
  result.path = path.name;
  result.machine = this_machine();
  result.device = bench.device_name();
  result.width = options.width, result.height = options.height;
  result.cameras = path.cameras;
  for (const Subject& subject : bench.subjects()) result.methods.push_back(subject.name);
  Mover mover(bench.scene(), options.moving, 1);
  for (std::size_t v = 0; v < path.cameras.size(); ++v) {
    const View view = or_throw(make_view(path.cameras[v], options.width, options.height));
    if (limit) limit->look(view);
    std::vector<Samples> samples = take_times(bench, view, v, options, mover);
    for (std::size_t m = 0; m < samples.size(); ++m)
      result.rows.push_back(row_of(bench, bench.subjects()[m], view, v, samples[m]));
    if (progress) progress(v + 1, path.cameras.size());
  }
  return result;
}

}  // namespace sightline::measure
