// What repeated times say.
#pragma once

#include <span>

namespace sightline::measure {

/// Milliseconds over the repeats.
struct Timing {
  double median = 0, min = 0, max = 0;
};

/// Median, least and greatest; zeros for no samples. Sorts the samples.
Timing timing_of(std::span<double> milliseconds) noexcept;

/// The mean of the quicker four fifths; 0 for no samples. Sorts the samples. Frames of a software rasteriser
/// come in two speeds, by where its threads happen to run: medians jump from one to the other, means do not.
double typical_of(std::span<double> milliseconds) noexcept;

}  // namespace sightline::measure
