// NumPy arrays as the library's views: what fits is read and written where it lies, what does not is refused.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <sightline/box_view.hpp>
#include <sightline/occluder.hpp>
#include <sightline/status.hpp>
#include <sightline/view.hpp>
#include <sightline/world.hpp>

namespace sightline::python {

namespace py = pybind11;

/// Raises sightline.Refused unless the call did what it says.
void expect(const Status& status);
[[noreturn]] void refuse(const std::string& sentence);

template <class T>
T expect(Result<T> result) {
  if (!result) expect(result.error());
  return *std::move(result);
}

/// What NumPy makes of it, or a refusal; an array that there is no memory for raises NumPy's MemoryError.
template <class Array>
Array made_of(const py::object& given, const std::string& refusal) {
  try {
    return Array(given);
  } catch (py::error_already_set& error) {
    if (error.matches(PyExc_MemoryError)) throw;
  }
  refuse(refusal);
}
/// The elements of a sequence; refused where it has none to give. What its own methods raise is theirs.
py::list listed(const py::object& given, const std::string& refusal);

/// Boxes in arrays, which live as long as this.
struct Boxes {
  BoxView view;
  std::vector<py::object> arrays;
};
struct Spheres {
  SphereView view;
  std::vector<py::object> arrays;
};

/// BoxView of Python, or an array of shape (n, 2, 3) or (n, 6).
Boxes boxes_of(const py::object& given);
/// SphereView of Python, or an array of shape (n, 4).
Spheres spheres_of(const py::object& given);

/// Uint32 (n, 2), or of shape (n,) and two uint32 fields.
Strided<const Handle> handles_of(const py::object& given);
/// The same to write to.
Strided<Handle> writable_handles_of(const py::object& given);
/// Uint32 (n,); an empty column for None.
Strided<const std::uint32_t> column_of(const py::object& given, const char* name);
/// Float32 (n, 2), minimum and maximum; an empty column for None.
Strided<const DistanceRange> distances_of(const py::object& given);

/// Contiguous copies of what is not read through strides: points (..., 3) float32, and numbers uint32 of any
/// shape.
std::vector<Vec3> points_of(const py::object& given, const char* name);
std::vector<std::uint32_t> numbers_of(const py::object& given, const char* name);
std::vector<bool> truths_of(const py::object& given, const std::string& what);

/// A whole number from 0 to `most`, of Python or NumPy.
std::uint64_t whole_number_of(const py::handle& given, const char* name, std::uint64_t most);
/// The same, as far as T goes.
template <class T = std::uint32_t>
T whole_number_of(const py::handle& given, const char* name) {
  return static_cast<T>(whole_number_of(given, name, std::numeric_limits<T>::max()));
}
/// The same, or None.
template <class T = std::uint32_t>
std::optional<T> whole_number_or_none(const py::object& given, const char* name) {
  return given.is_none() ? std::nullopt : std::optional(whole_number_of<T>(given, name));
}

WorldPoint world_point_of(const py::object& given, const char* name);
std::pair<float, float> two_numbers_of(const py::object& given, const char* name);
Box box_of(const py::object& given, const char* name);
/// (4, 4) numbers, [row, column].
Mat4 matrix_of(const py::object& given, const char* name);
/// The same, or (n, 4, 4).
std::vector<Mat4> matrices_of(const py::object& given, const char* name);
/// "both" or "front"; none of anything else.
std::optional<Sides> named_sides_of(const py::object& given);
/// "both", "front", or a truth a triangle: whether only its front occludes.
std::vector<Sides> sides_of(const py::object& given);
template <class T>
py::array_t<T> array_of(std::span<const T> from) {
  return py::array_t<T>(static_cast<py::ssize_t>(from.size()), from.data());
}
template <class T>
py::array_t<T> array_of(const std::vector<T>& from) {
  return array_of(std::span<const T>(from));
}
py::array_t<float> array_of(const Mat4& matrix);
py::array_t<float> array_of(const Box& box);

/// The first `count` elements, which is all that was written of it.
inline py::object first_of(const py::array& array, std::size_t count) {
  return array[py::slice(0, static_cast<py::ssize_t>(count), 1)];
}
/// An array that numpy allocates, and the same as a span.
template <class T>
py::array_t<T> new_array(std::size_t count) {
  return py::array_t<T>(static_cast<py::ssize_t>(count));
}
template <class T>
std::span<T> span_of(py::array_t<T>& array) {
  return {array.mutable_data(), static_cast<std::size_t>(array.size())};
}

}  // namespace sightline::python
