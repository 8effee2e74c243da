// The numbers that the four papers print, as data: published/*.csv, built into the program.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sightline::reproduce {

/// One file: a header, and rows of as many cells. "-" stands where the paper has none.
class Published {
public:
  /// Throws Error for a row of another length than the header's.
  explicit Published(std::string_view csv);

  using Key = std::pair<std::string_view, std::string_view>;  ///< a column, and what stands in it

  /// What is printed in `column` of the only row with these keys; empty for "-". Throws Error where there is
  /// no such column, and where there is not one such row.
  [[nodiscard]] const std::string& text(const std::vector<Key>& keys, std::string_view column) const;

  [[nodiscard]] const std::vector<std::string>& header() const noexcept { return header_; }
  [[nodiscard]] const std::vector<std::vector<std::string>>& rows() const noexcept { return rows_; }
  /// Throws Error where there is none.
  [[nodiscard]] std::size_t column(std::string_view name) const;

private:
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
};

/// published/NAME.csv. Throws Error where there is none.
const Published& published(std::string_view name);

/// The number that a cell is, if it is one and nothing else.
std::optional<double> number_of(std::string_view cell) noexcept;

}  // namespace sightline::reproduce
