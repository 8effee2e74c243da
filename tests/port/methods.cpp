// Prints what every method keeps, scene by scene: on the CPU, or with --device on a device, where the first
// line says whose driver answers. scripts/check-answers.sh holds it against tests/port/methods.txt and
// devices/DRIVER.txt.
#include <algorithm>
#include <cctype>
#include <cstring>
#include <string>
#include <vector>

#include <sightline/workbench/method.hpp>
#include <sightline/workbench/worlds.hpp>

#include "port/answers.hpp"
#include "workbench/camera/camera_path.hpp"
#include "workbench/camera/random_views.hpp"
#include "workbench/device/renderer.hpp"
#include "workbench/scene/random.hpp"

namespace {

using namespace sightline;
using test::Answers;
using test::Hash;

constexpr const char* kScenes[] = {"regular?columns=20&rows=20&detail=0",
                                   "irregular?spheres=500&size=60&detail=0",
                                   "forest?trees=300&size=100",
                                   "forest?trees=200&size=100&offset=1000000",
                                   "city?objects=800",
                                   "foliage?plants=60&hedges=20&grates=20&boxes=60&size=50",
                                   "soup?triangles=2000&size=60"};
constexpr std::size_t kViews = 2;  // along the path, and as many random ones

std::vector<View> views_of(const Scene& scene) {
  std::vector<View> views;
  for (const auto& cameras :
       {camera::make_path(scene, "near", kViews).cameras, camera::random_cameras(scene, kViews, 1)}) {
    for (const Camera& camera : cameras) {
      if (const Result<View> view = make_view(camera, 96, 64)) views.push_back(*view);
    }
  }
  return views;
}

// A tenth of the objects a little, as often as it is called.
std::vector<ObjectId> move_some(Scene& scene, scene::Random& random) {
  std::vector<ObjectId> moved;
  for (ObjectId object = random.below(10); object < scene.size(); object += 10) {
    Affine transform = scene.transform[object];
    for (Vec4& row : transform.rows) row.w += random.between(-1, 1);
    scene.move_object(object, transform);
    moved.push_back(object);
  }
  return moved;
}

void add_set(Hash& hash, std::vector<ObjectId>& visible) {
  std::ranges::sort(visible);
  hash.add(visible.size());
  for (const ObjectId object : visible) hash.add(object);
}

// The views, some objects moved, and the views again.
template <class Look, class Moved>
void look_twice(const Scene& before, Scene& scene, const Look& look, const Moved& moved) {
  const std::vector<View> views = views_of(before);
  scene::Random random(3);
  for (const View& view : views) look(view);
  moved(move_some(scene, random));
  for (const View& view : views) look(view);
}

bool takes_threads(const MethodForm& form) {
  return std::ranges::any_of(form.parameters, [](const ParameterInfo& p) { return p.name == "threads"; });
}

void answer_on_the_cpu(const std::string& world, Answers& out) {
  const Scene still = generate_world(world);
  for (const MethodInfo& info : all_methods()) {
    if (!info.cpu.suits(still) || (out.threads > 1 && !takes_threads(info.cpu))) continue;
    Scene scene = generate_world(world);
    std::string specification(info.name);
    if (takes_threads(info.cpu)) specification += "?threads=" + std::to_string(out.threads);
    const auto method = create_method(specification, scene);
    Hash hash;
    Frame frame;
    const auto look = [&](const View& view) {
      cull(*method, view, frame);
      add_set(hash, frame.visible);
    };
    look_twice(still, scene, look, [&](const std::vector<ObjectId>& moved) { method->update(moved); });
    out.add(std::string(info.name) + "." + world, hash);
  }
}

void answer_on(device::Device& device, const std::string& world, Answers& out) {
  const Scene still = generate_world(world);
  for (const MethodInfo& info : all_methods()) {
    if (!info.device.suits(still)) continue;
    Scene scene = generate_world(world);
    device::Renderer renderer(device, scene);
    const auto method = create_method(info.name, MethodSite{scene, &renderer});
    Hash hash;
    Frame frame;
    const auto look = [&](const View& view) {
      renderer.frame(view, [&](device::Recorder& recorder) {
        FrameContext context{view, frame, &recorder};
        method->record(context);
      });
      method->read_back(frame);
      add_set(hash, frame.visible);
    };
    look_twice(still, scene, look, [&](const std::vector<ObjectId>& moved) {
      renderer.update(moved);
      method->update(moved);
    });
    out.add(std::string(info.name) + "." + world, hash);
  }
}

int print_on_a_device() {
  if (device::list_devices().empty()) return 0;
  device::Device device;
  std::string driver = device.info().driver;
  std::ranges::replace_if(
      driver, [](unsigned char c) { return !std::isalnum(c) && c != '.'; }, '-');
  std::printf("driver %s\n", driver.c_str());
  Answers answers{1};
  for (const char* world : kScenes) answer_on(device, world, answers);
  for (const std::string& line : answers.lines) std::puts(line.c_str());
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  if (count > 1 && std::strcmp(arguments[1], "--device") == 0) return print_on_a_device();
  const int others = test::print_answers([](Answers& out) {
    for (const char* world : kScenes) answer_on_the_cpu(world, out);
  });
  return others == 0 ? 0 : 1;
}
