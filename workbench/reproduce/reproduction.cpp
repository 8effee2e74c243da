#include "workbench/reproduce/reproduction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "workbench/reproduce/published.hpp"

namespace sightline::reproduce {

namespace {

using Json = nlohmann::ordered_json;

// More columns than these are told a line each: two figures of each would not fit side by side.
constexpr std::size_t kMostSideBySide = 4;

std::string of(const std::optional<double>& number) {
  if (!number) return "–";
  return (*number < 0 ? "-" : "") + report::format_ms(std::abs(*number));
}

std::string ratio_text(const std::optional<double>& ratio) {
  return ratio ? fmt::format("{:.2f}", *ratio) : "–";
}

std::string ours_text(const Cell& cell) {
  if (!cell.our_words.empty()) return cell.our_words;
  return cell.ours && *cell.ours >= 1000 ? report::format_count(*cell.ours) : of(cell.ours);
}

std::string published_text(const Cell& cell) {
  const std::optional<double> number = number_of(cell.published);
  if (number && *number >= 10000) return report::format_count(*number);
  return cell.published.empty() ? "–" : cell.published;
}

const Cell* base_of(const PaperTable& table, std::size_t row, std::size_t column) {
  switch (table.base) {
    case PaperTable::Base::row:
      return &table.rows[table.base_row].cells[column];
    case PaperTable::Base::column:
      return &table.rows[row].cells[table.base_column];
    case PaperTable::Base::cell:
      return &table.rows.front().cells.front();
    case PaperTable::Base::none:
      break;
  }
  return nullptr;
}

std::optional<double> quotient(const std::optional<double>& of, const std::optional<double>& to) {
  if (!of || !to || *to == 0) return std::nullopt;
  return *of / *to;
}

std::string with_ratio(std::string figure, const std::optional<double>& ratio) {
  return ratio ? fmt::format("{} ({:.2f})", figure, *ratio) : figure;
}

// Ratios stand in brackets; a column of ours alone takes one.
report::Table side_by_side(const PaperTable& table) {
  report::Table out;
  out.header = table.keys;
  out.text_columns = table.keys.size();
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (table.has_published(c)) out.header.push_back(table.columns[c] + ", published");
    out.header.push_back(table.has_published(c) ? "ours" : table.columns[c]);
  }
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    std::vector<std::string> line = table.rows[r].keys;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const Cell& cell = table.rows[r].cells[c];
      const bool ratios = table.has_ratios(c);
      if (table.has_published(c))
        line.push_back(ratios ? with_ratio(published_text(cell), table.published_ratio(r, c))
                              : published_text(cell));
      line.push_back(ratios ? with_ratio(ours_text(cell), table.our_ratio(r, c)) : ours_text(cell));
    }
    out.rows.push_back(std::move(line));
  }
  return out;
}

report::Table line_by_line(const PaperTable& table) {
  report::Table out;
  out.header = table.keys;
  out.header.emplace_back("");
  out.text_columns = table.keys.size() + 1;
  out.header.insert(out.header.end(), table.columns.begin(), table.columns.end());
  bool both = false;
  for (std::size_t c = 0; c < table.columns.size(); ++c) both = both || table.has_published(c);
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const auto add = [&](const char* what, const auto& cell_text) {
      std::vector<std::string> line = table.rows[r].keys;
      line.emplace_back(what);
      for (std::size_t c = 0; c < table.columns.size(); ++c) line.push_back(cell_text(c));
      out.rows.push_back(std::move(line));
    };
    const std::vector<Cell>& cells = table.rows[r].cells;
    if (both) add("published", [&](std::size_t c) { return published_text(cells[c]); });
    add("ours", [&](std::size_t c) { return ours_text(cells[c]); });
    if (table.base == PaperTable::Base::none) continue;
    if (both) add("ratio, published", [&](std::size_t c) { return ratio_text(table.published_ratio(r, c)); });
    add("ratio, ours", [&](std::size_t c) { return ratio_text(table.our_ratio(r, c)); });
  }
  return out;
}

