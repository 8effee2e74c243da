// Table 1 of Serpa, Serpa & Rodrigues, the frame rates of n triangles in d draw calls, theirs and ours, and
// what follows from it: what a call is worth, and the polynomial of figure 6.
#pragma once

#include <array>
#include <optional>
#include <vector>

namespace sightline::reproduce {

/// Frames a second of n triangles in d calls; none where nothing was measured.
struct CallRates {
  std::vector<double> triangles, calls;
  std::vector<double> fps;  ///< triangles × calls, row by row

  [[nodiscard]] bool empty() const noexcept { return fps.empty(); }
  [[nodiscard]] double at(std::size_t row, std::size_t column) const {
    return fps[row * calls.size() + column];
  }
  [[nodiscard]] double ms(std::size_t row, std::size_t column) const { return 1000 / at(row, column); }
};

/// The table as printed.
CallRates published_rates();

/// What a call costs, by the rows that one column tells.
struct CallWorth {
  double calls = 0;      ///< the column
  double call_us = 0;    ///< median over the rows of what a call adds to the frame of one call
  double triangles = 0;  ///< as much as so many triangles cost
};

/// What a triangle costs, nanoseconds: the slope of the first column.
double triangle_ns(const CallRates& rates);
/// One a column but the first.
std::vector<CallWorth> calls_worth(const CallRates& rates);
/// One for all cells: a frame fitted as a constant, so much a triangle, and so much a call.
CallWorth call_worth_of_all(const CallRates& rates);

/// Figure 6: the frame rate as a polynomial of second degree in the triangles and the calls' decimal
/// logarithm.
class RateFit {
public:
  static constexpr std::array<const char*, 6> kTerms{"1", "n", "log d", "n²", "n · log d", "(log d)²"};

  explicit RateFit(const CallRates& rates);

  /// Coefficients of kTerms, n in 100,000 triangles.
  [[nodiscard]] const std::vector<double>& coefficients() const noexcept { return coefficients_; }
  [[nodiscard]] double at(double triangles, double calls) const;
  /// 1: through every cell; 0: no better than their mean.
  [[nodiscard]] double determination() const noexcept { return determination_; }
  /// At how many calls, from 1 to 100,000, so many triangles have the frame rate; nothing where at none.
  [[nodiscard]] std::optional<double> calls_at(double triangles, double fps) const;

private:
  std::vector<double> coefficients_;
  double determination_ = 0;
};

}  // namespace sightline::reproduce
