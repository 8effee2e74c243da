// The Python module, and how it refuses.
#include <sightline/version.hpp>

#include "bindings/python/arrays.hpp"
#include "bindings/python/objects.hpp"

namespace sightline::python {

namespace {

PyObject* refused = nullptr;  // the exception's type

const char* name_of(StatusCode code) {
  constexpr const char* names[] = {"ok",       "bad_argument",     "bad_box",      "stale_handle",
                                   "bad_view", "buffer_too_small", "stale_buffer", "bad_mesh",
                                   "too_many", "bad_file"};
  const auto number = static_cast<std::size_t>(code);
  return number < std::size(names) ? names[number] : "unknown";
}

[[noreturn]] void raise(const std::string& sentence, StatusCode code, const py::object& index) {
  const py::object error = py::reinterpret_borrow<py::object>(refused)(sentence);
  error.attr("status") = name_of(code);
  error.attr("index") = index;
  PyErr_SetObject(refused, error.ptr());
  throw py::error_already_set();
}

constexpr const char* kDoc =
    "Visibility culling: a world of boxes that move, and what of it a camera may see.\n"
    "\n"
    "Lengths are metres, the world is right-handed with y up, matrices are [row, column] and multiply\n"
    "columns, clip depth is 0 to 1 (either way round). Arrays of the named types are read where they lie,\n"
    "rows at any ascending stride: fields of structured arrays, slices, columns of tables. What is given is\n"
    "read while the call runs, not later. What a call refuses raises Refused, a ValueError, and changes\n"
    "nothing.\n"
    "\n"
    "Objects may be used by several threads: a call waits where another changes the same object. Long calls\n"
    "that only look at arrays let other threads of Python run; do not change those arrays meanwhile.";

// What Python reserved and never constructed, World.__new__(World) for example, is no object to be used:
// where pybind11 would first allocate one, and leave its bytes as they are.
void* refuse_unconstructed(std::size_t) {
  throw py::type_error("this object was never constructed, expected one that its class was called for");
}

void expect_constructed(const py::module_& m) {
  for (const auto& [name, member] : m.attr("__dict__").cast<py::dict>()) {
    if (!py::isinstance<py::type>(member)) continue;
    auto* const type = reinterpret_cast<PyTypeObject*>(member.ptr());
    if (py::detail::type_info* const known = py::detail::get_type_info(type))
      known->operator_new = refuse_unconstructed;
  }
}

constexpr const char* kRefusedDoc =
    "Why a call was refused, in one sentence. `status`: what kind of thing it was, 'bad_box' for example;\n"
    "`index`: which element of the argument that the sentence names, or None.";

}  // namespace

void refuse(const std::string& sentence) {
  raise(sentence, StatusCode::bad_argument, py::none());
}

void expect(const Status& status) {
  if (status) return;
  if (status.index() == Status::kNoIndex) raise(status.message(), status.code(), py::none());
  raise(status.message() + (" (element " + std::to_string(status.index()) + ")"), status.code(),
        py::int_(status.index()));
}

}  // namespace sightline::python

PYBIND11_MODULE(sightline, m) {
  using namespace sightline::python;
  m.doc() = kDoc;
  m.attr("__version__") = std::string(sightline::kVersion);
  refused = PyErr_NewExceptionWithDoc("sightline.Refused", kRefusedDoc, PyExc_ValueError, nullptr);
  if (!refused) throw py::error_already_set();
  m.attr("Refused") = py::reinterpret_borrow<py::object>(refused);
  add_views(m);
  add_occlusion(m);
  add_world(m);
  add_shadows(m);
  add_culling(m);
  add_instances(m);
  add_ranges(m);
  add_inspect(m);
  add_frustum(m);
  add_rays(m);
  add_pvs(m);
  expect_constructed(m);
  refuse_wrong_calls_in_a_sentence(m);
}
