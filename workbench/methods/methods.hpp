// What the files of methods build on.
#pragma once

#include <sightline/workbench/method.hpp>

namespace sightline::methods {

/// A method that decides on the CPU: it culls the view into the output, and whoever wants a picture draws
/// that.
class CpuMethod : public Method {
public:
  using Method::Method;
  virtual void cull(const View& view, Frame& frame) noexcept = 0;

private:
  void do_record(FrameContext& context) final { cull(context.view, context.output); }
};

/// The form for the CPU of a method whose constructor takes the scene and its parameters.
template <class M>
std::unique_ptr<Method> make_on_cpu(const MethodSite& site, const Parameters& parameters) {
  return std::make_unique<M>(site.scene, parameters);
}
template <class M>
constexpr MethodForm on_cpu(Guarantee guarantee, std::span<const ParameterInfo> parameters = {}) {
  return {guarantee, parameters, make_on_cpu<M>};
}

/// The form for a device of a method whose constructor takes the renderer and its parameters.
template <class M>
std::unique_ptr<Method> make_on_device(const MethodSite& site, const Parameters& parameters) {
  return std::make_unique<M>(*site.renderer, parameters);
}
template <class M>
constexpr MethodForm on_device(Guarantee guarantee, std::span<const ParameterInfo> parameters = {}) {
  return {guarantee, parameters, make_on_device<M>};
}

}  // namespace sightline::methods
