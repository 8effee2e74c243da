// What runs while one of these lives runs as on a processor that has AVX2 and no more, as most desktops' do.
#pragma once

#include <hwy/targets.h>

namespace sightline::benchmarks {

struct OnlyAvx2 {
  OnlyAvx2() { hwy::SetSupportedTargetsForTest(HWY_AVX2); }
  ~OnlyAvx2() { hwy::SetSupportedTargetsForTest(0); }
  OnlyAvx2(const OnlyAvx2&) = delete;
  OnlyAvx2& operator=(const OnlyAvx2&) = delete;
};

}  // namespace sightline::benchmarks