Json cell_json(const PaperTable& table, std::size_t row, std::size_t column) {
  const Cell& cell = table.rows[row].cells[column];
  Json out = Json::object();
  if (const auto number = number_of(cell.published)) {
    out["published"] = *number;
  } else if (!cell.published.empty()) {
    out["published"] = cell.published;
  }
  if (!cell.our_words.empty()) {
    out["ours"] = cell.our_words;
  } else if (cell.ours) {
    out["ours"] = *cell.ours;
  }
  if (const auto ratio = table.published_ratio(row, column)) out["published_ratio"] = *ratio;
  if (const auto ratio = table.our_ratio(row, column)) out["our_ratio"] = *ratio;
  return out;
}

Json table_json(const PaperTable& table) {
  Json out{{"name", table.name}, {"title", table.title}, {"rows", Json::array()}};
  if (!table.note.empty()) out["note"] = table.note;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    Json row = Json::object();
    for (std::size_t k = 0; k < table.keys.size(); ++k) row[table.keys[k]] = table.rows[r].keys[k];
    Json& cells = row["cells"] = Json::object();
    for (std::size_t c = 0; c < table.columns.size(); ++c) cells[table.columns[c]] = cell_json(table, r, c);
    out["rows"].push_back(std::move(row));
  }
  return out;
}

Json section_json(const PaperSection& section) {
  Json out{{"name", section.name}, {"title", section.title}};
  if (!section.note.empty()) out["note"] = section.note;
  for (const report::Table& table : section.tables)
    out["tables"].push_back({{"header", table.header}, {"rows", table.rows}});
  return out;
}

}  // namespace

std::optional<double> PaperTable::published_ratio(std::size_t row, std::size_t column) const {
  const Cell* to = base_of(*this, row, column);
  if (!to) return std::nullopt;
  return quotient(number_of(rows[row].cells[column].published), number_of(to->published));
}

std::optional<double> PaperTable::our_ratio(std::size_t row, std::size_t column) const {
  const Cell* to = base_of(*this, row, column);
  return to ? quotient(rows[row].cells[column].ours, to->ours) : std::nullopt;
}

bool PaperTable::has_published(std::size_t column) const {
  return std::ranges::any_of(rows, [&](const Row& row) { return !row.cells[column].published.empty(); });
}

bool PaperTable::has_ratios(std::size_t column) const {
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (published_ratio(r, column).value_or(1) != 1 || our_ratio(r, column).value_or(1) != 1) return true;
  }
  return false;
}

report::Table text_table(const PaperTable& table) {
  return table.columns.size() <= kMostSideBySide ? side_by_side(table) : line_by_line(table);
}

std::string text(const Reproduction& reproduction) {
  std::string out = fmt::format("{}\n{}\n\n", reproduction.title, reproduction.machine);
  for (const std::string& sentence : reproduction.sentences) out += sentence + "\n";
  for (const PaperTable& table : reproduction.tables) {
    out += fmt::format("\n{}: {}\n\n{}", table.name, table.title, render(text_table(table)));
    if (!table.note.empty()) out += table.note + "\n";
  }
  for (const PaperSection& section : reproduction.sections) {
    out += fmt::format("\n{}: {}\n", section.name, section.title);
    for (const report::Table& table : section.tables) out.append("\n").append(render(table));
    if (!section.note.empty()) out += section.note + "\n";
  }
  return out;
}

std::string json(const Reproduction& reproduction) {
  Json out{{"paper", reproduction.paper},     {"title", reproduction.title},
           {"machine", reproduction.machine}, {"sentences", reproduction.sentences},
           {"tables", Json::array()},         {"sections", Json::array()}};
  for (const PaperTable& table : reproduction.tables) out["tables"].push_back(table_json(table));
  for (const PaperSection& section : reproduction.sections) out["sections"].push_back(section_json(section));
  return out.dump(1) + "\n";
}

}  // namespace sightline::reproduce
