#include "world/lives/life.hpp"

#include <array>
#include <cmath>

#include "support/random_views.hpp"
#include "support/run_threads.hpp"
#include "support/snapshots.hpp"
#include "support/solid_boxes.hpp"
#include "world/lives/operations.hpp"

namespace sightline::lives {
namespace {

constexpr std::array kAxes{&WorldPoint::x, &WorldPoint::y, &WorldPoint::z};

Plan any_plan(Random& random) {
  Plan out;
  out.objects = any_of<std::uint32_t>(random, {3, 16, 17, 96, 97, 150, 300, 700, 1024, 1026, 1500, 3000});
  out.steps = 60 + random.below(120);
  out.radius = any_of(random, {20.0, 200.0, 800.0, 1500.0, 3000.0, 8000.0});
  if (one_in(random, 3)) {  // so many in a sector that those who move stand apart from the others
    out.objects = 1100 + random.below(4000);
    out.radius = any_of(random, {20.0, 200.0, 800.0});
  }
  out.away = any_of(random, {0.0, 0.0, 0.0, 1e5, 1e7, 1e10});
  out.size = any_of(random, {0.3, 3.0, 3.0, 30.0});
  out.huge = one_in(random, 6);
  out.columns = !one_in(random, 4);
  out.occluders = one_in(random, 2);
  out.streams = one_in(random, 3);
  return out;
}

WorldPoint whole(const WorldPoint& p) {
  return {std::floor(p.x), std::floor(p.y), std::floor(p.z)};
}

// Single precision of a box about an origin, in either form; the box becomes what that says.
std::array<float, 6> narrow_corners(WorldBox& box, const WorldPoint& origin) {
  std::array<float, 6> out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double &low = box.min.*kAxes[axis], &high = box.max.*kAxes[axis];
    const double from = origin.*kAxes[axis];
    out[axis] = static_cast<float>(low - from), out[3 + axis] = static_cast<float>(high - from);
    low = from + double{out[axis]}, high = from + double{out[3 + axis]};
  }
  return out;
}
std::array<float, 6> narrow_halves(WorldBox& box, const WorldPoint& origin) {
  std::array<float, 6> out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double &low = box.min.*kAxes[axis], &high = box.max.*kAxes[axis];
    const double from = origin.*kAxes[axis];
    out[axis] = static_cast<float>(0.5 * (low + high) - from);
    out[3 + axis] = static_cast<float>(0.5 * (high - low));
    low = from + (double{out[axis]} - double{out[3 + axis]});
    high = from + (double{out[axis]} + double{out[3 + axis]});
  }
  return out;
}

// Of jobs whose order does not matter.
void run_backwards(void*, std::uint32_t count, void (*job)(void*, std::uint32_t), void* data) {
  for (std::uint32_t i = count; i-- > 0;) job(data, i);
}

}  // namespace

Life::Life(Random& from) : random(from), plan(any_plan(from)) {
  for (std::uint32_t i = 1 + random.below(3); i > 0; --i) {
    const double away = places.empty() ? plan.away : any_of(random, {0.0, plan.away, 1e4, 3200.0});
    const double x = within(random, away), y = within(random, 0.1 * away), z = within(random, away);
    places.push_back(whole({x, y, z}));
    if (one_in(random, 3)) places.back() = {1600, 0, 1600};  // where four sectors meet
  }
  add_lane(std::make_unique<Lane>(Lane::first));
  add_lane(std::make_unique<Lane>(Lane::twin));
}

void Life::add_lane(std::unique_ptr<Lane> lane) {
  const Result<OccluderId> occluder = lane->world.add_occluder(test::kUnitBox);
  ASSERT_TRUE(occluder) << occluder.error().message();
  lane->occluder = *occluder;
  lanes.push_back(std::move(lane));
}

void Life::live() {
  for (std::uint32_t step = 0; step < plan.steps; ++step) {
    const Operation& operation = any_operation(random);
    SCOPED_TRACE("step " + std::to_string(step) + ": " + operation.name);
    operation.run(*this);
    if (testing::Test::HasFailure()) return;
  }
  SCOPED_TRACE("the end");
  check_all(*this);
}

WorldPoint Life::any_point() {
  const WorldPoint& place = places[below(random, places.size())];
  const double x = within(random, plan.radius), y = within(random, 0.2 * plan.radius);
  return {place.x + x, place.y + y, place.z + within(random, plan.radius)};
}

