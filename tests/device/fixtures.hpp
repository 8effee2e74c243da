// One device with validation for all tests of an executable, which must stay silent.
#pragma once

#include <gtest/gtest.h>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/worlds.hpp>

#include "workbench/device/renderer.hpp"
#include "workbench/oracle/raster_item_buffer.hpp"

namespace sightline {

class DeviceTest : public testing::Test {
protected:
  static void SetUpTestSuite() {
    device::DeviceOptions options;
    options.validation = true;
    device_ = std::make_unique<device::Device>(options);
  }
  static void TearDownTestSuite() { device_.reset(); }
  void TearDown() override { EXPECT_EQ(device_->messages(), 0u) << device_->first_message(); }

  static device::Device& device() { return *device_; }

private:
  static inline std::unique_ptr<device::Device> device_;
};

inline View view_of(const Camera& camera, std::uint32_t width = 320, std::uint32_t height = 180) {
  return or_throw(make_view(camera, width, height));
}

inline Camera camera_at(const Scene& scene, std::string_view name) {
  for (const Viewpoint& viewpoint : scene.viewpoints) {
    if (viewpoint.name != name) continue;
    Camera camera;
    camera.eye = viewpoint.eye;
    camera.forward = viewpoint.forward;
    return camera;
  }
  throw Error("no such viewpoint");
}

}  // namespace sightline
