// Occluders drawn as one mesh, beside peers: milliseconds a view, with wrong culls and excess.
//
//   occluder_meshes_benchmark SCENE [--peer FILE.so]... [--views N | --look ex,ey,ez,tx,ty,tz] [--headings N]
//                             [--two-sided] [--queries N] [--rounds N] [--size WxH] [--samples N]
//                             [--threads N] [--csv FILE] [--name NAME] [--draw N]
#include <dlfcn.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numeric>

#include <sightline/frustum.hpp>
#include <sightline/occlusion.hpp>
#include <sightline/tbb.hpp>
#include <sightline/workbench/error.hpp>
#include <sightline/workbench/io.hpp>

#include "library/occlusion/depth_tiles.hpp"
#include "occluder_truth.hpp"
#include "peer.h"
#include "workbench/camera/camera_path.hpp"
#include "workbench/io/text_file.hpp"
#include "workbench/scene/random.hpp"

namespace sightline::bench {
namespace {

// All opaque triangles of a scene in world space; vertices at one place are one.
struct Occluders {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> indices;
};

Occluders occluders_of(const Scene& scene) {
  Occluders out;
  for (ObjectId o = 0; o < scene.size(); ++o) {
    if (scene.surface[o] != Surface::opaque) continue;
    const Mesh& mesh = scene.meshes[scene.mesh[o]];
    const auto base = static_cast<std::uint32_t>(out.positions.size());
    for (std::uint32_t i = 0; i < mesh.vertex_count; ++i)
      out.positions.push_back(transform_point(scene.transform[o], scene.positions[mesh.first_vertex + i]));
    const bool turned = mirrors(scene.transform[o]);
    for (std::uint32_t i = 0; i < mesh.index_count; i += 3) {
      for (const std::uint32_t k : {0u, turned ? 2u : 1u, turned ? 1u : 2u})
        out.indices.push_back(base + scene.indices[mesh.first_index + i + k]);
    }
  }
  return out;
}

// Who draws and is asked.
class Contestant {
public:
  virtual ~Contestant() = default;
  virtual std::string name() const = 0;
  virtual void draw(const Camera& camera, const View& view) = 0;
  virtual void query(std::span<const Box> boxes, std::span<std::uint8_t> visible) = 0;
};

class Ours : public Contestant {
public:
  Ours(const OccluderMesh& mesh, std::string name, const OcclusionOptions& options,
       const JobSystem& jobs = {})
      : mesh_(mesh), name_(std::move(name)), options_(options), jobs_(jobs) {}
  std::string name() const override { return name_; }
  void draw(const Camera&, const View& view) override {
    or_throw(buffer_.begin({view, {}}, options_));
    or_throw(buffer_.draw_mesh(mesh_, {}, jobs_));
  }
  void query(std::span<const Box> boxes, std::span<std::uint8_t> visible) override {
    or_throw(buffer_.may_see(boxes, visible));
  }
  // Pixels of the view drawn last that hold nothing where there is something in truth.
  std::size_t pinholes(const OccluderTruth& truth) const {
    const View& view = buffer_.view().view;
    std::vector<float> pixels(std::size_t{view.width} * view.height);
    or_throw(buffer_.read_nearness(pixels));
    std::size_t out = 0;
    for (std::uint32_t i = 0; i < pixels.size(); ++i)
      out += !(pixels[i] > 0) && truth.nearness(i % view.width, i / view.width) > 0;
    return out;
  }

private:
  const OccluderMesh& mesh_;
  std::string name_;
  OcclusionOptions options_;
  JobSystem jobs_;
  OcclusionBuffer buffer_;
};

class Peer : public Contestant {
public:
  Peer(const std::string& file, const Occluders& occluders, bool two_sided, std::uint32_t width,
       std::uint32_t height)
      : library_(dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (!library_) throw Error(file + ": " + dlerror());
    name_ = function<decltype(&sightline_peer_name)>("sightline_peer_name")();
    begin_ = function<decltype(&sightline_peer_begin)>("sightline_peer_begin");
    draw_ = function<decltype(&sightline_peer_draw_mesh)>("sightline_peer_draw_mesh");
    query_ = function<decltype(&sightline_peer_query_boxes)>("sightline_peer_query_boxes");
    destroy_ = function<decltype(&sightline_peer_destroy)>("sightline_peer_destroy");
    peer_ = function<decltype(&sightline_peer_create)>("sightline_peer_create")(width, height);
    if (!peer_) throw Error(file + ": takes no image of that size");
    mesh_ = function<decltype(&sightline_peer_add_mesh)>("sightline_peer_add_mesh")(
        peer_, &occluders.positions[0].x, occluders.positions.size(), occluders.indices.data(),
        occluders.indices.size(), two_sided);
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  ~Peer() override {
    destroy_(peer_);
    dlclose(library_);
  }
  std::string name() const override { return name_; }
  void draw(const Camera& camera, const View& view) override {
    const Mat4 clip = world_to_clip(view);
    const Vec3 eye = eye_position(view);
    begin_(peer_, clip.m.data(), &eye.x, camera.near_plane);
    draw_(peer_, mesh_);
  }
  void query(std::span<const Box> boxes, std::span<std::uint8_t> visible) override {
    query_(peer_, &boxes[0].min.x, boxes.size(), visible.data());
  }

private:
  template <class Function>
  Function function(const char* called) {
    void* const found = dlsym(library_, called);
    if (!found) throw Error(std::string("a peer without ") + called);
    return reinterpret_cast<Function>(found);
  }

  void* library_;
  std::string name_;
  decltype(&sightline_peer_begin) begin_;
  decltype(&sightline_peer_draw_mesh) draw_;
  decltype(&sightline_peer_query_boxes) query_;
  decltype(&sightline_peer_destroy) destroy_;
  sightline_peer* peer_;
  std::uint32_t mesh_;
};

struct Options {
  std::string scene, size = "1280x720", csv, name;
  std::vector<std::string> peers;
  std::vector<float> look;
  std::size_t views = 50, headings = 1, queries = 2000, rounds = 11, draw = 0;
  std::uint32_t samples = 1, threads = 1;
  bool two_sided = false;
};

std::vector<Camera> cameras_of(const Scene& scene, const Options& options) {
  if (options.look.empty())
    return camera::make_path(scene, std::string(camera::default_path(scene)), options.views).cameras;
  const auto& l = options.look;
  std::vector<Camera> out;
  for (std::size_t i = 0; i < options.headings; ++i) {
    const double turn = 6.283185307179586 * static_cast<double>(i) / static_cast<double>(options.headings);
    const double x = l[3] - l[0], z = l[5] - l[2];
    Camera camera;
    camera.eye = {l[0], l[1], l[2]};
    camera.forward = {static_cast<float>(x * std::cos(turn) + z * std::sin(turn)), l[4] - l[1],
                      static_cast<float>(z * std::cos(turn) - x * std::sin(turn))};
    out.push_back(camera);
  }
  return out;
}

// Boxes of half a metre to three, all in view and before the near plane.
std::vector<Box> boxes_in(const Scene& scene, const View& view, float near_plane, std::size_t count) {
  scene::Random random(2);
  const Frustum frustum = make_frustum(view);
  const Vec3 eye = eye_position(view), ahead = view_direction(view);
  const Box everywhere = extent(scene);
  std::vector<Box> out;
  for (std::size_t tries = 0; out.size() < count && tries < 1000 * count; ++tries) {
    const Vec3 at = random.inside(everywhere), half = random.inside({{0.2f, 0.2f, 0.2f}, {1.5f, 1.5f, 1.5f}});
    const float depth = (at.x - eye.x) * ahead.x + (at.y - eye.y) * ahead.y + (at.z - eye.z) * ahead.z;
    const Box box{{at.x - half.x, at.y - half.y, at.z - half.z},
                  {at.x + half.x, at.y + half.y, at.z + half.z}};
    if (depth > near_plane + half.x + half.y + half.z && overlaps(frustum, box)) out.push_back(box);
  }
  return out;
}

struct Judged {
  std::size_t visible = 0;  // in truth
  std::size_t pinholes = 0;
  std::vector<std::size_t> wrong, excess;
};

void judge(const Occluders& occluders, const Scene& scene, std::span<const Camera> cameras,
           std::span<const View> views, const Options& options,
           std::span<const std::unique_ptr<Contestant>> contestants, const Ours& ours, Judged& out) {
  out.wrong.assign(contestants.size(), 0), out.excess.assign(contestants.size(), 0);
  for (std::size_t v = 0; v < views.size(); ++v) {
    OccluderTruth truth(views[v], cameras[v].near_plane, options.samples, v + 1);
    truth.draw(occluders.positions, occluders.indices, options.two_sided);
    const std::vector<Box> boxes = boxes_in(scene, views[v], cameras[v].near_plane, options.queries);
    std::vector<std::uint8_t> sees(boxes.size()), visible(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) out.visible += sees[i] = truth.sees(boxes[i]);
    for (std::size_t c = 0; c < contestants.size(); ++c) {
      contestants[c]->draw(cameras[v], views[v]);
      contestants[c]->query(boxes, visible);
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        out.wrong[c] += sees[i] && !visible[i];
        out.excess[c] += !sees[i] && visible[i];
      }
    }
    out.pinholes += ours.pinholes(truth);
  }
}

double milliseconds_a_view(Contestant& contestant, std::span<const Camera> cameras,
                           std::span<const View> views) {
  const auto start = std::chrono::steady_clock::now();
  // A single view is drawn often enough for the clock.
  const std::size_t turns = std::max<std::size_t>(1, 20 / views.size());
  for (std::size_t turn = 0; turn < turns; ++turn) {
    for (std::size_t v = 0; v < views.size(); ++v) contestant.draw(cameras[v], views[v]);
  }
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  return took.count() / static_cast<double>(turns * views.size());
}

// What drawing takes, a view: triangles that are set up, and tiles of the rectangles around what is drawn.
struct Work {
  double triangles, tiles;
};

Work work_of(const OccluderMesh& mesh, std::span<const View> views) {
  using occlusion::MeshBudget;
  constexpr double kPlenty = 1e12;
  OcclusionBuffer buffer;
  const auto spent = [&](MeshBudget budget) {
    double out = 0;
    for (const View& view : views) {
      or_throw(buffer.begin({view, {}}, {Coverage::centres}));
      budget.left = kPlenty;
      occlusion::draw_mesh(OcclusionAccess::tiles(buffer), OcclusionAccess::topology(mesh), {}, &budget);
      out += kPlenty - budget.left;
    }
    return out / static_cast<double>(views.size());
  };
  return {spent({.triangle = 1}), spent({.tile = 1})};
}

// A contestant's times, quickest first, and what it answered wrongly.
struct Result {
  std::string name;
  std::vector<double> milliseconds;
  std::size_t kept, wrong, excess;

