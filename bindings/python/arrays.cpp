#include "bindings/python/arrays.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace sightline::python {

namespace {

template <class T>
bool is_of(const py::array& array) {
  return py::isinstance<py::array_t<T>>(array);
}

py::array array_given(const py::object& given, const std::string& what) {
  if (!py::isinstance<py::array>(given)) refuse(what + ", got no NumPy array");
  return py::reinterpret_borrow<py::array>(given);
}

std::string shape_of(const py::array& array) {
  return py::str(array.attr("shape")).cast<std::string>() + " " +
         py::str(array.attr("dtype")).cast<std::string>();
}

[[noreturn]] void refuse_shape(const std::string& what, const py::array& array) {
  refuse(what + ", got " + shape_of(array));
}

// Bytes from a row to the next. A lone row has any stride in NumPy.
std::size_t stride_of(const py::array& array, const std::string& what, std::size_t natural) {
  if (array.shape(0) <= 1) return natural;
  if (array.strides(0) < 0) refuse(what + " in ascending order in memory, got a negative stride");
  return static_cast<std::size_t>(array.strides(0));
}

std::size_t rows_of(const py::array& array) {
  return static_cast<std::size_t>(array.shape(0));
}

// Elements of type T in rows of three or so that lie side by side.
template <class T>
struct Rows {
  const T* first;
  std::size_t stride, count;
};

template <class T>
Rows<T> rows_of(const py::array& array, const std::string& what, py::ssize_t columns) {
  const bool flat = columns == 1 && array.ndim() == 1;
  const bool fits = flat || (array.ndim() == 2 && array.shape(1) == columns);
  if (!fits || !is_of<T>(array)) refuse_shape(what, array);
  const bool together = flat || columns == 1 || array.strides(1) == static_cast<py::ssize_t>(sizeof(T));
  if (!together && array.size() != 0) refuse_shape(what, array);
  return {static_cast<const T*>(array.data()),
          stride_of(array, what, sizeof(T) * static_cast<std::size_t>(columns)), rows_of(array)};
}

constexpr const char* kBoxes =
    "boxes: expected float32 or float64 of shape (n, 2, 3) or (n, 6) with a row's numbers together, or a "
    "BoxView";
constexpr const char* kSpheres =
    "spheres: expected float32 of shape (n, 4) with a row's numbers together, or a SphereView";
constexpr const char* kHandles =
    "handles: expected uint32 of shape (n, 2), or of shape (n,) and two uint32 fields";

// Whether the dtype has two uint32, one after the other, whatever their names.
bool is_pair(const py::dtype& type) {
  if (type.kind() != 'V' || type.itemsize() != static_cast<py::ssize_t>(sizeof(Handle))) return false;
  const py::object names = type.attr("names");
  if (names.is_none() || py::len(names) != 2) return false;
  py::ssize_t at = 0;
  for (const py::handle name : names) {
    const auto field = type.attr("fields")[name].cast<py::tuple>();
    if (!field[0].cast<py::object>().equal(py::dtype::of<std::uint32_t>()) ||
        field[1].cast<py::ssize_t>() != at)
      return false;
    at += sizeof(std::uint32_t);
  }
  return true;
}

py::array handle_array(const py::object& given) {
  py::array array = array_given(given, kHandles);
  const bool numbers = array.ndim() == 2 && array.shape(1) == 2 && is_of<std::uint32_t>(array) &&
                       (array.strides(1) == sizeof(std::uint32_t) || array.size() == 0);
  if (!numbers && !(array.ndim() == 1 && is_pair(array.dtype()))) refuse_shape(kHandles, array);
  return array;
}

// Numbers of any type NumPy makes doubles of.
std::vector<double> doubles_of(const py::object& given, std::initializer_list<py::ssize_t> shape,
                               const std::string& what) {
  using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
  const auto array = made_of<Doubles>(given, what + ", got what is no array of numbers");
  if (!std::equal(shape.begin(), shape.end(), array.shape(), array.shape() + array.ndim()))
    refuse_shape(what, array);
  return {array.data(), array.data() + array.size()};
}

float single(double number) {
  return static_cast<float>(number);
}

// A contiguous array of the type, itself or a copy.
template <class T>
py::array_t<T, py::array::c_style> contiguous(const py::object& given, const std::string& what) {
  const py::array array = array_given(given, what);
  if (!is_of<T>(array)) refuse_shape(what, array);
  return made_of<py::array_t<T, py::array::c_style>>(array, what);
}

}  // namespace

