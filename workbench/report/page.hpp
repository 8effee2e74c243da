// The report's page as text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "workbench/measure/compare.hpp"
#include "workbench/report/outcome.hpp"
#include "workbench/report/table.hpp"

namespace sightline::report {

/// What the page shows beside the comparison itself.
struct PageContent {
  const measure::Comparison& comparison;
  const Scene& scene;
  const Snapshot& snapshot;
  std::string item_buffer;             ///< picture's file name
  std::vector<std::string> top_views;  ///< one a method of the snapshot
};

/// A whole HTML document that loads nothing but the pictures beside it.
std::string make_page(const PageContent& content);

/// Text as it may stand in HTML, between tags or in a quoted attribute; bytes that are not UTF-8 become
/// U+FFFD.
std::string escape(std::string_view text);

/// As HTML; of class "numbers" where all but the first column are figures.
std::string html(const Table& table);

}  // namespace sightline::report