  [[nodiscard]] double median() const { return milliseconds[milliseconds.size() / 2]; }
  // In per cent of what is visible.
  [[nodiscard]] double share(std::size_t visible) const {
    return visible == 0 ? 0 : 100 * static_cast<double>(excess) / static_cast<double>(visible);
  }
};

void print(std::span<const Result> results, const Judged& judged) {
  std::printf("%-40s %9s %9s %9s %8s %9s\n", "", "ms a view", "min", "max", "wrong", "excess %");
  for (const Result& r : results) {
    std::printf("%-40s %9.4f %9.4f %9.4f %8zu %9.2f\n", r.name.c_str(), r.median(), r.milliseconds.front(),
                r.milliseconds.back(), r.wrong, r.share(judged.visible));
  }
}

// A name as a row's id has it.
std::string word_of(const std::string& name) {
  std::string out;
  for (const char c : name) {
    const auto its = static_cast<unsigned char>(c);
    if (std::isalnum(its) || c == '?' || c == '=')
      out += static_cast<char>(std::tolower(its));
    else if (!out.empty() && out.back() != '-')
      out += '-';
  }
  return out;
}

// As scripts/figures/results.py has rows: each contestant's time and excess, and the work behind ours.
void write_csv(const Options& options, std::span<const Result> results, const Judged& judged,
               const Work& work) {
  std::string text =
      "benchmark,case,unit,median,min,max,repetitions,beside,ratio,kept,lost,lost_pixels,excess,commit,"
      "date\n";
  const std::string sides = options.two_sided ? "both/" : "fronts/";
  const auto row = [&](const std::string& of, const std::string& rest) {
    text += options.name + ',' + sides + of + ',' + rest + '\n';
  };
  const auto number = [](double value) { return fmt::format("{:.6g}", value); };
  for (const Result& r : results) {
    const std::string name = word_of(r.name);
    row(name, fmt::format("ms,{},{},{},{},,,{},{},,{},,", number(r.median()), number(r.milliseconds.front()),
                          number(r.milliseconds.back()), r.milliseconds.size(), r.kept, r.wrong, r.excess));
    row(name + "/excess", "%," + number(r.share(judged.visible)) + ",,,1,,,,,,,,");
  }
  row("triangles", "triangles," + number(work.triangles) + ",,,1,,,,,,,,");
  row("tiles", "tiles," + number(work.tiles) + ",,,1,,,,,,,,");
  io::write_file(options.csv, text);
}

void run(const Options& options) {
  std::uint32_t width = 0, height = 0;
  if (std::sscanf(options.size.c_str(), "%ux%u", &width, &height) != 2)
    throw Error("--size " + options.size + ": expected WIDTHxHEIGHT");
  const Scene scene = load_scene(options.scene);
  const Occluders occluders = occluders_of(scene);
  if (occluders.indices.empty()) throw Error(options.scene + ": expected opaque triangles");
  const std::vector<Camera> cameras = cameras_of(scene, options);
  std::vector<View> views;
  for (const Camera& camera : cameras) views.push_back(or_throw(make_view(camera, width, height)));
  std::vector<std::unique_ptr<Contestant>> contestants;
  const OccluderMesh mesh =
      or_throw(OccluderMesh::make(occluders.positions, occluders.indices,
                                  options.two_sided ? Sides::both : Sides::front, TJunctions::closed));
  auto owned = std::make_unique<Ours>(mesh, "sightline", OcclusionOptions{Coverage::centres});
  const Ours& ours = *owned;
  contestants.push_back(std::move(owned));
  contestants.push_back(
      std::make_unique<Ours>(mesh, "sightline?coverage=area", OcclusionOptions{Coverage::area}));
  contestants.push_back(
      std::make_unique<Ours>(mesh, "sightline?scale=2", OcclusionOptions{Coverage::centres, 2}));
  if (options.threads > 1) {
    contestants.push_back(std::make_unique<Ours>(mesh, "sightline?threads=" + std::to_string(options.threads),
                                                 OcclusionOptions{Coverage::centres},
                                                 tbb_jobs(options.threads)));
  }
  for (const std::string& file : options.peers)
    contestants.push_back(std::make_unique<Peer>(file, occluders, options.two_sided, width, height));
  if (options.draw > 0) {
    for (std::size_t turn = 0; turn < options.draw; ++turn) {
      for (std::size_t v = 0; v < views.size(); ++v) contestants.front()->draw(cameras[v], views[v]);
    }
    return;
  }
  Judged judged;
  judge(occluders, scene, cameras, views, options, contestants, ours, judged);
  std::vector<Result> results;
  for (std::size_t c = 0; c < contestants.size(); ++c) {
    const std::size_t kept = judged.visible - judged.wrong[c] + judged.excess[c];
    results.push_back({contestants[c]->name(), {}, kept, judged.wrong[c], judged.excess[c]});
  }
  for (std::size_t round = 0; round < options.rounds; ++round) {
    for (std::size_t c = 0; c < contestants.size(); ++c)
      results[c].milliseconds.push_back(milliseconds_a_view(*contestants[c], cameras, views));
  }
  for (Result& r : results) std::ranges::sort(r.milliseconds);
  const Work work = work_of(mesh, views);
  std::printf("%s: %zu triangles, %zu views of %ux%u, %s\n", scene.name.c_str(), occluders.indices.size() / 3,
              views.size(), width, height, options.two_sided ? "both sides" : "fronts");
  print(results, judged);
  std::printf("a view sets up %.0f triangles and looks at %.0f tiles\n", work.triangles, work.tiles);
  std::printf("%.1f pixels a view are open that hold something in truth\n",
              static_cast<double>(judged.pinholes) / static_cast<double>(views.size()));
  if (!options.csv.empty()) write_csv(options, results, judged, work);
}

}  // namespace
}  // namespace sightline::bench