py::list listed(const py::object& given, const std::string& refusal) {
  if (PyObject* const list = PySequence_List(given.ptr())) return py::reinterpret_steal<py::list>(list);
  const py::error_already_set error;
  if (error.matches(PyExc_TypeError) || error.matches(PyExc_NotImplementedError)) refuse(refusal);
  throw error;
}

Boxes boxes_of(const py::object& given) {
  if (py::isinstance<Boxes>(given)) return given.cast<Boxes>();
  const py::array array = array_given(given, kBoxes);
  const auto size = array.itemsize();
  const bool whole = array.ndim() == 3 && array.shape(1) == 2 && array.shape(2) == 3 &&
                     (array.strides(2) == size || array.size() == 0);
  const bool flat =
      array.ndim() == 2 && array.shape(1) == 6 && (array.strides(1) == size || array.size() == 0);
  const bool single = is_of<float>(array);
  if (!(whole || flat) || !(single || is_of<double>(array))) refuse_shape(kBoxes, array);
  const auto* first = static_cast<const std::byte*>(array.data());
  const auto* second = first + (whole ? array.strides(1) : 3 * size);
  const std::size_t stride = stride_of(array, kBoxes, 6 * static_cast<std::size_t>(size));
  const auto view = [&]<class Number>(Number) {
    return BoxView::min_max(reinterpret_cast<const Number*>(first), reinterpret_cast<const Number*>(second),
                            stride, rows_of(array));
  };
  return {single ? view(float{}) : view(double{}), {array}};
}

Spheres spheres_of(const py::object& given) {
  if (py::isinstance<Spheres>(given)) return given.cast<Spheres>();
  const py::array array = array_given(given, kSpheres);
  const Rows<float> rows = rows_of<float>(array, kSpheres, 4);
  return {SphereView(rows.first, rows.first + 3, rows.stride, rows.count), {array}};
}

Strided<const Handle> handles_of(const py::object& given) {
  const py::array array = handle_array(given);
  return {array.data(), rows_of(array), stride_of(array, kHandles, sizeof(Handle))};
}

Strided<Handle> writable_handles_of(const py::object& given) {
  py::array array = handle_array(given);
  if (!array.writeable()) refuse("handles: the array is read-only, expected one to write to");
  return {array.mutable_data(), rows_of(array), stride_of(array, kHandles, sizeof(Handle))};
}

Strided<const std::uint32_t> column_of(const py::object& given, const char* name) {
  if (given.is_none()) return {};
  const std::string what = std::string(name) + ": expected uint32 of shape (n,)";
  const py::array array = array_given(given, what);
  if (array.ndim() != 1) refuse_shape(what, array);
  const auto rows = rows_of<std::uint32_t>(array, what, 1);
  return {rows.first, rows.count, rows.stride};
}

Strided<const DistanceRange> distances_of(const py::object& given) {
  if (given.is_none()) return {};
  constexpr const char* what = "distances: expected float32 of shape (n, 2) with a row's numbers together";
  const auto rows = rows_of<float>(array_given(given, what), what, 2);
  static_assert(sizeof(DistanceRange) == 2 * sizeof(float));
  return {rows.first, rows.count, rows.stride};
}

std::vector<Vec3> points_of(const py::object& given, const char* name) {
  const std::string what = std::string(name) + ": expected float32 of shape (..., 3)";
  const auto array = contiguous<float>(given, what);
  if (array.ndim() < 2 || array.shape(array.ndim() - 1) != 3) refuse_shape(what, array);
  static_assert(sizeof(Vec3) == 3 * sizeof(float));
  const auto* first = reinterpret_cast<const Vec3*>(array.data());
  return {first, first + array.size() / 3};
}

