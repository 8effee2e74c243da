// Visible sets cell by cell.
#include <pybind11/stl.h>

#include <sightline/pvs.hpp>

#include <algorithm>

#include "bindings/python/arrays.hpp"
#include "bindings/python/objects.hpp"

namespace sightline::python {

namespace {

std::unique_ptr<CellPvs> read(const py::object& bytes) {
  PyObject* copied = PyBytes_FromObject(bytes.ptr());  // of bytes, the same object
  if (!copied) {
    PyErr_Clear();
    refuse("pvs: expected bytes");
  }
  const auto held = py::reinterpret_steal<py::bytes>(copied);
  const std::string_view view = held;
  return std::make_unique<CellPvs>(expect([&] {
    const Unlocked unlocked;
    return read_pvs(std::as_bytes(std::span(view)));
  }()));
}

std::uint32_t check_cell(const CellPvs& pvs, long long cell) {
  if (cell < 0 || static_cast<std::size_t>(cell) >= pvs.size()) refuse("pvs: there is no such cell");
  return static_cast<std::uint32_t>(cell);
}

// Numbers of the sets themselves, which live as long as the array.
template <class T>
py::array numbers(const py::object& owner, std::span<const T> values) {
  py::array_t<T> array(static_cast<py::ssize_t>(values.size()), values.data(), owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

py::array seen_from(const py::object& self, long long cell) {
  const auto& pvs = self.cast<const CellPvs&>();
  return numbers(self, pvs.seen_from(check_cell(pvs, cell)));
}

py::object cell_at(const CellPvs& pvs, const py::object& point) {
  const WorldPoint p = world_point_of(point, "point");
  const std::uint32_t cell =
      pvs.cell_at({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
  return cell == kNoCell ? py::object(py::none()) : py::int_(cell);
}

std::array<std::uint32_t, 3> counts_of(const py::object& given) {
  if (!py::isinstance<py::sequence>(given) || py::len(given) != 3)
    refuse("counts: expected three numbers, the cells along x, y and z");
  std::array<std::uint32_t, 3> counts{};
  std::size_t axis = 0;
  for (const py::handle along : given) counts.at(axis++) = whole_number_of(along, "counts");
  return counts;
}

std::vector<std::uint8_t> flags_of(const py::object& given) {
  constexpr const char* what = "open: expected a sequence of flags, True or False a cell";
  if (!py::isinstance<py::iterable>(given)) refuse(what);
  std::vector<std::uint8_t> flags;
  for (const py::handle flag : given) {
    if (flags.size() > kMostCells) break;  // refused below; some give flags without an end
    py::detail::make_caster<bool> taken;
    if (!taken.load(flag, true)) refuse(what);
    flags.push_back(py::detail::cast_op<bool>(taken));
  }
  return flags;
}

py::bytes write(const py::object& bounds, const py::object& counts, const py::object& objects,
                const py::object& open, const py::object& sets, const py::object& scene) {
  CellPvs cells;
  cells.bounds = box_of(bounds, "bounds");
  cells.counts = counts_of(counts), cells.open = flags_of(open);
  cells.objects = whole_number_of(objects, "objects");
  cells.scene = whole_number_of<std::uint64_t>(scene, "scene");
  cells.first.push_back(0);
  if (!py::isinstance<py::sequence>(sets))
    refuse("sets: expected a sequence of arrays, uint32 (k,), one a cell");
  for (const py::handle set : sets) {
    if (cells.first.size() > kMostCells + 1) break;
    const auto members = numbers_of(py::reinterpret_borrow<py::object>(set), "sets");
    cells.visible.insert(cells.visible.end(), members.begin(), members.end());
    cells.first.push_back(cells.visible.size());
  }
  const std::vector<std::byte> bytes = expect([&] {
    const Unlocked unlocked;
    return write_pvs(cells);
  }());
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

void add_pvs(py::module_& m) {
  py::class_<CellPvs>(m, "CellPvs",
                      "A set of visible objects a cell of a grid; cells run x first, then y, then z.")
      .def_property_readonly(
          "bounds", [](const CellPvs& pvs) { return array_of(pvs.bounds); },
          "float32 (2, 3): minimum and maximum in metres.")
      .def_property_readonly(
          "counts", [](const CellPvs& pvs) { return py::tuple(py::cast(pvs.counts)); },
          "Cells along x, y and z.")
      .def_readonly("objects", &CellPvs::objects, "Of the scene that it was baked for.")
      .def_readonly("scene", &CellPvs::scene, "The fingerprint of that scene.")
      .def("__len__", &CellPvs::size)
      .def(
          "is_open", [](const CellPvs& pvs, long long cell) { return pvs.open[check_cell(pvs, cell)] != 0; },
          "False where nobody can be, and nothing is known.", py::arg("cell"))
      .def("cell_at", &cell_at, "The open cell that holds the point in metres, or None.", py::arg("point"))
      .def(
          "cell_bounds",
          [](const CellPvs& pvs, long long cell) { return array_of(pvs.cell_bounds(check_cell(pvs, cell))); },
          "float32 (2, 3): minimum and maximum in metres.", py::arg("cell"))
      .def("seen_from", &seen_from,
           "uint32 (k,), ascending, read-only: the objects that may be seen from the cell.", py::arg("cell"));
  m.def("read_pvs", &read,
        "A CellPvs of the bytes of a file. Refused: what is damaged, of another version, or no such file.",
        py::arg("bytes"));
  m.def("write_pvs", &write,
        "The bytes of a file of a grid of counts (x, y, z) cells: open, a flag a cell; sets, an array of\n"
        "ascending object numbers, uint32 (k,), a cell. Refused: what is not so.",
        py::arg("bounds"), py::arg("counts"), py::arg("objects"), py::arg("open"), py::arg("sets"),
        py::arg("scene") = 0);
}

}  // namespace sightline::python