int main(int argc, char** argv) {
  CLI::App app("Occluders drawn as one mesh, beside peers");
  sightline::bench::Options options;
  app.add_option("scene", options.scene, "As sightline takes it")->required();
  app.add_option("--peer", options.peers, "A shared library with the functions of peer.h; may be repeated");
  const CLI::Range some(std::size_t{1}, std::size_t{1'000'000});
  app.add_option("--views", options.views, "Along the scene's own path")->check(some);
  app.add_option("--look", options.look, "Eye and target instead of a path")->expected(6)->delimiter(',');
  app.add_option("--headings", options.headings, "Turns of that view about the vertical")->check(some);
  app.add_option("--queries", options.queries, "Boxes asked for a view")->check(some);
  app.add_option("--rounds", options.rounds, "Of timing, all contestants in each")->check(some);
  app.add_option("--samples", options.samples, "Of the truth: 1 is the centre, more lie anywhere in a pixel")
      ->check(CLI::Range(1u, 64u));
  app.add_option("--threads", options.threads, "Draw with so many as well")
      ->check(CLI::Range(1u, sightline::kMaxJobs));
  app.add_option("--size", options.size, "Of the image");
  CLI::Option* const name = app.add_option("--name", options.name, "What rows call the scene");
  app.add_option("--csv", options.csv, "Also write the rows that scripts/measure.sh takes")->needs(name);
  app.add_option("--draw", options.draw, "Only draw all views so many times, for a profiler")->check(some);
  app.add_flag("--two-sided", options.two_sided, "Both sides occlude, not fronts alone");
  try {
    app.parse(argc, argv);
    sightline::bench::run(options);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const sightline::Error& error) {
    std::fprintf(stderr, "occluder_meshes_benchmark: %s\n", error.what());
    return 2;
  }
}
