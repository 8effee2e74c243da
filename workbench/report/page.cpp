#include "workbench/report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include <sightline/version.hpp>

#include "workbench/report/assets.hpp"
#include "workbench/report/page_folder.hpp"
#include "workbench/report/pictures.hpp"
#include "workbench/report/summary.hpp"
#include "workbench/report/table.hpp"
#include "workbench/scene/far_origin.hpp"

namespace sightline::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<Outcome, kOutcomes> kLegendOrder{Outcome::visible, Outcome::excess, Outcome::culled,
                                                      Outcome::lost};

const char* outcome_words(Outcome outcome) {
  switch (outcome) {
    case Outcome::visible:
      return "kept, visible";
    case Outcome::excess:
      return "kept in vain";
    case Outcome::culled:
      return "culled rightly";
    case Outcome::lost:
      return "lost";
  }
  return "";
}

/// Bytes of the valid UTF-8 sequence that begins at `at`; 0 for none.
std::size_t sequence_length(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(at);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xc2 && first < 0xe0   ? 2
                             : first >= 0xe0 && first < 0xf0 ? 3
                             : first >= 0xf0 && first < 0xf5 ? 4
                                                             : 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(at + i) & 0xc0u) != 0x80u) return 0;
  }
  // Overlong forms, surrogates, and what lies beyond U+10FFFF.
  if ((first == 0xe0 && byte(at + 1) < 0xa0) || (first == 0xed && byte(at + 1) > 0x9f)) return 0;
  if ((first == 0xf0 && byte(at + 1) < 0x90) || (first == 0xf4 && byte(at + 1) > 0x8f)) return 0;
  return length;
}

/// A cell with losses in the colour of losses, and the range behind a time in small.
std::string cell_html(const std::string& column, const std::string& cell) {
  if (column.starts_with("lost "))
    return fmt::format("<td class=\"{}\">{}", cell == "0" ? "good" : "bad", cell);
  const std::size_t range = cell.find(" [");
  if (range == std::string::npos) return "<td>" + escape(cell);
  return fmt::format("<td>{} <span class=\"range\">{}</span>", cell.substr(0, range), cell.substr(range + 1));
}

/// The table's columns from left to right: on a narrow page the first ones are those that are seen, and what
/// was lost stands beside what was promised.
std::vector<std::size_t> columns_by_weight(const Table& table) {
  std::vector<std::size_t> columns(table.header.size());
  std::iota(columns.begin(), columns.end(), std::size_t{0});
  const auto place = [&](std::size_t c) {
    return table.header[c].starts_with("lost ") ? 0 : table.header[c] == "fps" ? 1 : 2;
  };
  std::ranges::stable_sort(columns.begin() + static_cast<std::ptrdiff_t>(table.text_columns), columns.end(),
                           {}, place);
  return columns;
}

std::string table_html(const measure::Comparison& comparison) {
  const Table table = summary_table(comparison);
  const std::vector<std::size_t> columns = columns_by_weight(table);
  std::string out =
      "<p class=\"hint\" hidden>The table goes on to the right: scroll it sideways.</p>\n"
      "<div class=\"wide\" tabindex=\"0\"><table><thead><tr>";
  for (const std::size_t c : columns) out += "<th>" + escape(table.header[c]);
  out += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    out += "<tr>";
    for (const std::size_t c : columns) out += cell_html(table.header[c], row[c]);
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

/// What page.js draws. "<" is written so that no name can end the script element.
std::string data_json(const measure::Comparison& comparison) {
  Json data;
  data["methods"] = comparison.methods;
  data["views"] = Json::array();
  for (std::size_t v = 0; v < comparison.cameras.size(); ++v) data["views"].push_back(v);
  data["truly_visible"] = Json::array();
  for (const char* name : {"cull_ms", "frame_ms", "kept", "triangles", "draw_calls"})
    data[name] = Json::array();
  for (const MethodSummary& s : summarise(comparison)) {
    Json times = Json::array(), frames = Json::array(), kept = Json::array();
    const bool first = data["kept"].empty();
    for (const measure::Row& row : comparison.rows) {
      if (row.method != s.method) continue;
      times.push_back(row.cull.median + (row.cull_gpu ? row.cull_gpu->median : 0));
      if (row.frame) frames.push_back(row.frame->median);
      kept.push_back(row.kept);
      if (first) data["truly_visible"].push_back(row.truly_visible);
    }
    data["cull_ms"].push_back(std::move(times));
    if (comparison.drawn()) data["frame_ms"].push_back(std::move(frames));
    data["kept"].push_back(std::move(kept));
    data["triangles"].push_back(std::round(s.triangles));
    data["draw_calls"].push_back(std::round(10 * s.draw_calls) / 10);
  }
  std::string text = data.dump(-1, ' ', false, Json::error_handler_t::replace), safe;
  for (const char c : text) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string size_text(std::uint32_t width, std::uint32_t height) {
  return fmt::format("{} × {}", width, height);
}

std::string facts_html(const PageContent& content) {
  const measure::Comparison& c = content.comparison;
  const auto fact = [](double value, const char* what) {
    return fmt::format("<li><b>{}</b> {}</li>", format_count(value), what);
  };
  return "<ul class=\"facts\">" + fact(static_cast<double>(content.scene.size()), "objects") +
         fact(static_cast<double>(triangle_count(content.scene)), "triangles") +
         fact(static_cast<double>(c.cameras.size()), "views") +
         fmt::format("<li>path <b>{}</b></li><li><b>{}</b> pixels</li><li>{}</li></ul>\n", escape(c.path),
                     size_text(c.width, c.height), sides_drawn(c.raster_state));
}

std::string chart_html(const char* id, const char* title) {
  return fmt::format(
      "<figure><h3>{}</h3><div class=\"chart\"><canvas id=\"{}\" role=\"img\" aria-label=\"{}\"></canvas>"
      "</div></figure>\n",
      title, id, title);
}

std::string where_html(const Scene& scene, const Snapshot& snapshot) {
  const WorldPoint eye = scene::to_world(scene.origin, eye_position(snapshot.view));
  const Vec3 forward = view_direction(snapshot.view);
  return fmt::format(
      "View {} of the path: eye at ({:.2f}, {:.2f}, {:.2f}) m, looking along ({:.2f}, {:.2f}, {:.2f}).",
      snapshot.index, eye.x, eye.y, eye.z, forward.x, forward.y, forward.z);
}

std::string outcome_html(const Snapshot::Method& method, const std::string& picture) {
  std::string out = fmt::format("<figure><h3>{}</h3><ul class=\"legend\">", escape(method.name));
  for (const Outcome outcome : kLegendOrder) {
    const Colour c = outcome_colour(outcome);
    out += fmt::format("<li><i style=\"background:rgb({},{},{})\"></i>{} <b>{}</b></li>", c.r, c.g, c.b,
                       outcome_words(outcome),
                       format_count(static_cast<double>(method.counts[static_cast<std::size_t>(outcome)])));
  }
  return out + fmt::format(
                   "</ul><img src=\"{}\" alt=\"Top view of the scene: objects by their outcome under "
                   "{}\"></figure>\n",
                   escape(picture), escape(method.name));
}

std::string machine_html(const measure::Machine& m) {
  return fmt::format("{}, {} hardware threads, {:.1f} GB, {}, {}", escape(m.cpu), m.cores,
                     static_cast<double>(m.memory) / 1e9, escape(m.os), escape(m.compiler));
}

std::string footer_html(const measure::Comparison& comparison) {
  return std::string(
             "<footer><p>Lost: visible in the item buffer, which rays through pixel centres or, where "
             "frames were drawn, the rasteriser makes, and not in the method's set. Excess: kept though no "
             "pixel shows it. Kept, tested, draw calls, triangles and excess are means over the views, "
             "losses are sums. ") +
         (comparison.drawn()
              ? "Times are means of the views' medians, those of culling on the GPU in slower frames of "
                "their own"
              : "Times are medians of the views' medians, with the least and the greatest of all repeats") +
         "; methods take turns in one process, warm-up is not counted. Ratios within one run are the result; "
         "absolute times belong to the machine above.</p></footer>\n";
}

}  // namespace

std::string escape(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = sequence_length(text, i);
    const char c = text[i];
    if (length == 0) {
      out += "\xef\xbf\xbd";
    } else if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else if (c == '\'') {
      out += "&#39;";
    } else {
      out += text.substr(i, length);
    }
    i += length == 0 ? 1 : length;
  }
  return out;
}

