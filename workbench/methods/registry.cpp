// All methods in one table. Each line names what a method's file defines: a MethodInfo, or an array of them.
#include <vector>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/method.hpp>

#include "workbench/device/renderer.hpp"
#include "workbench/methods/drawn_on_device.hpp"

#define SIGHTLINE_METHODS(METHOD, FAMILY) \
  METHOD(kNone)                           \
  METHOD(kVfcVc)                          \
  METHOD(kRoc)                            \
  METHOD(kHroc)                           \
  METHOD(kIoc)                            \
  METHOD(kIhzb)                           \
  METHOD(kVertexChunk)                    \
  METHOD(kResidentChunk)                  \
  METHOD(kHiz)                            \
  METHOD(kHizUnsafe)                      \
  METHOD(kGridCell)                       \
  METHOD(kObjectFrustum)                  \
  METHOD(kMasked)                         \
  METHOD(kWorld)                          \
  FAMILY(kDrawCallMethods, 9)             \
  METHOD(kClusterCone)                    \
  METHOD(kAdaptive)                       \
  METHOD(kToca)                           \
  METHOD(kBoca)                           \
  METHOD(kIwcpa)                          \
  METHOD(kBvha)                           \
  METHOD(kSaa)                            \
  METHOD(kTunedIwcpa)                     \
  METHOD(kWideRays)                       \
  METHOD(kTrianglePvs)                    \
  METHOD(kGuided)                         \
  METHOD(kLevelPvs)                       \
  METHOD(kBaked)

namespace sightline {

namespace methods {

#define SIGHTLINE_DECLARE(name) extern const MethodInfo name;
#define SIGHTLINE_DECLARE_FAMILY(name, count) extern const std::array<MethodInfo, count> name;
SIGHTLINE_METHODS(SIGHTLINE_DECLARE, SIGHTLINE_DECLARE_FAMILY)

}  // namespace methods

void Method::update(std::span<const ObjectId> objects) {
  held_.require_sound(objects);
  do_update(objects);
}

void Method::record(FrameContext& context) {
  or_throw(check(context.view));
  held_.require_same();
  do_record(context);
}

std::string_view to_string(Guarantee guarantee) noexcept {
  switch (guarantee) {
    case Guarantee::exact:
      return "exact";
    case Guarantee::conservative:
      return "conservative";
    case Guarantee::approximate:
      return "approximate";
  }
  return "";
}

std::span<const MethodInfo> all_methods() noexcept {
  static const std::vector<MethodInfo> kMethods = [] {
    std::vector<MethodInfo> all;
#define SIGHTLINE_LIST(name) all.push_back(methods::name);
#define SIGHTLINE_LIST_FAMILY(name, count) all.insert(all.end(), methods::name.begin(), methods::name.end());
    SIGHTLINE_METHODS(SIGHTLINE_LIST, SIGHTLINE_LIST_FAMILY)
    return all;
  }();
  return kMethods;
}

const MethodInfo* find_method(std::string_view name) noexcept {
  for (const MethodInfo& info : all_methods()) {
    if (info.name == name) return &info;
  }
  return nullptr;
}

namespace {

[[noreturn]] void refuse_name(std::string_view name, bool on_device) {
  std::string known;
  for (const MethodInfo& method : all_methods()) {
    if (on_device || method.cpu.exists()) known.append(known.empty() ? "" : ", ").append(method.name);
  }
  throw Error("method '" + std::string(name) +
              (find_method(name)
                   ? "': runs on a Vulkan device, and none is in use, expected one of the CPU's: "
                   : "': no such method, expected one of ") +
              known);
}

}  // namespace

std::unique_ptr<Method> create_method(std::string_view specification, const Scene& scene) {
  return create_method(specification, MethodSite{scene});
}

std::unique_ptr<Method> create_method(std::string_view specification, const MethodSite& site) {
  const std::string name(specified_name(specification));
  const MethodInfo* info = find_method(name);
  if (!info || (!site.renderer && !info->cpu.exists())) refuse_name(name, site.renderer);
  const bool on_device = site.renderer && info->device.exists();
  const MethodForm& form = on_device ? info->device : info->cpu;
  const Parameters parameters = parse_parameters("method", specification, form.parameters);
  check(site.scene);
  if (site.renderer) site.renderer->require_same_scene();
  if (!form.suits(site.scene)) {
    throw Error("method '" + name + "': scene '" + site.scene.name + "' lacks " + std::string(form.needs));
  }
  if (on_device && !form.needs.empty()) site.renderer->device().require(form.needs, "method '" + name + "'");
  std::unique_ptr<Method> made = form.create(site, parameters);
  if (!site.renderer || on_device) return made;
  return methods::draw_on_device(std::move(made), *site.renderer);
}

}  // namespace sightline
