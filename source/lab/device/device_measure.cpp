#include "lab/device/device_measure.hpp"

#include <sightline/error.hpp>

#include "lab/loss.hpp"

namespace sightline::lab {

namespace {

struct Samples {
  std::vector<double> cpu, gpu, frame;
};

}  // namespace

Comparison compare_on_device(Workbench& bench, const CameraPath& path, const DeviceMeasureOptions& options,
                             const Progress& progress) {
  const MeasureOptions& measure = options.measure;
  Comparison result;
  result.scene = bench.scene().name;
  result.path = path.name;
  result.machine = this_machine();
  result.device = bench.renderer().device().info().name;
  result.width = measure.width, result.height = measure.height;
  result.cameras = path.cameras;
  const auto contestants = bench.contestants();
  for (const DeviceContestant& contestant : contestants) result.methods.push_back(contestant.name);
  Mover mover(bench.scene(), options.moving, 1);
  Frame frame;
  for (std::size_t v = 0; v < path.cameras.size(); ++v) {
    const View view = or_throw(make_view(path.cameras[v], measure.width, measure.height));
    std::vector<Samples> samples(contestants.size());
    for (std::size_t repeat = 0; repeat < measure.warm_up + measure.repeats; ++repeat) {
      if (options.moving > 0) bench.update(mover.move());
      for (std::size_t k = 0; k < contestants.size(); ++k) {
        const std::size_t m = (k + v + repeat) % contestants.size();
        const vulkan::FrameTimes times = bench.draw(*contestants[m].method, view);
        if (repeat < measure.warm_up) continue;
        samples[m].cpu.push_back(times.record_ms);
        samples[m].gpu.push_back(times.gpu_ms(vulkan::PassKind::cull));
        samples[m].frame.push_back(times.frame_ms);
      }
    }
    const ItemBuffer truth = bench.judge(view);
    for (std::size_t m = 0; m < contestants.size(); ++m) {
      contestants[m].method->read_back(frame);
      const Loss loss = compare_to_truth(truth, frame.visible);
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

}  // namespace sightline::lab
