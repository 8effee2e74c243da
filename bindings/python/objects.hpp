// The library's objects as Python holds them, and the parts that the module is made of.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <string>

#include <sightline/occlusion.hpp>
#include <sightline/shadows.hpp>
#include <sightline/view.hpp>
#include <sightline/world.hpp>

namespace sightline::python {

/// An object and who uses it: threads that do without the interpreter's lock must not meet at one that
/// changes.
template <class T>
struct Guarded {
  T value;
  mutable std::shared_mutex mutex;
};

using Occlusion = Guarded<OcclusionBuffer>;
using Casters = Guarded<ShadowCasters>;

/// Without the interpreter's lock while it lives: other threads of Python run on. No object's lock may be
/// held when it ends, and nothing of Python may be used while one is.
using Unlocked = pybind11::gil_scoped_release;

/// What call(object) returns, alone with the object or beside others that look.
template <class T, class Call>
auto changing(Guarded<T>& object, const Call& call) {
  const std::unique_lock lock(object.mutex);
  return call(object.value);
}
template <class T, class Call>
auto looking(const Guarded<T>& object, const Call& call) {
  const std::shared_lock lock(object.mutex);
  return call(object.value);
}

/// The same without the interpreter's lock.
template <class T, class Call>
auto changing_unlocked(Guarded<T>& object, const Call& call) {
  const Unlocked unlocked;
  return changing(object, call);
}
template <class T, class Call>
auto looking_unlocked(const Guarded<T>& object, const Call& call) {
  const Unlocked unlocked;
  return looking(object, call);
}

/// Refuses a coverage other than 'centres' and 'area', and a scale that is no whole number.
OcclusionOptions occlusion_options(const std::string& coverage, const pybind11::object& scale);

// Each adds its classes and functions.
void add_views(pybind11::module_& m);
void add_world(pybind11::module_& m);
void add_culling(pybind11::module_& m);  ///< views of a world, and cullers: after all that they name
void add_world_occluders(pybind11::class_<Guarded<World>>& world);
void add_snapshots(pybind11::module_& m, pybind11::class_<Guarded<World>>& world);
void add_occlusion(pybind11::module_& m);
void add_shadows(pybind11::module_& m);
void add_instances(pybind11::module_& m);
void add_ranges(pybind11::module_& m);
void add_inspect(pybind11::module_& m);
void add_frustum(pybind11::module_& m);
void add_rays(pybind11::module_& m);
void add_pvs(pybind11::module_& m);

/// Of all that was added: a call that no signature fits raises a TypeError of one sentence. Last.
void refuse_wrong_calls_in_a_sentence(const pybind11::module_& m);

}  // namespace sightline::python

/// Objects that others hold, too. Python may have reserved one and never constructed it: refused here as it
/// is wherever one is borrowed, before pybind11 looks for what holds it.
template <class T>
class pybind11::detail::type_caster<std::shared_ptr<sightline::python::Guarded<T>>>
    : public copyable_holder_caster<sightline::python::Guarded<T>,
                                    std::shared_ptr<sightline::python::Guarded<T>>> {
public:
  bool load(handle from, bool convert) {
    if (!type_caster_base<sightline::python::Guarded<T>>().load(from, convert)) return false;
    return copyable_holder_caster<sightline::python::Guarded<T>,
                                  std::shared_ptr<sightline::python::Guarded<T>>>::load(from, convert);
  }
};
