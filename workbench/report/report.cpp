#include "workbench/report/report.hpp"

#include <algorithm>

#include "workbench/io/text_file.hpp"
#include "workbench/report/page.hpp"
#include "workbench/report/page_folder.hpp"
#include "workbench/report/pictures.hpp"

namespace sightline::report {

std::size_t picture_view(const measure::Comparison& comparison) {
  const auto worth = [](const measure::Row& row) { return std::pair(row.lost_pixels, row.truly_visible); };
  const auto best =
      std::max_element(comparison.rows.begin(), comparison.rows.end(),
                       [&](const measure::Row& a, const measure::Row& b) { return worth(a) < worth(b); });
  return best == comparison.rows.end() ? 0 : best->view;
}

void write_report(const std::filesystem::path& target, const measure::Comparison& comparison,
                  const Scene& scene, const Snapshot& snapshot) {
  PageFolder made(target);
  const std::filesystem::path& folder = made.path();
  constexpr std::uint32_t kTopViewWidth = 900;
  report::PageContent content{comparison, scene, snapshot, "item-buffer.png", {}};
  report::draw_item_buffer(snapshot.view, snapshot.truth).write_png(folder / content.item_buffer);
  for (std::size_t m = 0; m < snapshot.methods.size(); ++m) {
    content.top_views.push_back("top-view-" + std::to_string(m + 1) + ".svg");
    io::write_file(folder / content.top_views.back(),
                   report::draw_top_view(scene, snapshot, snapshot.methods[m], kTopViewWidth));
  }
  io::write_file(folder / "index.html", report::make_page(content));
  made.commit();
}

}  // namespace sightline::report
