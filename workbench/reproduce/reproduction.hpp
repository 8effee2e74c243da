// What reproducing a paper gives: its tables under their own numbers, what it prints beside what came out
// here, and its figures; as text, as JSON and as a page.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "workbench/report/table.hpp"

namespace sightline::reproduce {

/// One cell: what the paper prints, and ours. Either may be missing.
struct Cell {
  std::string published;  ///< as printed; empty where the paper has none
  std::optional<double> ours;
  std::string our_words;  ///< instead of `ours`, where a number cannot say it
};

/// A table as the paper numbers it, or figures that stand in its text.
struct PaperTable {
  /// What ratios are taken to.
  enum class Base : std::uint8_t {
    none,
    row,     ///< the same column of the row `base_row`
    column,  ///< the same row of the column `base_column`
    cell,    ///< the first cell of all
  };
  struct Row {
    std::vector<std::string> keys;  ///< one a heading of `keys`
    std::vector<Cell> cells;        ///< one a heading of `columns`
  };

  std::string name;                  ///< "table 1"
  std::string title;                 ///< what it shows, and of what
  std::vector<std::string> keys;     ///< headings of what a row is about: "world", "method"
  std::vector<std::string> columns;  ///< headings with units: "culling ms"
  std::vector<Row> rows;
  Base base = Base::none;
  std::size_t base_row = 0, base_column = 0;
  std::string note;     ///< sentences on what differs, and why
  bool charted = true;  ///< false where rows are of units that no axis has in common

  /// The cell's ratio to its base; nothing where either is no number, or the base 0.
  [[nodiscard]] std::optional<double> published_ratio(std::size_t row, std::size_t column) const;
  [[nodiscard]] std::optional<double> our_ratio(std::size_t row, std::size_t column) const;
  /// Whether any of a column's ratios is other than 1.
  [[nodiscard]] bool has_ratios(std::size_t column) const;
  /// Whether the paper prints anything of a column.
  [[nodiscard]] bool has_published(std::size_t column) const;
};

/// A figure of the paper, or a part of its text: tables of ours, pictures, charts; or why it cannot be had.
struct PaperSection {
  std::string name;   ///< "figure 7", "text", "missing: figure 1"
  std::string title;  ///< what it shows
  std::vector<report::Table> tables;
  std::string html;  ///< put on the page as it is, before the tables
  std::string note;  ///< sentences
};

struct Reproduction {
  std::string paper;    ///< the command's name: "vertex-chunk"
  std::string title;    ///< "Lee & Shin 2023: vertex chunks"
  std::string machine;  ///< what it ran on
  std::vector<std::string>
      sentences;  ///< three: what the paper claims, what came out, where and why they differ
  std::vector<PaperTable> tables;
  std::vector<PaperSection> sections;
};

/// A line a row, of each column what is published and ours, ratios in brackets; where there are many columns,
/// a line each.
report::Table text_table(const PaperTable& table);
/// The whole as text.
std::string text(const Reproduction& reproduction);
/// The whole as JSON: every number under its table, row and column, as {"published": …, "ours": …}.
std::string json(const Reproduction& reproduction);
/// Writes index.html; what the sections' HTML names lies in the folder already. Throws Error where that
/// fails.
void write_reproduction(const std::string& folder, const Reproduction& reproduction);

/// A slider over two pictures of the folder, the second before the first.
std::string before_after(const std::string& before, const std::string& after, const std::string& caption);
/// A picture of the folder with its caption.
std::string picture(const std::string& file, const std::string& caption);
/// Lines over common labels, as a chart.
struct Series {
  std::string name;
  std::vector<double> values;
};
struct Chart {
  std::string id, x, y;  ///< unique on the page; the axes' titles
  std::vector<std::string> labels;
  std::vector<Series> series;
  bool bars = false, logarithmic = false;
};
std::string chart(const Chart& chart);

}  // namespace sightline::reproduce
