// A search for what rounds worst: random cases first, then the worst of them changed little by little.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace sightline::test {

/// Numbers a case is made of, each from [0, 1) until it is drawn.
class Draws {
public:
  explicit Draws(const std::vector<double>& numbers) : numbers_(numbers) {}

  double between(double low, double high) { return low + (high - low) * next(); }
  /// As likely small as large; of either sign.
  double any_size(double least, double most) {
    const double t = 2 * next() - 1;
    return std::copysign(least * std::pow(most / least, std::fabs(t)), t);
  }
  float any_float(double least, double most) { return static_cast<float>(any_size(least, most)); }

private:
  double next() { return numbers_[at_++ % numbers_.size()]; }
  const std::vector<double>& numbers_;
  std::size_t at_ = 0;
};

/// The largest part(Draws&) found, the same on every machine; what is no number counts as none. A case draws
/// at most `numbers` times.
template <class Part>
double worst(std::size_t numbers, const Part& part, int cases = 40000) {
  std::uint64_t state = 1;
  const auto random = [&] {  // splitmix64 (Steele, Lea & Flood 2014)
    std::uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u, z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-53;
  };
  std::vector<double> best(numbers), now(numbers);
  double most = 0;
  const auto look = [&] {
    Draws draws(now);
    const double found = part(draws);
    if (found > most) most = found, best = now;
  };
  for (int i = 0; i < cases; ++i) {
    for (double& n : now) n = random();
    look();
  }
  for (int i = 0; i < 2 * cases; ++i) {
    now = best;
    const double step = std::pow(2, -30 * random());
    for (double& n : now) {
      if (random() * static_cast<double>(numbers) > 2) continue;
      n += step * (random() - 0.5), n -= std::floor(n);
    }
    look();
  }
  return most;
}

}  // namespace sightline::test
