// Aligned tables for a terminal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sightline::report {

/// Text in the first column(s), figures in the rest.
struct Table {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  ///< each as long as the header, or shorter
  std::size_t text_columns = 1;                ///< aligned to the left; the others to the right
};

/// Lines that end with '\n'. Columns are as wide as their widest cell in code points, whatever its bytes.
std::string render(const Table& table);

/// How many columns of a terminal the text takes: code points, combining marks not counted.
std::size_t display_width(std::string_view text) noexcept;

/// 12,345 or 12.3: whole where it is large, one decimal where it is small and not whole.
std::string format_count(double count);

/// Three significant digits, never an exponent.
std::string format_ms(double milliseconds);

/// of / to, or a dash where either is missing.
std::string format_ratio(double of, double to, int decimals);

}  // namespace sightline::report
