// Drivers keep small things for the life of the process and are unloaded before the leak checker looks, which
// then can neither name nor excuse them. Linked into tests that open a Vulkan device: keeps the drivers
// loaded and excuses them by name; what our own code leaks is still found.
#include <dlfcn.h>

#include <array>

#ifdef __has_feature
#if __has_feature(address_sanitizer)

namespace {

const bool kept = [] {
  constexpr std::array kDrivers{"libvulkan_lvp.so", "libVkLayer_MESA_device_select.so",
                                "libVkLayer_khronos_validation.so"};
  for (const char* driver : kDrivers) dlopen(driver, RTLD_NOW | RTLD_NODELETE);
  return true;
}();

}  // namespace

extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libvulkan_lvp\nleak:libVkLayer\nleak:libLLVM\nleak:libvulkan.so\nleak:libxcb\nleak:"
         "libX11\nleak:libdrm\n";
}

#endif
#endif
