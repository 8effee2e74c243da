#include <vector>

#include "workbench/methods/draw_calls/draw_calls.hpp"
#include "workbench/methods/methods.hpp"

namespace sightline {

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

std::span<const MethodInfo> cpu_methods() noexcept {
  using namespace methods;
  static const std::vector<MethodInfo> kMethods = [] {
    std::vector<MethodInfo> all{kNone, kVfcVc, kGridCell, kObjectFrustum, kMasked};
    all.insert(all.end(), kDrawCallMethods.begin(), kDrawCallMethods.end());
    all.insert(all.end(),
               {kClusterCone, kAdaptive, kToca, kBoca, kWideRays, kTrianglePvs, kGuided, kLevelPvs, kBaked});
    return all;
  }();
  return kMethods;
}

const MethodInfo* find_method(std::string_view name) noexcept {
  for (const MethodInfo& info : cpu_methods()) {
    if (info.name == name) return &info;
  }
  return nullptr;
}

Result<std::unique_ptr<Method>> create_method(std::string_view specification, const Scene& scene) {
  const std::string_view name = specified_name(specification);
  const MethodInfo* info = find_method(name);
  if (!info) {
    std::string known;
    for (const MethodInfo& method : cpu_methods())
      known.append(known.empty() ? "" : ", ").append(method.name);
    return Failure{"method '" + std::string(name) + "': no such method, expected one of " + known};
  }
  Result<Parameters> parameters = parse_parameters("method", specification, info->parameters);
  if (!parameters) return parameters.failure();
  if (Check bad = check(scene)) return *bad;
  if (!info->fits(scene)) {
    return Failure{"method '" + std::string(name) + "': scene '" + scene.name + "' lacks " +
                   std::string(info->needs)};
  }
  return info->create(scene, *parameters);
}

}  // namespace sightline