std::string make_page(const PageContent& content) {
  const measure::Comparison& comparison = content.comparison;
  const std::string scene = escape(comparison.scene);
  std::string page = "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">" +
                     std::string(kPageMark) +
                     "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
                     scene + " – Sightline</title>\n<style>\n";
  page.append(kPageStyle).append("</style></head>\n<body><main>\n");
  page += "<header><h1>What not to draw of " + scene + "</h1><p>Sightline " + escape(kVersion) + " on " +
          machine_html(comparison.machine) +
          (comparison.drawn() ? ", drawn by " + escape(comparison.device) : "") + "</p>" +
          facts_html(content) + "</header>\n";
  page += "<p class=\"verdict\">" + escape(verdict(comparison)) + "</p>\n";  // its lines stay lines
  page += "<h2>The methods</h2>\n" + table_html(comparison);
  page +=
      "<h2>Along the path</h2>\n<div class=\"charts\">" + chart_html("cull-time", "Culling time, a view") +
      (comparison.drawn() ? chart_html("frame-time", "Frame time, a view") : "") +
      chart_html("kept", "Objects kept, beside those visible") +
      chart_html("triangles", "Triangles left to draw") + chart_html("draw-calls", "Draw calls") + "</div>\n";
  page += "<h2>The truth</h2>\n<figure class=\"item\"><img src=\"" + escape(content.item_buffer) +
          "\" alt=\"Item buffer: each object in a colour of its own\"><figcaption>The item buffer: "
          "everything drawn, nothing culled, each of the " +
          format_count(static_cast<double>(content.snapshot.truth.visible_count())) + " objects visible at " +
          size_text(content.snapshot.view.width, content.snapshot.view.height) + " in a colour of its own. " +
          where_html(content.scene, content.snapshot) + "</figcaption></figure>\n";
  page += "<h2>From above</h2>\n<p>The same view at " + size_text(comparison.width, comparison.height) +
          ", each object coloured by its outcome under each method; x runs to the right, z down. The dark "
          "outline is the view frustum.</p>\n<div class=\"outcomes\">\n";
  for (std::size_t m = 0; m < content.snapshot.methods.size(); ++m) {
    page += outcome_html(content.snapshot.methods[m], content.top_views[m]);
  }
  page += "</div>\n" + footer_html(comparison) + "</main>\n";
  page += "<script type=\"application/json\" id=\"data\">" + data_json(comparison) + "</script>\n<script>\n";
  page.append(kChartScript).append("\n</script>\n<script>\n").append(kSharedScript).append(kPageScript);
  return page + "</script></body></html>\n";
}

std::string html(const Table& table) {
  std::string out = "<div class=\"wide\"><table";
  out += table.text_columns == 1 ? " class=\"numbers\"><thead><tr>" : "><thead><tr>";
  for (const std::string& cell : table.header) out += "<th>" + escape(cell);
  out += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    out += "<tr>";
    for (const std::string& cell : row) out += "<td>" + escape(cell);
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

}  // namespace sightline::report