std::vector<std::uint32_t> numbers_of(const py::object& given, const char* name) {
  const auto array = contiguous<std::uint32_t>(given, std::string(name) + ": expected uint32");
  return {array.data(), array.data() + array.size()};
}

std::vector<bool> truths_of(const py::object& given, const std::string& what) {
  const auto array = contiguous<bool>(given, what);
  return std::vector<bool>(array.data(), array.data() + array.size());
}

std::uint64_t whole_number_of(const py::handle& given, const char* name, std::uint64_t most) {
  const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(given.ptr()));
  const std::uint64_t value = number ? PyLong_AsUnsignedLongLong(number.ptr()) : 0;
  const bool none = PyErr_Occurred() != nullptr;
  PyErr_Clear();
  if (none || value > most)
    refuse(std::string(name) + ": expected a whole number from 0 to " + std::to_string(most));
  return value;
}

WorldPoint world_point_of(const py::object& given, const char* name) {
  const auto p = doubles_of(given, {3}, std::string(name) + ": expected three numbers");
  return {p[0], p[1], p[2]};
}

std::pair<float, float> two_numbers_of(const py::object& given, const char* name) {
  const auto p = doubles_of(given, {2}, std::string(name) + ": expected two numbers");
  return {single(p[0]), single(p[1])};
}

Box box_of(const py::object& given, const char* name) {
  const auto b =
      doubles_of(given, {2, 3}, std::string(name) + ": expected shape (2, 3), minimum and maximum");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(single(b[axis])) || !std::isfinite(single(b[axis + 3])) || b[axis] > b[axis + 3])
      refuse(std::string(name) + ": expected finite numbers, the minimum before the maximum");
  }
  return {{single(b[0]), single(b[1]), single(b[2])}, {single(b[3]), single(b[4]), single(b[5])}};
}

Mat4 matrix_of(const py::object& given, const char* name) {
  const auto m = doubles_of(given, {4, 4}, std::string(name) + ": expected shape (4, 4)");
  Mat4 matrix;
  for (std::size_t i = 0; i < 16; ++i) matrix.m[i] = single(m[4 * (i % 4) + i / 4]);
  return matrix;
}

std::vector<Mat4> matrices_of(const py::object& given, const char* name) {
  const std::string what = std::string(name) + ": expected (4, 4) or (n, 4, 4) numbers";
  const auto array = made_of<py::array_t<float, py::array::c_style | py::array::forcecast>>(given, what);
  if (array.ndim() == 2) return {matrix_of(given, name)};
  if (array.ndim() != 3 || array.shape(1) != 4 || array.shape(2) != 4) refuse_shape(what, array);
  std::vector<Mat4> out(static_cast<std::size_t>(array.shape(0)));
  const float* at = array.data();
  for (Mat4& matrix : out) {
    for (std::size_t i = 0; i < 16; ++i) matrix.m[4 * (i % 4) + i / 4] = *at++;
  }
  return out;
}

std::optional<Sides> named_sides_of(const py::object& given) {
  if (!py::isinstance<py::str>(given)) return std::nullopt;
  if (given.equal(py::str("both"))) return Sides::both;
  if (given.equal(py::str("front"))) return Sides::front;
  return std::nullopt;
}

std::vector<Sides> sides_of(const py::object& given) {
  constexpr const char* what = "sides: expected 'both', 'front' or bool (m,)";
  if (const std::optional<Sides> named = named_sides_of(given)) return {*named};
  if (py::isinstance<py::str>(given)) refuse(what);
  std::vector<Sides> out;
  for (const bool front : truths_of(given, what)) out.push_back(front ? Sides::front : Sides::both);
  return out;
}

py::array_t<float> array_of(const Mat4& matrix) {
  py::array_t<float> array({4, 4});
  for (std::size_t i = 0; i < 16; ++i) {
    array.mutable_at(static_cast<py::ssize_t>(i % 4), static_cast<py::ssize_t>(i / 4)) = matrix.m[i];
  }
  return array;
}

py::array_t<float> array_of(const Box& box) {
  const float numbers[] = {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z};
  return py::array_t<float>({2, 3}, numbers);
}

}  // namespace sightline::python
