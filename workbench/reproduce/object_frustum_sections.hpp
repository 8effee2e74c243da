// The sections of the page of Le Hoang Minh et al. 2022: its figures, and what its tables leave out.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "workbench/reproduce/object_frustum.hpp"

namespace sightline::reproduce {

/// The runs that table 2 has; its average stands behind them.
inline constexpr std::size_t kPublishedRuns = 10;

/// Unity's average / the paper's method's, as printed and here; `what` is "cpu_ms", "gpu_ms" or "fps".
struct PublishedAverages {
  std::optional<double> published, ours;
};
PublishedAverages averages_of(const ObjectFrustumResult& result, std::string_view what);

/// Where ours differs from the paper's, and why; `kept` is grid-cell's objects / object-frustum's.
std::string difference_sentence(const ObjectFrustumResult& result, double kept);

std::vector<PaperSection> object_frustum_sections(const ObjectFrustumResult& result);

/// Figures 1 and 2 as one drawing: the CPU's steps in a row, the GPU's beneath, with what they took.
std::string draw_life_cycle(const std::vector<FrameStep>& steps);

}  // namespace sightline::reproduce
