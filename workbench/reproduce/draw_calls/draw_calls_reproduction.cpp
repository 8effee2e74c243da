// The draw-call reproduction: the paper's tables beside ours, and what they say.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "workbench/reproduce/draw_calls/draw_call_sections.hpp"
#include "workbench/reproduce/published.hpp"

namespace sightline::reproduce {

namespace {

const std::string& said_in_text(std::string_view what) {
  return published("draw_calls_text").text({{"what", what}}, "value");
}

PaperTable table_1(const CallRates& ours) {
  const Published& printed = published("draw_calls");
  PaperTable table;
  table.name = "table 1", table.title = "frames/s of random triangles in draw calls of equal size";
  table.keys = {"triangles"};
  table.base = PaperTable::Base::cell;
  for (std::size_t c = 1; c < printed.header().size(); ++c) {
    table.columns.push_back(printed.header()[c]);
    std::ranges::replace(table.columns.back(), '_', ' ');
  }
  for (std::size_t r = 0; r < printed.rows().size(); ++r) {
    const std::string& triangles = printed.rows()[r][0];
    PaperTable::Row row{{triangles}, {}};
    for (std::size_t c = 1; c < printed.header().size(); ++c) {
      Cell cell{printed.text({{"triangles", triangles}}, printed.header()[c]), {}, {}};
      if (!ours.empty()) cell.ours = ours.at(r, c - 1);
      row.cells.push_back(std::move(cell));
    }
    table.rows.push_back(std::move(row));
  }
  table.note =
      "The first so many of one set of 500,000 triangles. Ratios are to the first cell: 100,000 triangles in "
      "one "
      "call.";
  return table;
}

/// "4, 5, 5": one a level, small to large.
template <class Of>
std::string each_level(const LevelWalks& walks, Of of) {
  std::string out;
  for (const LevelWalk& walk : walks) {
    const double value = std::round(static_cast<double>(of(walk)));
    out += fmt::format("{}{}{}", out.empty() ? "" : ", ", value < 0 ? "−" : "",
                       report::format_count(std::fabs(value)));
  }
  return out;
}

/// "ce1m7, small, in doors; …"
std::string kinds(const LevelWalks& walks) {
  std::string out;
  for (const LevelWalk& walk : walks)
    out += fmt::format("{}{}: {}, {} triangles", out.empty() ? "" : "; ", short_level(walk), walk.kind,
                       report::format_count(static_cast<double>(walk.triangles)));
  return out.empty() ? "none was walked through" : out;
}

/// The height at which frames/s of all nine families on all levels are most, together.
std::uint32_t best_height_over_all(const LevelWalks& walks) {
  std::array<double, kHighest + 1> fps{};
  for (const LevelWalk& walk : walks) {
    for (const WalkRow& row : walk.rows) {
      if (row.is_of_the_paper()) fps[row.height] += row.fps();
    }
  }
  return static_cast<std::uint32_t>(std::ranges::max_element(fps) - fps.begin());
}

double most_calls_ratio(const LevelWalks& walks) {
  double most = 0;
  for (const LevelWalk& walk : walks) {
    for (const StructureCount& count : walk.counts) {
      if (count.rules == kPrintedCells) most = std::max(most, count.ratio());
    }
  }
  return most;
}

/// Frame times of simple over those of the other two, of height 4, on every level with every structure.
std::vector<double> frames_beside_simple(const LevelWalks& walks) {
  std::vector<double> out;
  const auto frame_ms = [](const LevelWalk& walk, std::string_view variant, std::string_view structure) {
    return walk.row(fmt::format("{}-{}?height=4", variant, structure)).frame_ms;
  };
  for (const LevelWalk& walk : walks) {
    for (const auto structure : kWalkStructures) {
      for (const char* other : {"drawcall-wise", "zhang"})
        out.push_back(frame_ms(walk, "simple", structure) / frame_ms(walk, other, structure));
    }
  }
  return out;
}

double median_of_ratios(std::vector<double> ratios) {
  std::ranges::nth_element(ratios, ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2));
  return ratios[ratios.size() / 2];
}

/// What of ours is like a line of the paper's text: a number, or words where three levels stand for its
/// scene.
Cell text_cell(std::string_view what, const LevelWalks& walks) {
  Cell cell{said_in_text(what), {}, {}};
  if (walks.empty()) return cell;
  const auto at_4 = [](const LevelWalk& walk, const char* family) -> const WalkRow& {
    return walk.row(std::string(family) + "?height=4");
  };
  const auto zhang = [&](const LevelWalk& walk) -> const WalkRow& { return at_4(walk, "zhang-octree"); };
  const auto wise = [&](const LevelWalk& walk) -> const WalkRow& {
    return at_4(walk, "drawcall-wise-octree");
  };
  const auto words = [&](auto of) {
    cell.our_words = each_level(walks, of);
    cell.ours = 0;  // their mean
    for (const LevelWalk& walk : walks)
      *cell.ours += static_cast<double>(of(walk)) / static_cast<double>(walks.size());
  };
  if (what == "simple / others: draw calls") {
    cell.ours = most_calls_ratio(walks);
  } else if (what == "drawcall-wise and zhang / simple: fps") {
    cell.ours = median_of_ratios(frames_beside_simple(walks));
  } else if (what == "best height over all scenes") {
    cell.ours = best_height_over_all(walks);
    cell.our_words = std::to_string(best_height_over_all(walks));
  } else if (what == "best height octree Coaltown") {
    words([](const LevelWalk& w) { return w.best_height("drawcall-wise-octree"); });
  } else if (what == "best height zhang grid Coldfront") {
    words([](const LevelWalk& w) { return w.best_height("zhang-grid"); });
  } else if (what == "octree height 4: nodes possible") {
    cell.ours = possible_cells("octree", 4);
  } else if (what == "octree height 4 Manor: nodes created about") {
    words([](const LevelWalk& w) { return w.count("octree", 4, kPrintedCells).made; });
  } else if (what.starts_with("octree") && what.find("nodes") != std::string_view::npos) {
    words([](const LevelWalk& w) { return w.count("octree", 4, kPrintedCells).visited; });
  } else if (what == "zhang octree Coldfront: calls a frame mean") {
    words([&](const LevelWalk& w) { return zhang(w).draw_calls; });
  } else if (what == "zhang octree Manor: calls more than drawcall-wise about") {
    words([&](const LevelWalk& w) { return zhang(w).draw_calls - wise(w).draw_calls; });
  } else if (what.starts_with("zhang octree")) {
    words([&](const LevelWalk& w) { return wise(w).triangles - zhang(w).triangles; });
  } else if (what == "zhang grid Coldfront against k-d tree: triangles fewer") {
    words([&](const LevelWalk& w) {
      return at_4(w, "zhang-kd-tree").triangles - at_4(w, "zhang-grid").triangles;
    });
  } else if (what == "zhang grid Coldfront against k-d tree: calls about") {
    words([&](const LevelWalk& w) {
      return at_4(w, "zhang-grid").draw_calls - at_4(w, "zhang-kd-tree").draw_calls;
    });
  }
  return cell;
}

PaperTable text_figures(const LevelWalks& walks) {
  PaperTable table;
  table.name = "text", table.title = "figures that the paper's text gives";
  table.keys = {"what"}, table.columns = {"value"}, table.charted = false;
  for (const std::vector<std::string>& row : published("draw_calls_text").rows())
    table.rows.push_back({{row[0]}, {text_cell(row[0], walks)}});
  table.note = fmt::format(
      "Three numbers of ours are those of three levels, small to large ({}): the paper's scenes are not "
      "free. They "
      "are for height 4; nodes created are those of the structure as printed, nodes visited those that a "
      "walk "
      "looks at. Of ratios of calls the greatest over all heights is given, "
      "of frames the median at height "
      "4.",
      kinds(walks));
  return table;
}

std::string claims() {
  const CallRates rates = published_rates();
  return fmt::format(
      "The paper claims that frame rates fall with triangles and with draw calls (100,000 triangles from "
      "{:.0f} "
      "frames/s in one call to {:.0f} in 100,000), that a list shared by all cells takes {} times the calls, "
      "that a "
      "copy a cell draws {} times its frames/s, and that height {} is best.",
      rates.fps.front(), rates.at(0, rates.calls.size() - 1), said_in_text("simple / others: draw calls"),
      said_in_text("drawcall-wise and zhang / simple: fps"), said_in_text("best height over all scenes"));
}

std::string outcome(const DrawCallMeasurement& measured) {
  std::string out;
  if (!measured.rates.empty()) {
    const CallRates& rates = measured.rates;
    out = fmt::format("Here 100,000 triangles fall from {:.1f} frames/s in one call to {:.1f} in 100,000",
                      rates.fps.front(), rates.at(0, rates.calls.size() - 1));
  }
  if (!measured.walks.empty()) {
    const RivalRatios at_4 = rival_ratios(measured.walks, 4);
    out += fmt::format(
        "{} on {} levels at height 4 simple makes {} × the calls of drawcall-wise, whose frames/s are {} "
        "× "
        "simple's ({} × in a picture of {}x{}); the best height over all is {}",
        out.empty() ? "Here," : ";", measured.walks.size(), range_text(at_4.calls, 1),
        range_text(at_4.frames), range_text(at_4.small_frames), kSmallWidth, kSmallHeight,
        best_height_over_all(measured.walks));
  }
  return out.empty() ? "Nothing was measured." : out + ".";
}

std::string differences(const DrawCallMeasurement& measured) {
  if (measured.rates.empty()) return "So there is nothing to compare.";
  const CallRates theirs = published_rates();
  const CallWorth published = calls_worth(theirs).back(), ours = calls_worth(measured.rates).back();
  const double their_triangle = triangle_ns(theirs), our_triangle = triangle_ns(measured.rates);
  std::string out = fmt::format(
      "They differ by what things cost: in the column of 100,000 calls a call takes {:.2f} µs here ({:.2f} "
      "published) and a triangle {:.0f} ns ({:.0f}), so that a call is worth {:.1f} triangles ({:.1f})",
      ours.call_us, published.call_us, our_triangle, their_triangle, ours.triangles, published.triangles);
  if (ours.triangles < published.triangles) {
    out += ", and saving calls gains less than there";
  } else {
    out += ", and saving calls gains more than there";
  }
  return out + "; and the levels are others, for the paper's are not free.";
}

PaperSection missing_figures() {
  return {
      "missing: figures 1 to 5 and 7",
      "the paper's drawings and pictures of its own scenes",
      {},
      {},
      "Its scenes are three maps of Team Fortress 2, which are not free: three OpenArena levels stand in for "
      "them, and their cells are drawn from above below."};
}

}  // namespace

Reproduction draw_calls_reproduction(const DrawCallMeasurement& measured) {
  Reproduction out;
  out.paper = "draw-calls";
  out.title = "Serpa, Serpa & Rodrigues: culling that counts draw calls";
  out.machine = measured.machine;
  out.sentences = {claims(), outcome(measured), differences(measured)};
  out.tables = {table_1(measured.rates), text_figures(measured.walks)};
  out.sections = {
      figure_6(measured.rates),       diagonal_section(measured.rates),   call_worth_section(measured.rates),
      figure_8(measured.walks),       figure_9(measured.walks),           figure_10(measured.walks),
      rivals_section(measured.walks), structures_section(measured.walks), future_work_section(measured.walks),
      beyond_section(measured.walks), outcomes_section(measured.walks),   missing_figures(),
      levels_section(measured.walks)};
  return out;
}

}  // namespace sightline::reproduce
