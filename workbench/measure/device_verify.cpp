#include "workbench/measure/device_verify.hpp"

#include <array>

#include <sightline/workbench/error.hpp>

#include "workbench/oracle/loss.hpp"

namespace sightline::measure {

namespace {

constexpr std::size_t kExamples = 10;

// A picture with its depths, and the pictures that it may equal: all triangles drawn in one order and in the
// other.
struct Reference {
  device::Picture picture, other;
  std::vector<float> depth;
};

// Where opaque surfaces lie at one depth the two orders differ, and any of those surfaces may show.
std::uint64_t count_different(const device::Picture& picture, const std::vector<float>& depth,
                              const Reference& reference) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    const bool tie =
        reference.picture.pixels[i] != reference.other.pixels[i] && depth[i] == reference.depth[i];
    count += picture.pixels[i] != reference.picture.pixels[i] && !tie;
  }
  return count;
}

}  // namespace

bool DeviceVerification::passed() const noexcept {
  for (std::size_t m = 0; m < methods.size(); ++m) {
    if (methods[m].guarantee == Guarantee::exact && different_pixels[m] != 0) return false;
  }
  return Verification::passed();
}

DeviceVerification verify_on_device(Workbench& bench, std::span<const Camera> cameras, std::uint32_t width,
                                    std::uint32_t height, double moving, const Progress& progress) {
  DeviceVerification result;
  result.scene = bench.scene().name;
  const auto contestants = bench.contestants();
  for (const DeviceContestant& contestant : contestants) {
    MethodVerdict verdict;
    verdict.method = contestant.name;
    verdict.guarantee = contestant.method->guarantee();
    result.methods.push_back(std::move(verdict));
  }
  result.different_pixels.resize(contestants.size());
  Mover mover(bench.scene(), moving, 1);
  Frame frame;
  for (std::size_t v = 0; v < cameras.size(); ++v) {
    const View view = or_throw(make_view(cameras[v], width, height));
    for (int settled = 0; settled < 2; ++settled) {
      if (moving > 0) bench.update(mover.move());
      const oracle::ItemBuffer scene_truth = bench.judge(view);
      bench.draw(bench.reference(), view);
      Reference scene_reference{bench.renderer().picture(), {}, bench.renderer().depth()};
      scene_reference.other = scene_reference.picture;
      for (std::size_t m = 0; m < contestants.size(); ++m) {
        const std::optional<oracle::ItemBuffer> own = bench.judge_own(*contestants[m].method, view);
        const oracle::ItemBuffer& truth = own ? *own : scene_truth;
        Reference reference = scene_reference;
        if (own) {
          using Order = methods::DeviceMethod::Order;
          reference.other = bench.own_picture(*contestants[m].method, view, Order::falling);
          reference.picture = bench.own_picture(*contestants[m].method, view, Order::rising);
          reference.depth = bench.renderer().depth();
        }
        bench.draw(*contestants[m].method, view);
        const std::uint64_t different =
            count_different(bench.renderer().picture(), bench.renderer().depth(), reference);
        contestants[m].method->read_back(frame);
        const oracle::Loss loss = oracle::compare_to_truth(truth, frame.visible);
        MethodVerdict& verdict = result.methods[m];
        result.different_pixels[m] += different;
        verdict.kept += frame.visible.size();
        verdict.visible += truth.visible_count();
        verdict.lost_objects += loss.lost.size();
        verdict.lost_pixels += loss.lost_pixels;
        verdict.excess_objects += loss.excess.size();
        if (loss.lost.empty()) continue;
        ++verdict.views_with_loss;
        if (verdict.examples.size() < kExamples) {
          verdict.examples.push_back({v, cameras[v], width, height, loss.lost.front(), loss.lost_pixels});
        }
      }
    }
    ++result.views;
    if (progress) progress(v + 1, cameras.size());
  }
  return result;
}

}  // namespace sightline::measure
