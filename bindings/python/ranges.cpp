// Ranges of an order, and their culling.
#include <sightline/ranges.hpp>

#include <cstring>

#include "bindings/python/arrays.hpp"
#include "bindings/python/cull_views.hpp"
#include "bindings/python/objects.hpp"

namespace sightline::python {

namespace {

using Order = Guarded<ObjectOrder>;
using LockedRangeCuller = Guarded<RangeCuller>;

// Structs of two numbers as rows of an array.
template <class Pair>
py::array_t<std::uint32_t> rows_of(const std::vector<Pair>& pairs) {
  static_assert(sizeof(Pair) == 2 * sizeof(std::uint32_t));
  py::array_t<std::uint32_t> out({static_cast<py::ssize_t>(pairs.size()), py::ssize_t{2}});
  if (!pairs.empty()) std::memcpy(out.mutable_data(), pairs.data(), pairs.size() * sizeof(Pair));
  return out;
}

py::object follow_world(Order& order, SharedWorld& world, bool renumber) {
  std::vector<SlotChange> changes;
  expect(changing_unlocked(order, [&](ObjectOrder& o) {
    return changing(world, [&](World& w) {
      const auto report = renumber ? o.renumber(w) : o.update(w);
      if (!report) return report.error();
      changes.assign(report->begin(), report->end());
      return Status();
    });
  }));
  return rows_of(changes);
}

// What `read` says of the order and the world.
template <class Read>
auto looking_at_both(const Order& order, const SharedWorld& world, const Read& read) {
  return looking(order, [&](const ObjectOrder& o) {
    return looking(world, [&](const World& w) { return read(o, w); });
  });
}

py::object slots_of(const Order& order, const SharedWorld& world, const py::object& handles) {
  const Strided<const Handle> which = handles_of(handles);
  py::array_t<std::uint32_t> out = new_array<std::uint32_t>(which.size());
  const std::span<std::uint32_t> slots = span_of(out);
  looking_at_both(order, world, [&](const ObjectOrder& o, const World& w) {
    for (std::size_t i = 0; i < slots.size(); ++i) slots[i] = o.slot(w, which[i]);
    return 0;
  });
  return out;
}

py::object objects_of(const Order& order) {
  return looking(order, [](const ObjectOrder& o) { return array_of(o.objects()); });
}

py::object cull_ranges(LockedRangeCuller& culler, const SharedWorld& world, const Order& order,
                       const py::object& views, bool masks, bool whole_chunks) {
  const std::vector<ViewOfWorld> given = views_of(views);
  const std::vector<CullView> seeing = cull_views_of(given);
  std::vector<SlotRange> ranges;
  std::vector<std::uint8_t> of_views;
  expect(changing_unlocked(culler, [&](RangeCuller& c) {
    return looking(order, [&](const ObjectOrder& o) {
      const std::vector<Reading> locks = lock_all(given, {&world.mutex});
      const auto result = c.cull(world.value, o, seeing, {.masks = masks, .whole_chunks = whole_chunks});
      if (!result) return result.error();
      ranges.assign(result->ranges.begin(), result->ranges.end());
      of_views.assign(result->masks.begin(), result->masks.end());
      return Status();
    });
  }));
  if (!masks) return rows_of(ranges);
  return py::make_tuple(rows_of(ranges), array_of(of_views));
}

}  // namespace

void add_ranges(py::module_& m) {
  py::class_<Order>(
      m, "ObjectOrder",
      "An order of a World's objects, slot by slot as its chunks hold them, that changes only by report:\n"
      "for an instance buffer of which ranges are drawn.")
      .def(py::init<>())
      .def(
          "update", [](Order& order, SharedWorld& world) { return follow_world(order, world, false); },
          "Follows what has changed in the world and reports the slots that have another object, uint32 (n,\n"
          "2): slot and id, or NO_OBJECT where it is free now. To be called after all changes of a frame,\n"
          "boxes that moved included. The first report has all objects.",
          py::arg("world"))
      .def(
          "renumber", [](Order& order, SharedWorld& world) { return follow_world(order, world, true); },
          "The same, but numbers all objects anew, as a first update does.", py::arg("world"))
      .def("slots", &slots_of,
           "The slots of objects, uint32 (n,); NO_OBJECT for stale handles, or where the world has changed\n"
           "since update().",
           py::arg("world"), py::arg("handles"))
      .def_property_readonly("objects", &objects_of, "The id of each slot, or NO_OBJECT: uint32 (slots,).")
      .def("__len__", [](const Order& order) {
        return looking(order, [](const ObjectOrder& o) { return o.slot_limit(); });
      });

  py::class_<LockedRangeCuller>(m, "RangeCuller", "Culls worlds into ranges of their order.")
      .def(py::init<>())
      .def("cull", &cull_ranges,
           "Of what the views may see, uint32 (m, 2): a first slot and how many follow. masks=True: also\n"
           "which views see each range, uint8. whole_chunks=True: chunks of which a view may see something\n"
           "are in it whole; far fewer ranges. Refused where the world has changed since\n"
           "order.update(world).",
           py::arg("world"), py::arg("order"), py::arg("views"), py::arg("masks") = false,
           py::arg("whole_chunks") = false);
}

}  // namespace sightline::python
