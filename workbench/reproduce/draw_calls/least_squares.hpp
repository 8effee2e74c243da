// Fits of a few coefficients to many samples.
#pragma once

#include <span>
#include <vector>

namespace sightline::reproduce {

/// The coefficients that make the sum of squared errors least, of terms whose sizes may differ by powers of
/// ten.
class LeastSquares {
public:
  explicit LeastSquares(std::size_t terms) : terms_(terms), sums_(terms * (terms + 1)) {}

  /// A sample: what each term is there, and what their weighted sum should be.
  void add(std::span<const double> terms, double value);
  /// One a term; 0 for one that the samples say nothing of.
  [[nodiscard]] std::vector<double> solve() const;

private:
  std::size_t terms_;
  std::vector<double> sums_;  ///< the normal equations, a row a term, the right side last
};

}  // namespace sightline::reproduce
