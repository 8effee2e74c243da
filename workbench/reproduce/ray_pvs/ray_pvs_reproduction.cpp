// Ye et al. 2023 as tables and figures, out of what was measured and what is published.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "workbench/reproduce/published.hpp"
#include "workbench/reproduce/ray_pvs/ray_pvs.hpp"

namespace sightline::reproduce {

namespace {

using report::format_count;
using report::format_ms;

std::string number_text(std::uint64_t number) {
  return format_count(static_cast<double>(number));
}

std::string percent(double part, double whole, int decimals = 2) {
  return whole > 0 ? fmt::format("{:.{}f} %", 100 * part / whole, decimals) : "–";
}

/// What stands in a paper's column of a model's row.
Cell published_cell(const char* file, std::string_view model, std::string_view column) {
  return {published(file).text({{"model", model}}, column), {}, {}};
}

const RayPvsModel* measured_model(const RayPvs& measured, std::string_view number) {
  for (const RayPvsModel& model : measured.models) {
    if (std::to_string(model.model) == number) return &model;
  }
  return nullptr;
}

/// The paper's numbers of its five models.
std::vector<std::string> model_numbers() {
  const Published& models = published("ray_pvs_models");
  std::vector<std::string> numbers;
  for (const auto& row : models.rows()) numbers.push_back(row[models.column("model")]);
  return numbers;
}

PaperTable models_table(const RayPvs& measured) {
  PaperTable table;
  table.name = "table 4", table.title = "the five models";
  table.keys = {"model"};
  table.columns = {"name", "triangles", "meshes", "size", "scale"};
  for (const std::string& number : model_numbers()) {
    PaperTable::Row row{{number}, {}};
    for (const std::string& column : table.columns)
      row.cells.push_back(published_cell("ray_pvs_models", number, column));
    if (const RayPvsModel* model = measured_model(measured, number)) {
      row.cells[0].our_words = fmt::format("world:strata?model={}&full=yes", number);
      row.cells[1].ours = static_cast<double>(model->full.triangles);
      row.cells[2].ours = static_cast<double>(model->full.meshes);
      const double bytes =
          24 * static_cast<double>(model->full.vertices) + 12 * static_cast<double>(model->full.triangles);
      row.cells[3].our_words = fmt::format("{:.2f} GB", bytes / 1e9);
      row.cells[4].our_words =
          fmt::format("{:.0f} km across", (model->extent.max.z - model->extent.min.z) / 1000);
    }
    table.rows.push_back(std::move(row));
  }
  table.note =
      "The paper's models are not public. Ours are layered, folded and faulted strata, made with the paper's "
      "meshes; triangles are those of full=yes, counted from the plan that the world is made by, and the "
      "size "
      "is that of its vertices, normals and indices. All are of one size on the ground, whatever the scale "
      "of "
      "the map: from V = (40000, 0, 0), level, they fit into the picture.";
  if (!measured.models.empty()) {
    table.note += " The times below are of fewer triangles: ";
    for (const RayPvsModel& model : measured.models)
      table.note += fmt::format("{}{} of model {}", &model == measured.models.data() ? "" : ", ",
                                number_text(model.triangles), model.model);
    table.note += ".";
  }
  return table;
}

constexpr std::size_t kPublishedMethods = kSaa + 1;

/// Milliseconds by model and method, with ratios to BOCA's.
template <class Time>
PaperTable times_table(const RayPvs& measured, std::string name, std::string title, bool with_published,
                       const Time& time) {
  PaperTable table;
  table.name = std::move(name), table.title = std::move(title);
  table.keys = {"model"};
  table.base = PaperTable::Base::column, table.base_column = kBoca;
  for (const char* method : kRayMethods) table.columns.push_back(fmt::format("{} ms", method));
  for (const std::string& number : model_numbers()) {
    PaperTable::Row row{{number}, std::vector<Cell>(kRayMethodCount)};
    const RayPvsModel* model = measured_model(measured, number);
    for (std::size_t m = 0; m < kRayMethodCount; ++m) {
      if (with_published && m < kPublishedMethods)
        row.cells[m] = published_cell("ray_pvs_times", number, fmt::format("{}_ms", kRayMethods[m]));
      if (model) row.cells[m].ours = time(*model, m);
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// By how much less time than BOCA a method takes, in percent.
double improvement(double ms, double boca_ms) {
  return boca_ms > 0 ? 100 * (1 - ms / boca_ms) : 0;
}

template <class Time>
PaperTable improvement_table(const RayPvs& measured, std::string name, std::string title, bool with_published,
                             const Time& time) {
  PaperTable table;
  table.name = std::move(name), table.title = std::move(title);
  table.keys = {"model"};
  for (const std::string& number : model_numbers()) {
    PaperTable::Row row{{number}, {}};
    for (const RayMethod method : {kIwcpa, kSaa}) {
      const std::string column = fmt::format("{}_improvement_percent", kRayMethods[method]);
      Cell cell;
      if (with_published) cell = published_cell("ray_pvs_times", number, column);
      if (const RayPvsModel* model = measured_model(measured, number))
        cell.ours = improvement(time(*model, method), time(*model, kBoca));
      row.cells.push_back(std::move(cell));
    }
    table.rows.push_back(std::move(row));
  }
  table.columns = {"iwcpa improvement percent", "saa improvement percent"};
  return table;
}

double ready_ms(const RayPvsModel& model, std::size_t method) {
  return model.ready[method].total();
}
double first_ms(const RayPvsModel& model, std::size_t method) {
  return model.first[method].total();
}

std::vector<PaperTable> times_tables(const RayPvs& measured) {
  std::vector<PaperTable> tables{
      times_table(measured, "table 6, ready", "a PVS while tree, pipelines and buffers stand", true,
                  ready_ms),
      improvement_table(measured, "table 6, ready: improvement", "less time than BOCA, in percent", true,
                        ready_ms),
      times_table(measured, "table 6, first PVS", "from triangles alone to the first drawn frame", false,
                  first_ms),
      improvement_table(measured, "table 6, first PVS: improvement", "less time than BOCA, in percent", false,
                        first_ms)};
  tables[0].note =
      "The paper does not say what its times hold. They stand here, beside the cast alone: rays, boxes and "
      "what goes to the device and comes back. iwcpa is as printed, a lane a pair of ray and "
      "box; tuned-iwcpa is ours, with the same set.";
  tables[1].note = "100 × (1 − time / BOCA's time), as the paper's text counts it.";
  tables[2].note =
      "Boxes out of triangles, tree, pipelines and buffers, cast, and one frame that draws the set. The "
      "published side is empty because the paper has one set of times, which stands above; its IWCPA hardly "
      "grows with the boxes and its BOCA is slowest on the model of the most triangles, so that its times "
      "probably hold some of this.";
  return tables;
}

report::Table parts_table(const RayPvs& measured) {
  report::Table table;
  table.text_columns = 2;
  table.header = {"model",     "method",       "CPU ms", "upload", "compute",
                  "read-back", "first: boxes", "made",   "cast",   "frame"};
  for (const RayPvsModel& model : measured.models) {
    for (std::size_t m = 0; m < kRayMethodCount; ++m) {
      const ReadyTime& r = model.ready[m];
      const FirstTime& f = model.first[m];
      table.rows.push_back({std::to_string(model.model), kRayMethods[m]});
      for (const double ms : {r.cpu, r.upload, r.compute, r.read_back, f.boxes, f.made, f.cast, f.frame})
        table.rows.back().push_back(format_ms(ms));
    }
  }
  return table;
}

report::Table mapping_table(const RayPvs& measured) {
  report::Table table;
  table.header = {"model", "boxes", "printed ms", "tuned ms", "printed / tuned", "same set"};
  for (const RayPvsModel& model : measured.models) {
    const double printed = ready_ms(model, kIwcpa), tuned = ready_ms(model, kTunedIwcpa);
    table.rows.push_back({std::to_string(model.model), number_text(model.meshes), format_ms(printed),
                          format_ms(tuned), report::format_ratio(printed, tuned, 2),
                          model.identical ? "yes" : "NO"});
  }
  return table;
}

report::Table loss_table(const RayPvs& measured) {
  report::Table table;
  table.header = {"model", "all alike", "visible", "in the PVS", "lost objects", "lost pixels", "share"};
  for (const RayPvsModel& m : measured.models) {
    table.rows.push_back(
        {std::to_string(m.model), m.identical ? "yes" : "NO", number_text(m.visible), number_text(m.kept),
         number_text(m.lost_objects), number_text(m.lost_pixels),
         percent(static_cast<double>(m.lost_pixels), static_cast<double>(m.object_pixels), 3)});
  }
  return table;
}

report::Table guided_loss_table(const RayPvs& measured) {
  report::Table table;
  table.header = {"model", "guided: lost pixels", "share", "rays", "ms"};
  for (const RayPvsModel& m : measured.models) {
    table.rows.push_back(
        {std::to_string(m.model), number_text(m.guided_lost_pixels),
         percent(static_cast<double>(m.guided_lost_pixels), static_cast<double>(m.object_pixels), 4),
         number_text(m.guided_rays), format_ms(m.guided_ms)});
  }
  return table;
}

/// Rounded, and never the 0 that has a sign.
float whole(float metres) {
  return std::round(metres) + 0.0f;
}

report::Table viewpoint_table(const RayPvs& measured) {
  report::Table table;
  table.header = {"viewpoint", "kept", "everything ms", "PVS ms", "ratio"};
  for (const RayViewpoint& v : measured.viewpoints) {
    table.rows.push_back({fmt::format("({:g}, {:g}, {:g})", whole(v.eye.x), whole(v.eye.y), whole(v.eye.z)),
                          number_text(v.kept), format_ms(v.everything_ms), format_ms(v.pvs_ms),
                          fmt::format("{:.2f}", v.ratio())});
  }
  return table;
}

report::Table break_time_table(const RayPvs& measured) {
  report::Table table;
  table.header = {"sets every", "viewpoints", "idle ms",       "bytes",         "cast ms",
                  "look-up ms", "cast: lost", "look-up: lost", "of the cast's", "its worst frame"};
  for (const BreakTime& b : measured.break_time) {
    const auto pixels = static_cast<double>(b.pixels);
    table.rows.push_back({fmt::format("{:g}°", b.spacing), number_text(b.viewpoints), format_ms(b.idle_ms),
                          number_text(b.bytes), format_ms(b.cast_ms), fmt::format("{:.5f}", b.look_up_ms),
                          percent(static_cast<double>(b.cast_lost_pixels), pixels),
                          percent(static_cast<double>(b.look_up_lost_pixels), pixels),
                          percent(static_cast<double>(b.between_lost_pixels), pixels),
                          percent(b.worst_share, 1)});
  }
  return table;
}

std::string break_time_chart(const RayPvs& measured) {
  if (measured.break_time.empty()) return "";
  Chart made;
  made.id = "break-time";
  made.x = "degrees between the viewpoints computed ahead";
  made.y = "% of the pixels";
  Series all{"lost between viewpoints", {}}, worst{"in the worst frame", {}};
  for (const BreakTime& b : measured.break_time) {
    made.labels.push_back(fmt::format("{:g}", b.spacing));
    all.values.push_back(100 * static_cast<double>(b.between_lost_pixels) /
                         std::max(1.0, static_cast<double>(b.pixels)));
    worst.values.push_back(100 * b.worst_share);
  }
  made.series = {std::move(all), std::move(worst)};
  return chart(made);
}

/// The pictures of a figure; none where none were drawn.
std::string pictures_of(const RayPvs& measured, std::string_view figure) {
  std::string html;
  for (const RayPicture& p : measured.pictures) {
    if (p.figure != figure) continue;
    html += p.before.empty() ? picture(p.file, p.caption) : before_after(p.before, p.file, p.caption);
  }
  return html;
}

PaperSection figure(const RayPvs& measured, const char* name, const char* title, std::string note = "") {
  PaperSection section{name, title, {}, pictures_of(measured, name), std::move(note)};
  if (section.html.empty())
    section.note +=
        std::string(section.note.empty() ? "" : " ") + "Its pictures are drawn with --report DIR.";
  return section;
}

void add_figures(const RayPvs& measured, std::vector<PaperSection>& sections) {
  sections.push_back(figure(measured, "figure 6", "the tree's boxes"));
  sections.push_back(figure(measured, "figure 11", "the five models"));
  sections.push_back(figure(measured, "figure 12a", "what is kept and what is culled, from V",
                            "Lost is what shows in the item buffer and is not in the set; guided rays go to "
                            "the triangles instead of the boxes, until a target is met."));
  sections.back().tables = {loss_table(measured), guided_loss_table(measured)};
  sections.push_back(figure(measured, "figure 12b", "what is kept and what is culled, from above"));
  sections.push_back(
      figure(measured, "figure 13", "rendering time of everything to that of the PVS alone, around model 4"));
  sections.back().tables = {viewpoint_table(measured)};
}

std::vector<PaperSection> sections_of(const RayPvs& measured) {
  std::vector<PaperSection> sections;
  sections.push_back({"table 6, in parts", "where the times go", {parts_table(measured)}, "", ""});
  sections.push_back(
      {"iwcpa's mapping",
       "a lane a pair, 16 × 16 a workgroup, beside the tuned form",
       {mapping_table(measured)},
       "",
       "As printed, every distance goes to memory and comes back; tuned, a lane keeps the nearest "
       "of its boxes to itself. Both leave the same set, to the id."});
  add_figures(measured, sections);
  sections.push_back(
      {"break-time",
       "sets computed ahead along a path, and looked up when the camera gets there",
       {break_time_table(measured)},
       break_time_chart(measured),
       "Model 1, along a quarter of the circle through V. A look-up takes the set of the nearest viewpoint, "
       "which between viewpoints is another view's: of what a cast keeps there, it lacks the objects of so "
       "many "
       "pixels. Sets of another view may keep what the rays of this one miss, so that in all it need not "
       "lose "
       "more."});
  sections.push_back(
      {"beyond the paper: guided rays",
       fmt::format("against the item buffer at {} × {}; their target is to lose {:g} % at most",
                   kRaySceneWidth, kRaySceneHeight, 100 * kGuidedTarget),
       {guided_table(measured.scenes)},
       "",
       ""});
  for (const std::string& why : measured.left_out) sections.back().note += "Left out: " + why + " ";
  sections.push_back(
      {"beyond the paper: triangles",
       fmt::format("what {0} × {0} rays at triangles lose in the same views", kRaySceneSide),
       {triangle_pvs_table(measured.scenes)},
       "",
       "The rays stand 13 × 7 pixels apart: whatever covers a block of that size has one of them."});
  sections.push_back(
      {"missing: the models, the browser and the machine",
       "an i7-8700 with a Quadro P620, WebGPU in a browser",
       {},
       "",
       "Times are compared as ratios, model by model, for this is another machine, and the program "
       "is no web page. The models are not public."});
  sections.push_back(
      {"missing: tables 1 to 3 and 5, figures 1 to 5 and 7 to 10",
       "nothing in them to measure",
       {},
       "",
       "What is published of measurements and models is tables 4 and 6 and figures 6, 11, 12 and "
       "13; the others have no number here to hold ours against."});
  return sections;
}

/// The least and the greatest of what `of` gives for the models.
template <class Of>
std::pair<double, double> range(const RayPvs& measured, const Of& of) {
  double least = of(measured.models.front()), most = least;
  for (const RayPvsModel& model : measured.models)
    least = std::min(least, of(model)), most = std::max(most, of(model));
  return {least, most};
}

std::pair<double, double> published_range(std::string_view column) {
  double least = 1e300, most = -1e300;
  for (const std::string& number : model_numbers()) {
    const auto value = number_of(published("ray_pvs_times").text({{"model", number}}, column));
    if (value) least = std::min(least, *value), most = std::max(most, *value);
  }
  return {least, most};
}

std::string claim() {
  const auto iwcpa = published_range("iwcpa_improvement_percent"),
             saa = published_range("saa_improvement_percent");
  return fmt::format(
      "The paper claims that the GPU finds a PVS in less time than BOCA does on the CPU: in {:g} to {:g} % "
      "less "
      "with IWCPA and in {:g} to {:g} % less with SAA, over five models.",
      iwcpa.first, iwcpa.second, saa.first, saa.second);
}

std::string outcome(const RayPvs& measured) {
  const auto ratio = [&](auto time, std::size_t method) {
    return range(measured, [=](const RayPvsModel& m) { return time(m, method) / time(m, kBoca); });
  };
  const auto iwcpa = ratio(ready_ms, kIwcpa), saa = ratio(ready_ms, kSaa), first = ratio(first_ms, kSaa);
  const auto lost = range(measured, [](const RayPvsModel& m) {
    return 100 * static_cast<double>(m.lost_pixels) /
           static_cast<double>(std::max<std::uint64_t>(1, m.object_pixels));
  });
  const bool alike = std::ranges::all_of(measured.models, [](const RayPvsModel& m) { return m.identical; });
  return fmt::format(
      "Here, once all stands ready, iwcpa as printed takes {:.2f} to {:.2f} and saa {:.2f} to {:.2f} times "
      "as "
      "long as boca; up to the first drawn frame saa takes {:.2f} to {:.2f} times as long; the methods {}, "
      "and "
      "from V the set lacks {:.2f} to {:.2f} % of the pixels.",
      iwcpa.first, iwcpa.second, saa.first, saa.second, first.first, first.second,
      alike ? "all find the same set, to the id" : "DO NOT find the same set", lost.first, lost.second);
}

/// Of the models, in how many our sign of the improvement is the paper's.
std::size_t same_signs(const RayPvs& measured, std::size_t method) {
  return static_cast<std::size_t>(std::ranges::count_if(measured.models, [&](const RayPvsModel& m) {
    const auto theirs = number_of(published("ray_pvs_times")
                                      .text({{"model", std::to_string(m.model)}},
                                            fmt::format("{}_improvement_percent", kRayMethods[method])));
    return theirs && (*theirs > 0) == (ready_ms(m, method) < ready_ms(m, kBoca));
  }));
}

/// The model that takes BOCA longest.
template <class Time>
int slowest(const RayPvs& measured, const Time& time) {
  return std::ranges::max_element(measured.models, {}, [&](const RayPvsModel& m) { return time(m, kBoca); })
      ->model;
}

std::string difference(const RayPvs& measured) {
  std::string theirs;
  double most = 0;
  for (const std::string& number : model_numbers()) {
    const double ms = number_of(published("ray_pvs_times").text({{"model", number}}, "boca_ms")).value_or(0);
    if (ms > most) most = ms, theirs = number;
  }
  const std::string ready = std::to_string(slowest(measured, ready_ms)),
                    first = std::to_string(slowest(measured, first_ms));
  std::string out =
      fmt::format("The sign of the improvement is the paper's for iwcpa on {} and for saa on {} of {} models",
                  same_signs(measured, kIwcpa), same_signs(measured, kSaa), measured.models.size());
  if (measured.device_kind == "CPU")
    out += ", and our GPU is a CPU, which computes every pair on its few cores";
  out += fmt::format(
      "; the published BOCA takes longest on model {}, ours on model {} when ready and on model {} up to the "
      "first frame",
      theirs, ready, first);
  if (first == theirs && ready != theirs)
    out += ", so that the published times probably hold what grows with triangles, as our first frame's do";
  return out + ".";
}

}  // namespace

Reproduction ray_pvs_reproduction(const RayPvs& measured) {
  Reproduction out{"ray-pvs", "Ye et al. 2023: visible sets by rays at boxes", measured.machine, {}, {}, {}};
  out.sentences = {claim()};
  if (measured.models.empty()) {
    out.sentences.emplace_back("Nothing was measured.");
    out.sentences.emplace_back("So there is nothing to compare.");
  } else {
    out.sentences.push_back(outcome(measured));
    out.sentences.push_back(difference(measured));
  }
  out.tables.push_back(models_table(measured));
  for (PaperTable& table : times_tables(measured)) out.tables.push_back(std::move(table));
  out.sections = sections_of(measured);
  return out;
}

}  // namespace sightline::reproduce
