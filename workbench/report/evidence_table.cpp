#include "workbench/report/evidence_table.hpp"

namespace sightline::report {

Table evidence_table(const measure::LevelEvidence& evidence) {
  const auto figure = [](std::uint64_t count) { return format_count(static_cast<double>(count)); };
  Table table;
  table.header = {"objects seen from " + figure(evidence.eyes) + " places", "objects"};
  table.rows.push_back(
      {"in the leaf's potentially visible set", figure(evidence.objects_seen - evidence.objects_denied)});
  for (std::size_t i = 0; i < measure::kPvsExceptions; ++i) {
    table.rows.push_back({std::string(measure::explanation(static_cast<measure::PvsException>(i))),
                          figure(evidence.objects[i])});
  }
  return table;
}

}  // namespace sightline::report
