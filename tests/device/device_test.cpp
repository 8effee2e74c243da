// What a user is told when there is no device, it lacks something, or its memory runs out.
#include "workbench/device/device.hpp"

#include <cstdlib>

#include <sightline/workbench/method.hpp>
#include "device/fixtures.hpp"

#include "workbench/measure/bench.hpp"

namespace sightline {
namespace {

std::string complaint(const device::DeviceOptions& options) {
  try {
    const device::Device device(options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(DeviceChoice, FindsADeviceByIndexAndByPartOfItsNameInAnyCase) {
  const auto devices = device::list_devices();
  ASSERT_FALSE(devices.empty());
  device::DeviceOptions options;
  options.choice = "0";
  EXPECT_EQ(device::Device(options).info().name, devices[0].name);
  options.choice = devices[0].name.substr(1, 4);
  for (char& c : options.choice) c = static_cast<char>(std::toupper(c));
  EXPECT_EQ(device::Device(options).info().name.empty(), false);
}

TEST(DeviceChoice, SaysWhichDevicesThereAreWhenTheNameFitsNone) {
  device::DeviceOptions options;
  options.choice = "no such card";
  const std::string text = complaint(options);
  EXPECT_NE(text.find("no such card"), std::string::npos) << text;
  EXPECT_NE(text.find(device::list_devices()[0].name), std::string::npos) << text;
}

TEST(DeviceChoice, ANumberIsAnIndexAndNoPartOfAName) {
  device::DeviceOptions options;
  options.choice = "15";  // of "LLVM 15.0.6", say
  EXPECT_NE(complaint(options).find("'15'"), std::string::npos);
}

TEST(DeviceChoice, SaysWhenThereIsNone) {
  setenv("VK_DRIVER_FILES", "/nowhere/no_driver.json", 1);
  setenv("VK_ICD_FILENAMES", "/nowhere/no_driver.json", 1);
  EXPECT_TRUE(device::list_devices().empty());
  const std::string text = complaint({});
  unsetenv("VK_DRIVER_FILES");
  unsetenv("VK_ICD_FILENAMES");
  EXPECT_NE(text.find("there is no device"), std::string::npos) << text;
}

TEST(DeviceFeatures, NamesWhatDrawingLacks) {
  for (const char* feature : {"multiDrawIndirect", "bufferDeviceAddress", "dynamicRendering"}) {
    device::DeviceOptions options;
    options.withheld = {feature};
    const std::string text = complaint(options);
    EXPECT_NE(text.find(feature), std::string::npos) << text;
  }
}

TEST(DeviceFeatures, AMethodNamesTheFeatureItLacks) {
  device::DeviceOptions options;
  options.withheld = {"geometryShader"};
  options.validation = true;
  device::Device device(options);
  const Scene scene = generate_world("regular?columns=2&rows=2&detail=0");
  {
    device::Renderer renderer(device, scene);
    EXPECT_NO_THROW(create_method("roc", MethodSite{scene, &renderer}));
    EXPECT_NO_THROW(create_method("resident-chunk", MethodSite{scene, &renderer}));
    try {
      create_method("vertex-chunk", MethodSite{scene, &renderer});
      FAIL() << "made without geometryShader";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("geometryShader"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("vertex-chunk"), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(device.messages(), 0u) << device.first_message();
}

TEST(DeviceMemory, SaysWhatThereWasNoRoomForAndLeaksNothing) {
  const Scene scene = generate_world("regular?detail=3");
  device::DeviceOptions options;
  options.validation = true;
  // Wherever memory runs out, what was made before is freed again.
  for (const std::uint64_t limit : {1000ull, 20000ull, 300000ull, 2000000ull, 6000000ull}) {
    options.memory_limit = limit;
    device::Device device(options);
    try {
      device::Renderer renderer(device, scene);
      const auto method = create_method("resident-chunk", MethodSite{scene, &renderer});
      const View view = view_of({}, 1280, 720);
      Frame frame;
      renderer.frame(view, [&](device::Recorder& recorder) {
        FrameContext context{view, frame, &recorder};
        method->record(context);
      });
      FAIL() << "fits into " << limit << " bytes";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("no memory for"), std::string::npos) << error.what();
    }
    EXPECT_EQ(device.allocated(), 0u);
    EXPECT_EQ(device.messages(), 0u) << device.first_message();
  }
}

TEST(DeviceMemory, ManyBuffersShareFewBlocksAndNoBytes) {
  device::DeviceOptions options;
  options.validation = true;
  device::Device device(options);
  const std::uint64_t before = device.allocated();
  std::vector<device::Buffer> buffers;
  const auto fill = [&](std::uint32_t value) {
    buffers.emplace_back(device, 4096 * (1 + value % 7), device::Memory::upload, "a test");
    std::memset(buffers.back().mapped<std::byte>(), static_cast<int>(value), buffers.back().size());
  };
  for (std::uint32_t value = 0; value < 200; ++value) fill(value);
  EXPECT_LE(device.memory().blocks(), 2u);
  // Every other one goes, so that what comes after them lies in the gaps.
  std::uint32_t at = 0;
  std::erase_if(buffers, [&](const device::Buffer&) { return at++ % 2 == 1; });
  for (std::uint32_t value = 1; value < 200; value += 2) fill(value);
  EXPECT_LE(device.memory().blocks(), 2u);
  for (const device::Buffer& buffer : buffers) {
    const auto* bytes = buffer.mapped<std::uint8_t>();
    EXPECT_TRUE(std::all_of(bytes, bytes + buffer.size(), [&](std::uint8_t b) { return b == bytes[0]; }));
    EXPECT_EQ(buffer.size(), 4096u * (1 + bytes[0] % 7));
    EXPECT_EQ(buffer.address() % 256, 0u);
  }
  buffers.clear();
  EXPECT_EQ(device.allocated(), before);
  EXPECT_LE(device.memory().blocks(), 1u);
  EXPECT_EQ(device.messages(), 0u) << device.first_message();
}

TEST(DeviceMemory, RefusesMoreThanADeviceCanGive) {
  device::Device device;
  EXPECT_THROW(device::Buffer(device, std::uint64_t{1} << 50, device::Memory::device, "too much"), Error);
  EXPECT_THROW(device::Image(device, device::kColourFormat, 100000, 1, "too wide"), Error);
  EXPECT_THROW(device::Image(device, device::kColourFormat, 0, 1, "nothing"), Error);
}

TEST(DeviceRegistry, RefusesUnknownNamesKeysAndValues) {
  device::Device device;
  const Scene scene = generate_world("regular?columns=2&rows=2&detail=0");
  device::Renderer renderer(device, scene);
  for (const char* wrong :
       {"no-such-method", "roc?no=1", "roc?contribution=maybe", "vertex-chunk?depth=99", "level-pvs"}) {
    EXPECT_THROW(create_method(wrong, MethodSite{scene, &renderer}), Error) << wrong;
  }
  for (const std::string& name : measure::fitting_methods(scene, true)) {
    EXPECT_NO_THROW(create_method(name, MethodSite{scene, &renderer})) << name;
  }
}

}  // namespace
}  // namespace sightline