WorldBox Life::any_box(const WorldPoint* near) {
  WorldPoint at = any_point();
  if (near != nullptr) {
    const double step = any_of(random, {0.01, 0.5, 3.0, 50.0});
    at = *near;
    at.x += within(random, step), at.y += within(random, step), at.z += within(random, step);
  }
  if (one_in(random, 40)) at.x = std::floor(at.x / 3200) * 3200 + 1600;  // where sectors meet
  double size = plan.size * std::exp(double{random.between(-4, 0.5f)});
  if (plan.huge && one_in(random, 30)) size = std::pow(10.0, double{random.between(1.5f, 5)});
  double half[3];
  for (double& h : half) h = one_in(random, 20) ? 0 : size * double{random.unit()};
  if (one_in(random, 20)) half[0] = half[1] = half[2] = 0;
  return {{at.x - half[0], at.y - half[1], at.z - half[2]}, {at.x + half[0], at.y + half[1], at.z + half[2]}};
}

LaidOut Life::lay_out(std::vector<WorldBox> boxes) {
  LaidOut out{{}, std::move(boxes), {}};
  const std::size_t count = out.given.size();
  const std::uint32_t form = random.below(3);
  if (form == 0 || count == 0) {
    out.view = BoxView(out.given);
    return out;
  }
  const WorldPoint origin =
      any_of(random, {places[below(random, places.size())], WorldPoint{3200, 0, -3200}});
  for (WorldBox& box : out.given) {
    const std::array<float, 6> floats = form == 1 ? narrow_corners(box, origin) : narrow_halves(box, origin);
    out.floats.insert(out.floats.end(), floats.begin(), floats.end());
  }
  const float* first = out.floats.data();
  out.view = form == 1 ? BoxView::min_max(first, 6 * sizeof(float), count, origin)
                       : BoxView::centre_half(first, first + 3, 6 * sizeof(float), count, origin);
  return out;
}

std::uint32_t Life::any_layers() {
  return one_in(random, 3) ? kAllLayers : one_in(random, 8) ? 0 : random.below(16);
}

DistanceRange Life::any_range() {
  DistanceRange out;
  const auto radius = static_cast<float>(plan.radius);
  if (one_in(random, 2)) out.max = radius * std::exp(random.between(-4, 1));
  if (one_in(random, 2)) out.min = std::min(out.max, random.between(0, 0.3f * radius));
  return out;
}

WorldView Life::any_view() {
  const auto radius = static_cast<float>(plan.radius);
  const std::uint32_t width = 1 + random.below(1920), height = 1 + random.below(1080);
  Camera camera = test::random_camera(random, {{-radius, -radius, -radius}, {radius, radius, radius}});
  WorldPoint at = any_point();
  if (one_in(random, 2) && !model.standing.empty()) {
    at = model.objects[model.standing[below(random, model.standing.size())]].given.min;
    at.x += within(random, 20), at.y += within(random, 5), at.z += within(random, 20);
  }
  WorldPoint origin{};
  if (plan.away > 1e4 || one_in(random, 3)) origin = whole(at);
  if (one_in(random, 8)) origin = places[below(random, places.size())];
  camera.eye = {static_cast<float>(at.x - origin.x), static_cast<float>(at.y - origin.y),
                static_cast<float>(at.z - origin.z)};
  const Result<View> view = make_view(camera, width, height);
  return view ? WorldView{*view, origin} : any_view();
}

std::vector<CullView> Life::any_views(bool plain) {
  std::vector<CullView> out;
  const std::uint32_t count = one_in(random, 3) ? 1 : one_in(random, 10) ? 8 : 1 + random.below(4);
  for (std::uint32_t v = 0; v < count; ++v) {
    CullView view{.view = any_view()};
    if (v > 0 && one_in(random, 4)) view = out[random.below(v)];
    if (!plain) {
      if (one_in(random, 3)) view.layers = random.below(16);
      if (one_in(random, 4)) view.distance_scale = std::exp(random.between(-2, 2));
      if (one_in(random, 4)) view.distance_view = random.below(count);
      if (one_in(random, 8)) view.min_area = random.between(0, 60);
    }
    out.push_back(view);
  }
  return out;
}

JobSystem Life::any_jobs() {
  const auto count = any_of<std::uint32_t>(random, {1, 2, 3, 8, 64});
  return {one_in(random, 12) ? test::run_threads : run_backwards, nullptr, count};
}

}  // namespace sightline::lives
