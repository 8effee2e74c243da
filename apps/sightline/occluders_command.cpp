// sightline occluders: what may occlude in the place of a scene's meshes.
#include <fmt/format.h>

#include <memory>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/io.hpp>

#include "command.hpp"
#include "workbench/measure/made_occluders.hpp"

namespace sightline::app {

namespace {

struct OccludersCall {
  std::string scene, output;
  OccluderOptions options;
  std::size_t views = 0;
  std::uint32_t pixels = 640;
  RasterState faces = RasterState::materials;
};

constexpr std::size_t kMostRows = 40;  // meshes that are told one by one

void print_row(const measure::MadeOccluder& made) {
  fmt::print("mesh {:<5} {:<5} {:>8} triangles, {:>6} objects: {:>3} triangles, {} inside; {} boxes; {}\n",
             made.mesh, made.sides == Sides::front ? "front" : "both", made.triangles, made.objects,
             made.occluder.sides.size(), made.occluder.solid_triangles, made.occluder.boxes.size(),
             to_string(made.occluder.yield));
}

void print_sum(const std::vector<measure::MadeOccluder>& occluders) {
  std::size_t from = 0, to = 0, boxes = 0, none = 0;
  for (const measure::MadeOccluder& made : occluders) {
    from += made.triangles, to += made.occluder.sides.size(), boxes += made.occluder.boxes.size();
    none += made.occluder.sides.empty() && made.occluder.boxes.empty();
  }
  fmt::print("{} meshes of {} triangles: {} triangles and {} boxes occlude; {} meshes yield nothing\n",
             occluders.size(), from, to, boxes, none);
}

// Whether the oracle finds no pixel that is covered wrongly.
bool examine_all(const Scene& scene, const std::vector<measure::MadeOccluder>& occluders,
                 const OccludersCall& call) {
  measure::OccluderEvidence sum;
  double least = 1;
  const auto tell = progress("meshes examined");
  for (std::size_t i = 0; i < occluders.size(); ++i) {
    const auto evidence = measure::examine(scene, occluders[i], call.views, call.pixels);
    sum.mesh_pixels += evidence.mesh_pixels, sum.covered_pixels += evidence.covered_pixels;
    sum.box_pixels += evidence.box_pixels, sum.wrong_pixels += evidence.wrong_pixels;
    if (evidence.mesh_pixels > 0) least = std::min(least, evidence.covered());
    if (occluders.size() <= kMostRows)
      fmt::print("mesh {:<5} covers {:5.1f} % of the pixels of its mesh, {} wrongly\n", occluders[i].mesh,
                 100 * evidence.covered(), evidence.wrong_pixels);
    tell(i + 1, occluders.size());
  }
  fmt::print(
      "{} views each of {}x{}: {:.1f} % of the pixels of the meshes are covered, of one mesh at least "
      "{:.1f} %; {} pixels wrongly\n",
      call.views, call.pixels, call.pixels, 100 * sum.covered(), 100 * least, sum.wrong_pixels);
  return sum.wrong_pixels == 0;
}

int run_occluders(const OccludersCall& call) {
  if (call.options.most_triangles == 0 && call.options.most_boxes == 0)
    throw Error("--triangles and --boxes are 0, expected room for some triangles or boxes");
  expect_apart({{"SCENE", call.scene}}, {{"--output", call.output}});
  Scene scene = load_scene(call.scene);
  set_raster_state(scene, call.faces);
  const auto occluders = measure::make_occluders(scene, call.options, progress("meshes"));
  if (!call.output.empty()) {
    const Scene made = measure::occluder_scene(scene, occluders);
    if (made.empty()) throw Error(call.scene + ": nothing occludes, so there is nothing to write");
    write_glb(made, call.output);
  }
  if (occluders.size() <= kMostRows) {
    for (const measure::MadeOccluder& made : occluders) print_row(made);
  }
  print_sum(occluders);
  return call.views == 0 || examine_all(scene, occluders, call) ? Exit::done : Exit::check_failed;
}

}  // namespace

void add_occluders(CLI::App& app, int& exit) {
  CLI::App& command = *app.add_subcommand(
      "occluders", "Make simple occluders of a scene's opaque meshes, which cover nothing that these do not");
  auto call = std::make_shared<OccludersCall>();
  command.add_option("SCENE", call->scene, kSceneHelp)->required();
  command
      .add_option(
          "-o,--output", call->output,
          "write the scene's occluders in its objects' places: triangles, or boxes where there is none")
      ->check(output_file(".glb"))
      ->type_name("FILE.glb");
  command.add_option("--triangles", call->options.most_triangles, "at most so many a mesh")
      ->transform(whole(0, 4096))
      ->capture_default_str();
  command.add_option("--boxes", call->options.most_boxes, "at most so many a mesh")
      ->transform(whole(0, 64))
      ->capture_default_str();
  command
      .add_option(
          "--views", call->views,
          "look at each mesh so often, and hold what is covered against rays: exit code 1 where a pixel is "
          "covered wrongly")
      ->transform(whole(0, 100000))
      ->capture_default_str();
  command.add_option("--pixels", call->pixels, "the side of such a view")
      ->transform(whole(1, 4096))
      ->capture_default_str();
  add_faces(command, call->faces);
  on_run(command, exit, [call] { return run_occluders(*call); });
}

}  // namespace sightline::app
