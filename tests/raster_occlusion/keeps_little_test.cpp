// The other end of every promise: an occlusion method keeps little more than what is visible. A method that
// fell back to the frustum alone would keep 2.4 to 30 times what it does here.
#include <gtest/gtest.h>

#include <map>

#include "device/fixtures.hpp"
#include "workbench/camera/camera_path.hpp"
#include "workbench/measure/compare.hpp"

namespace sightline {
namespace {

// How many times what is visible is kept, measured, and the margin that the bounds below add to it.
struct Stated {
  const char* world;
  double raster, hiz, masked;  ///< raster: every method that tests boxes by the pixel
};
constexpr double kMargin = 1.1;
constexpr Stated kScenes[] = {
    {"regular?columns=40&rows=40&detail=1", 2.82, 8.53, 2.89},
    {"irregular?spheres=1000&size=60&detail=1", 1.66, 2.81, 1.85},
    {"city?objects=2000", 1.20, 1.82, 1.31},
    {"forest?trees=600&size=150", 1.36, 1.95, 1.39},
};

class KeepsLittle : public DeviceTest, public testing::WithParamInterface<Stated> {};

TEST_P(KeepsLittle, OfWhatIsNotVisible) {
  const Stated& stated = GetParam();
  const std::map<std::string, double> most{{"roc", stated.raster},
                                           {"hroc", stated.raster},
                                           {"hroc?leaf=boxes", stated.raster},
                                           {"ioc", stated.raster},
                                           {"ihzb", stated.raster},
                                           {"vertex-chunk", stated.raster},
                                           {"resident-chunk", stated.raster},
                                           {"hiz", stated.hiz},
                                           {"masked", stated.masked}};
  Scene scene = generate_world(stated.world);
  std::vector<std::string> methods;
  for (const auto& [name, times] : most) methods.push_back(name);
  measure::Bench bench(scene, methods, &device());
  measure::MeasureOptions options;
  options.width = 160, options.height = 120, options.repeats = 1, options.timed_passes = 0;
  const measure::Comparison seen = measure::compare(bench, camera::make_path(scene, "near", 8), options);
  std::map<std::string, double> kept, visible;
  for (const measure::Row& row : seen.rows) {
    EXPECT_EQ(row.lost_objects, 0u) << row.method;
    kept[row.method] += static_cast<double>(row.kept);
    visible[row.method] += static_cast<double>(row.truly_visible);
  }
  for (const auto& [name, times] : most) {
    EXPECT_LT(kept[name], kMargin * times * visible[name]) << name;
    EXPECT_GT(kept[name], 0.8 * times * visible[name]) << name << " keeps less now: state that";
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, KeepsLittle, testing::ValuesIn(kScenes), [](const auto& info) {
  return std::string(info.param.world).substr(0, std::string(info.param.world).find('?'));
});

}  // namespace
}  // namespace sightline
