#include "workbench/measure/device_measure.hpp"

#include <sightline/workbench/error.hpp>

#include "workbench/oracle/loss.hpp"
#include "workbench/submission/draw_list.hpp"

namespace sightline::measure {

namespace {

struct Times {
  std::vector<double> cpu, gpu, frame;
};

// Draws what it is told.
class Told final : public Method {
public:
  explicit Told(const Scene& scene) : scene_(scene), draw_list_(scene) {}

  std::vector<ObjectId> visible;

  [[nodiscard]] Guarantee guarantee() const noexcept override { return Guarantee::exact; }
  void update(std::span<const ObjectId>) override {}
  void cull(const View& view, Frame& frame) noexcept override {
    frame.clear();
    frame.visible.assign(visible.begin(), visible.end());
    draw_list_.build(scene_, view, frame);
  }

private:
  const Scene& scene_;
  submission::DrawList draw_list_;
};

}  // namespace

Comparison compare_on_device(Workbench& bench, const camera::CameraPath& path,
                             const DeviceMeasureOptions& options, const Progress& progress) {
  const MeasureOptions& measure = options.measure;
  Comparison result;
  result.scene = bench.scene().name;
  result.path = path.name;
  result.machine = this_machine();
  result.device = bench.renderer().device().info().name;
  result.width = measure.width, result.height = measure.height;
  result.cameras = path.cameras;
  struct Entrant {
    std::string name;
    methods::DeviceMethod* method;
  };
  std::vector<Entrant> contestants;
  for (const DeviceContestant& contestant : bench.contestants())
    contestants.push_back({contestant.name, contestant.method.get()});
  Told* told = nullptr;
  std::unique_ptr<methods::DeviceMethod> limit;
  if (options.limit) {
    if (options.moving > 0) throw Error("--limit: expected objects that do not move");
    auto method = std::make_unique<Told>(bench.scene());
    told = method.get();
    limit = methods::draw_by_device(std::move(method), bench.renderer());
    contestants.push_back({std::string(kLimit), limit.get()});
  }
  for (const Entrant& contestant : contestants) result.methods.push_back(contestant.name);
  Mover mover(bench.scene(), options.moving, 1);
  Frame frame;
  for (std::size_t v = 0; v < path.cameras.size(); ++v) {
    const View view = or_throw(make_view(path.cameras[v], measure.width, measure.height));
    std::vector<Times> samples(contestants.size());
    if (told) {
      told->visible.clear();
      const oracle::ItemBuffer seen = bench.judge(view);
      for (ObjectId o = 0; o < bench.scene().size(); ++o) {
        if (seen.pixels[o] > 0) told->visible.push_back(o);
      }
    }
    const std::size_t whole_frames = measure.warm_up + measure.repeats;
    for (std::size_t repeat = 0; repeat < whole_frames + options.timed_passes; ++repeat) {
      using Timed = device::Renderer::Timed;
      const Timed timed = repeat < whole_frames ? Timed::frame : Timed::passes;
      if (options.moving > 0) bench.update(mover.move());
      for (std::size_t k = 0; k < contestants.size(); ++k) {
        const std::size_t m = (k + v + repeat) % contestants.size();
        const device::FrameTimes times = bench.draw(*contestants[m].method, view, timed);
        if (repeat < measure.warm_up) continue;
        if (timed == Timed::passes) {
          samples[m].gpu.push_back(times.gpu_ms(device::PassKind::cull));
          continue;
        }
        samples[m].cpu.push_back(times.record_ms);
        samples[m].frame.push_back(times.frame_ms);
      }
    }
    const oracle::ItemBuffer scene_truth = bench.judge(view);
    for (std::size_t m = 0; m < contestants.size(); ++m) {
      const std::optional<oracle::ItemBuffer> own = bench.judge_own(*contestants[m].method, view);
      const oracle::ItemBuffer& truth = own ? *own : scene_truth;
      contestants[m].method->read_back(frame);
      const oracle::Loss loss = oracle::compare_to_truth(truth, frame.visible);
      Row row;
      row.method = contestants[m].name;
      row.guarantee = contestants[m].method->guarantee();
      row.view = v;
      row.stats = frame.stats;
      row.stats.objects = bench.scene().size();
      row.kept = frame.visible.size();
      row.truly_visible = truth.visible_count();
      row.cull = timing_of(samples[m].cpu);
      row.cull_gpu = timing_of(samples[m].gpu);
      row.frame = timing_of(samples[m].frame);
      row.lost_objects = loss.lost.size();
      row.lost_pixels = loss.lost_pixels;
      row.excess_objects = loss.excess.size();
      result.rows.push_back(std::move(row));
    }
    if (progress) progress(v + 1, path.cameras.size());
  }
  return result;
}

}  // namespace sightline::measure
