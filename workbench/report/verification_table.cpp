#include "workbench/report/verification_table.hpp"

namespace sightline::report {

namespace {

const char* verdict_of(const measure::MethodVerdict& v) {
  if (!v.holds()) return "BROKEN";
  if (v.of_centres) return v.lost_objects > 0 ? "of centres alone" : "lost nothing";
  if (v.guarantee != Guarantee::approximate) return "holds";
  return v.lost_objects > 0 ? "approximate" : "lost nothing";
}

}  // namespace

Table verification_table(const measure::Verification& verification) {
  Table table;
  table.header = {"method", "guarantee", "kept", "visible", "lost objects", "lost pixels"};
  if (verification.drawn()) table.header.emplace_back("different pixels");
  table.header.insert(table.header.end(), {"excess objs", "verdict"});
  table.text_columns = 2;
  const auto count = [](std::uint64_t n) { return format_count(static_cast<double>(n)); };
  for (const measure::MethodVerdict& v : verification.methods) {
    std::vector<std::string> row{v.method,
                                 std::string(to_string(v.guarantee)),
                                 count(v.kept),
                                 count(v.visible),
                                 count(v.lost_objects),
                                 count(v.lost_pixels)};
    if (verification.drawn()) row.push_back(count(v.different_pixels));
    row.push_back(count(v.excess_objects));
    row.emplace_back(verdict_of(v));
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace sightline::report
