#include "workbench/oracle/loss.hpp"

#include <algorithm>
#include <string>

#include <sightline/workbench/error.hpp>

namespace sightline::oracle {

Loss compare_to_truth(const ItemBuffer& truth, std::span<const ObjectId> visible) {
  std::vector<std::uint8_t> kept(truth.pixels.size(), 0);
  for (const ObjectId object : visible) {
    if (object >= kept.size()) {
      throw Error("visible set: object " + std::to_string(object) + " is not in the scene of " +
                  std::to_string(kept.size()) + " objects");
    }
    if (kept[object] != 0) throw Error("visible set: object " + std::to_string(object) + " is named twice");
    kept[object] = 1;
  }
  Loss loss;
  for (ObjectId object = 0; object < kept.size(); ++object) {
    if (truth.sees(object) && kept[object] == 0) {
      loss.lost.push_back(object);
      loss.lost_pixels += truth.pixels[object];
    } else if (!truth.sees(object) && kept[object] != 0) {
      loss.excess.push_back(object);
    }
  }
  return loss;
}

Loss confirmed_loss(const ItemBuffer& truth, const ItemBuffer& again, std::span<const ObjectId> visible) {
  Loss loss = compare_to_truth(truth, visible);
  loss.lost_pixels = 0;
  std::erase_if(loss.lost, [&](ObjectId object) { return !again.sees(object); });
  for (const ObjectId object : loss.lost)
    loss.lost_pixels += std::min(truth.pixels[object], again.pixels[object]);
  return loss;
}

Loss confirmed_loss(const EmbreeJudge& judge, const View& view, const ItemBuffer& truth,
                    std::span<const ObjectId> visible) {
  Loss loss = compare_to_truth(truth, visible);
  if (loss.lost.empty()) return loss;
  const std::vector<std::uint32_t> confirmed = judge.confirmed_pixels(view, truth, loss.lost);
  Loss sure;
  sure.excess = std::move(loss.excess);
  for (std::size_t i = 0; i < loss.lost.size(); ++i) {
    if (confirmed[i] == 0) continue;
    sure.lost.push_back(loss.lost[i]);
    sure.lost_pixels += confirmed[i];
  }
  return sure;
}

}  // namespace sightline::oracle
