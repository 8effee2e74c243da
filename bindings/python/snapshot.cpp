// Worlds as bytes, whole or sector by sector.
#include <sightline/snapshot.hpp>

#include <algorithm>
#include <optional>

#include "bindings/python/arrays.hpp"
#include "bindings/python/cull_views.hpp"
#include "bindings/python/objects.hpp"

namespace sightline::python {

namespace {

// A stream and what it lives on.
struct Streamed {
  py::buffer_info bytes;
  py::object world;
  std::optional<WorldStream> stream;
  std::mutex mutex;  // of update(), bring_in() and what they change

  [[nodiscard]] SharedWorld& shared() const { return world.cast<SharedWorld&>(); }
};

std::span<const std::byte> bytes_of(const py::buffer_info& info) {
  if (info.ndim != 1 || (info.size > 1 && info.strides[0] != info.itemsize))
    refuse("snapshot: expected bytes, or a buffer of one contiguous dimension");
  return {static_cast<const std::byte*>(info.ptr), static_cast<std::size_t>(info.size * info.itemsize)};
}

py::bytes save_world(const SharedWorld& world) {
  std::string out;
  const SnapshotSink sink{[](void* user, std::span<const std::byte> bytes) {
                            static_cast<std::string*>(user)->append(
                                reinterpret_cast<const char*>(bytes.data()), bytes.size());
                            return true;
                          },
                          &out};
  expect(looking_unlocked(world, [&](const World& w) { return save(w, sink); }));
  return out;
}

std::unique_ptr<SharedWorld> load_world(const py::buffer& bytes) {
  const py::buffer_info info = bytes.request();
  const auto given = bytes_of(info);
  auto out = std::make_unique<SharedWorld>();
  out->value = expect([&] {
    const Unlocked unlocked;
    return load(given);
  }());
  return out;
}

std::unique_ptr<Streamed> open_stream(const py::buffer& bytes, const py::object& world) {
  if (!py::isinstance<SharedWorld>(world)) refuse("stream: expected a World");
  auto out = std::make_unique<Streamed>();
  out->bytes = bytes.request();
  out->world = world;
  const auto given = bytes_of(out->bytes);
  out->stream.emplace(
      expect(changing_unlocked(out->shared(), [&](World& w) { return WorldStream::open(given, w); })));
  return out;
}

template <class Call>
StreamReport with_stream(Streamed& streamed, const py::object& views, const py::object& budget, double ahead,
                         const Call& call) {
  const std::vector<ViewOfWorld> given = views_of(views);
  const std::vector<CullView> seen = cull_views_of(given);
  StreamOptions options;
  options.budget = whole_number_or_none<std::size_t>(budget, "budget").value_or(options.budget),
  options.ahead = ahead;
  SharedWorld& world = streamed.shared();
  return expect([&] {
    const Unlocked unlocked;
    const std::lock_guard lock(streamed.mutex);
    return changing(world, [&](World&) { return call(*streamed.stream, seen, options); });
  }());
}

StreamReport update(Streamed& streamed, const py::object& views, const py::object& budget, double ahead) {
  return with_stream(streamed, views, budget, ahead,
                     [](WorldStream& stream, const auto& seen, const StreamOptions& options) {
                       return stream.update(seen, options);
                     });
}
StreamReport bring_in(Streamed& streamed, const py::object& views, const py::object& budget, double ahead) {
  return with_stream(streamed, views, budget, ahead,
                     [](WorldStream& stream, const auto& seen, const StreamOptions& options) {
                       return stream.bring_in(seen, options);
                     });
}

bool work(Streamed& streamed) {
  const Unlocked unlocked;
  return streamed.stream->work();
}

const char* name_of(SectorState state) {
  constexpr const char* names[] = {"out", "coming", "in", "changed", "damaged"};
  return names[static_cast<std::size_t>(state)];
}

py::dict sector(Streamed& streamed, const py::object& place) {
  const auto index = whole_number_of<std::size_t>(place, "index");
  const StreamSector s = [&] {
    const Unlocked unlocked;
    const std::lock_guard lock(streamed.mutex);
    return looking(streamed.shared(), [&](const World&) { return streamed.stream->sector(index); });
  }();
  if (index >= streamed.stream->size()) refuse("stream: there is no such sector");
  py::dict out;
  const WorldPoint &low = s.bounds.min, &high = s.bounds.max;
  out["bounds"] = py::make_tuple(py::make_tuple(low.x, low.y, low.z), py::make_tuple(high.x, high.y, high.z));
  out["objects"] = s.objects, out["memory"] = s.memory, out["first_byte"] = s.first_byte;
  out["state"] = name_of(s.state);
  out["error"] = s.error ? py::object(py::none()) : py::str(s.error.message());
  return out;
}

py::array stand_out(Streamed& streamed, const py::object& handles) {
  const Strided<const Handle> which = handles_of(handles);
  auto out = new_array<bool>(which.size());
  const std::span<bool> to = span_of(out);
  looking(streamed.shared(), [&](const World&) {
    for (std::size_t i = 0; i < which.size(); ++i) to[i] = streamed.stream->stands_out(which[i]);
    return 0;
  });
  return out;
}

// came() or went().
template <std::span<const Handle> (WorldStream::*kPassed)() const noexcept>
py::array passed(Streamed& streamed) {
  const std::vector<Handle> handles = [&] {
    const Unlocked unlocked;
    const std::lock_guard lock(streamed.mutex);
    const std::span<const Handle> of = (*streamed.stream.*kPassed)();
    return std::vector<Handle>(of.begin(), of.end());
  }();
  py::array_t<std::uint32_t> out({static_cast<py::ssize_t>(handles.size()), py::ssize_t{2}});
  std::ranges::copy(handles, reinterpret_cast<Handle*>(out.mutable_data()));
  return out;
}

}  // namespace

void add_snapshots(py::module_& m, py::class_<Guarded<World>>& world) {
  world.def("save", &save_world,
            "The world's objects with their handles, columns and tables of levels as bytes, but not what "
            "they carry.");
  m.def("load", &load_world, "A World of all that World.save() wrote: bytes, or any buffer.",
        py::arg("bytes"));

  py::class_<StreamReport>(m, "StreamReport", "What an update found.")
      .def_readonly("sectors_in", &StreamReport::in, "Sectors in the world.")
      .def_readonly("coming", &StreamReport::coming, "Sectors asked for.")
      .def_readonly("missing", &StreamReport::missing, "Sectors that a view touches and that are not in.")
      .def_readonly("damaged", &StreamReport::damaged, "Sectors that were refused so far.")
      .def_readonly("memory", &StreamReport::memory, "Bytes that those in and coming take.");

  py::class_<Streamed>(m, "WorldStream",
                       "Brings a world that lies in bytes, a mapped file for example, in by sectors.")
      .def(py::init(&open_stream),
           "Checks all but the sectors; `world`, a new World, becomes that of the bytes with all sectors "
           "out.",
           py::arg("bytes"), py::arg("world"))
      .def(
          "update", &update,
          "To be called once a frame, before culling: puts in one sector that work() made ready, wants what\n"
          "the views touch and what lies within `ahead` metres, nearest first, as far as `budget` bytes go,\n"
          "and takes others out.",
          py::arg("views"), py::arg("budget") = py::none(), py::arg("ahead") = 3200.0)
      .def("work", &work,
           "Checks one of the wanted sectors and copies it, on any thread; False where none waits.")
      .def(
          "bring_in", &bring_in,
          "update() and work() until all that the views touch is in, as far as the budget goes, and nothing\n"
          "else: `ahead` is not read.",
          py::arg("views"), py::arg("budget") = py::none(), py::arg("ahead") = 0.0)
      .def("came", &passed<&WorldStream::came>,
           "Handles of the objects that came in with the last update or bring_in: to be given what they "
           "carry,\noccluders and triangles.")
      .def("went", &passed<&WorldStream::went>,
           "Handles of those that were in before it and went out; who went and came again is in both.")
      .def("sector", &sector, "bounds, objects, memory, first_byte, state and error of one of them.",
           py::arg("index"))
      .def("stand_out", &stand_out, "bool (n,): whether the object may be one that is out.",
           py::arg("handles"))
      .def("__len__", [](const Streamed& s) { return s.stream->size(); });
}

}  // namespace sightline::python
