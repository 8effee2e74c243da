#include "workbench/reproduce/draw_calls/call_rates.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "workbench/reproduce/draw_calls/least_squares.hpp"
#include "workbench/reproduce/published.hpp"

namespace sightline::reproduce {

namespace {

double median_of_values(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::array<double, 6> rate_terms(double triangles, double calls) {
  const double n = triangles / 1e5, d = std::log10(calls);
  return {1, n, d, n * n, n * d, d * d};
}

}  // namespace

CallRates published_rates() {
  const Published& table = published("draw_calls");
  CallRates rates;
  for (std::size_t c = 1; c < table.header().size(); ++c)
    rates.calls.push_back(*number_of(table.header()[c].substr(table.header()[c].find('_') + 1)));
  for (const std::vector<std::string>& row : table.rows()) {
    rates.triangles.push_back(*number_of(row[0]));
    for (std::size_t c = 1; c < row.size(); ++c) rates.fps.push_back(*number_of(row[c]));
  }
  return rates;
}

double triangle_ns(const CallRates& rates) {
  const std::size_t last = rates.triangles.size() - 1;
  return 1e6 * (rates.ms(last, 0) - rates.ms(0, 0)) / (rates.triangles[last] - rates.triangles[0]);
}

std::vector<CallWorth> calls_worth(const CallRates& rates) {
  std::vector<CallWorth> out;
  const double triangle = triangle_ns(rates);
  for (std::size_t c = 1; c < rates.calls.size(); ++c) {
    std::vector<double> call_us;
    for (std::size_t n = 0; n < rates.triangles.size(); ++n)
      call_us.push_back(1000 * (rates.ms(n, c) - rates.ms(n, 0)) / (rates.calls[c] - rates.calls[0]));
    const double median = median_of_values(call_us);
    out.push_back({rates.calls[c], median, 1000 * median / triangle});
  }
  return out;
}

CallWorth call_worth_of_all(const CallRates& rates) {
  LeastSquares fit(3);
  for (std::size_t n = 0; n < rates.triangles.size(); ++n) {
    for (std::size_t c = 0; c < rates.calls.size(); ++c)
      fit.add(std::array{1.0, rates.triangles[n], rates.calls[c]}, rates.ms(n, c));
  }
  const std::vector<double> ms = fit.solve();
  return {0, 1000 * ms[2], ms[2] / ms[1]};
}

RateFit::RateFit(const CallRates& rates) {
  LeastSquares fit(kTerms.size());
  for (std::size_t n = 0; n < rates.triangles.size(); ++n) {
    for (std::size_t c = 0; c < rates.calls.size(); ++c)
      fit.add(rate_terms(rates.triangles[n], rates.calls[c]), rates.at(n, c));
  }
  coefficients_ = fit.solve();
  const double mean =
      std::accumulate(rates.fps.begin(), rates.fps.end(), 0.0) / static_cast<double>(rates.fps.size());
  double errors = 0, spread = 0;
  for (std::size_t n = 0; n < rates.triangles.size(); ++n) {
    for (std::size_t c = 0; c < rates.calls.size(); ++c) {
      errors += std::pow(rates.at(n, c) - at(rates.triangles[n], rates.calls[c]), 2);
      spread += std::pow(rates.at(n, c) - mean, 2);
    }
  }
  determination_ = spread > 0 ? 1 - errors / spread : 0;
}

double RateFit::at(double triangles, double calls) const {
  const std::array<double, 6> terms = rate_terms(triangles, calls);
  return std::inner_product(terms.begin(), terms.end(), coefficients_.begin(), 0.0);
}

std::optional<double> RateFit::calls_at(double triangles, double fps) const {
  double low = 0, high = 5;  // decimal logarithms
  const auto above = [&](double log_calls) { return at(triangles, std::pow(10, log_calls)) > fps; };
  if (above(low) == above(high)) return std::nullopt;
  for (int step = 0; step < 50; ++step) {
    const double middle = 0.5 * (low + high);
    (above(middle) == above(low) ? low : high) = middle;
  }
  return std::pow(10, low);
}

}  // namespace sightline::reproduce
