#include "workbench/reproduce/draw_calls/least_squares.hpp"

#include <algorithm>
#include <cmath>

namespace sightline::reproduce {

void LeastSquares::add(std::span<const double> terms, double value) {
  for (std::size_t i = 0; i < terms_; ++i) {
    double* row = &sums_[i * (terms_ + 1)];
    for (std::size_t j = 0; j < terms_; ++j) row[j] += terms[i] * terms[j];
    row[terms_] += terms[i] * value;
  }
}

std::vector<double> LeastSquares::solve() const {
  const std::size_t width = terms_ + 1;
  std::vector<double> m = sums_, scale(terms_);
  // Terms of one size: otherwise what rounding leaves of a large one drowns a small one.
  for (std::size_t i = 0; i < terms_; ++i) scale[i] = m[i * width + i] > 0 ? std::sqrt(m[i * width + i]) : 1;
  for (std::size_t i = 0; i < terms_; ++i) {
    for (std::size_t j = 0; j < width; ++j) m[i * width + j] /= scale[i] * (j < terms_ ? scale[j] : 1);
  }
  // Terms stay where they are: the matrix is symmetric and has no negative eigenvalue.
  constexpr double kNothing = 1e-12;
  std::vector<bool> known(terms_);
  for (std::size_t i = 0; i < terms_; ++i) {
    known[i] = m[i * width + i] > kNothing;
    if (!known[i]) continue;
    for (std::size_t r = 0; r < terms_; ++r) {
      if (r == i) continue;
      const double factor = m[r * width + i] / m[i * width + i];
      for (std::size_t c = 0; c < width; ++c) m[r * width + c] -= factor * m[i * width + c];
    }
  }
  std::vector<double> out(terms_);
  for (std::size_t i = 0; i < terms_; ++i)
    out[i] = known[i] ? m[i * width + terms_] / m[i * width + i] / scale[i] : 0;
  return out;
}

}  // namespace sightline::reproduce
