#include "workbench/report/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sightline::report {
namespace {

std::string grouped(std::uint64_t value) {
  std::string digits = std::to_string(value);
  for (std::size_t at = digits.size(); at > 3;) {
    at -= 3;
    digits.insert(at, ",");
  }
  return digits;
}

void append_line(std::string& out, const Table& table, const std::vector<std::string>& cells,
                 const std::vector<std::size_t>& widths) {
  std::string line;
  for (std::size_t c = 0; c < widths.size(); ++c) {
    const std::string cell = c < cells.size() ? cells[c] : "";
    const std::string padding(widths[c] - display_width(cell), ' ');
    if (c != 0) line += "  ";
    line += c < table.text_columns ? cell + padding : padding + cell;
  }
  line.erase(line.find_last_not_of(' ') + 1);
  out += line + "\n";
}

}  // namespace

std::size_t display_width(std::string_view text) noexcept {
  std::size_t width = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if ((byte & 0xc0u) == 0x80u) continue;
    // U+0300 … U+036F: marks that stand on the letter before.
    const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0u;
    const bool combining = byte == 0xccu || (byte == 0xcdu && next >= 0x80u && next <= 0xafu);
    if (!combining) ++width;
  }
  return width;
}

std::string render(const Table& table) {
  std::vector<std::size_t> widths;
  const auto widen = [&](const std::vector<std::string>& cells) {
    if (widths.size() < cells.size()) widths.resize(cells.size(), 0);
    for (std::size_t c = 0; c < cells.size(); ++c) widths[c] = std::max(widths[c], display_width(cells[c]));
  };
  widen(table.header);
  for (const auto& row : table.rows) widen(row);
  std::string out;
  append_line(out, table, table.header, widths);
  std::string rule;
  for (std::size_t c = 0; c < widths.size(); ++c) {
    if (c != 0) rule += "  ";
    for (std::size_t i = 0; i < widths[c]; ++i) rule += "─";
  }
  out += rule + "\n";
  for (const auto& row : table.rows) append_line(out, table, row, widths);
  return out;
}

std::string format_count(double count) {
  if (!std::isfinite(count) || count < 0) return "–";
  if (count < 100 && count != std::floor(count)) return fmt::format("{:.1f}", count);
  return grouped(static_cast<std::uint64_t>(std::llround(count)));
}

std::string format_ms(double ms) {
  if (!(ms > 0)) return "0";
  const int before = static_cast<int>(std::floor(std::log10(ms))) + 1;
  return fmt::format("{:.{}f}", ms, std::clamp(3 - before, 0, 6));
}

std::string format_ratio(double of, double to, int decimals) {
  return of > 0 && to > 0 ? fmt::format("{:.{}f}", of / to, decimals) : "-";
}

}  // namespace sightline::report
