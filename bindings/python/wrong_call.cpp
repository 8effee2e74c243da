// A call that no signature fits, refused in one sentence where pybind11 writes a list.
#include <algorithm>
#include <map>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "bindings/python/objects.hpp"

namespace sightline::python {

namespace {

namespace py = pybind11;

PyCFunctionWithKeywords call = nullptr;               // as pybind11 calls any of the module's functions
std::map<const PyObject*, std::string> setter_names;  // of attributes, whose functions have none

std::string last_name(std::string_view path) {
  return std::string(path.substr(path.rfind('.') + 1));
}

std::string type_of(PyObject* value) {
  return last_name(Py_TYPE(value)->tp_name);
}

struct Parameter {
  std::string name, type;
  bool optional = false, may_be_none = false;
};

// What pybind11 writes of a function: (self: module.Class, name: type = default) -> type, or
// module.Class(name: type) where that constructs.
struct Signature {
  std::string of;  // the class
  std::vector<Parameter> parameters;

  explicit Signature(std::string_view text);
};

Parameter parameter_of(std::string_view text) {
  const std::size_t type = text.find(": "), value = text.find(" = ");
  if (type == text.npos) return {std::string(text), "object", true};
  Parameter out{std::string(text.substr(0, type)),
                std::string(text.substr(std::min(type + 2, text.size()), value - type - 2)),
                value != text.npos, text.ends_with(" = None")};
  constexpr std::string_view kOptional = "Optional[";
  if (out.type.starts_with(kOptional)) {
    out.type = out.type.substr(kOptional.size(), out.type.size() - kOptional.size() - 1);
    out.may_be_none = true;
  }
  return out;
}

Signature::Signature(std::string_view text) {
  const std::size_t begin = text.find('('), end = std::min(text.rfind(") -> "), text.rfind(')'));
  of = last_name(text.substr(0, begin));
  int depth = 0;
  for (std::size_t at = begin + 1, from = at; at <= end; ++at) {
    depth += text[at] == '(' || text[at] == '[';
    if ((depth == 0 && text[at] == ',') || at == end) {
      if (from < at) parameters.push_back(parameter_of(text.substr(from, at - from)));
      from = at + 2;
    }
    depth -= text[at] == ')' || text[at] == ']';
  }
  if (parameters.empty() || parameters[0].name != "self") return;
  of = last_name(parameters[0].type);
  parameters.erase(parameters.begin());
}

bool fits(const Parameter& parameter, PyObject* value) {
  const std::string& type = parameter.type;
  if (type == "object" || (parameter.may_be_none && value == Py_None)) return true;
  if (type == "float") return PyNumber_Check(value) && !PyComplex_Check(value) && !PySequence_Check(value);
  if (type == "int") return PyIndex_Check(value) && !PySequence_Check(value);
  if (type == "bool") return PyBool_Check(value) || type_of(value).starts_with("bool");
  if (type == "str") return PyUnicode_Check(value);
  for (const py::handle base : py::reinterpret_borrow<py::tuple>(Py_TYPE(value)->tp_mro))
    if (last_name(type) == last_name(reinterpret_cast<PyTypeObject*>(base.ptr())->tp_name)) return true;
  return false;
}

// What is wrong with the arguments, those from `first` on.
std::string complaint(const Signature& signature, PyObject* args, PyObject* kwargs, Py_ssize_t first) {
  const std::vector<Parameter>& parameters = signature.parameters;
  const auto given = static_cast<std::size_t>(std::max<Py_ssize_t>(PyTuple_GET_SIZE(args) - first, 0));
  if (given > parameters.size()) {
    const std::size_t most = parameters.size();
    return "expected " +
           (most == 0 ? "no arguments"
                      : "at most " + std::to_string(most) + " argument" + (most == 1 ? "" : "s")) +
           ", got " + std::to_string(given);
  }
  std::vector<PyObject*> values(parameters.size(), nullptr);
  for (std::size_t i = 0; i < given; ++i) values[i] = PyTuple_GET_ITEM(args, first + Py_ssize_t(i));
  PyObject *key, *value;
  for (Py_ssize_t at = 0; kwargs && PyDict_Next(kwargs, &at, &key, &value);) {
    const std::string name = py::str(py::handle(key));
    const auto its = std::ranges::find(parameters, name, &Parameter::name);
    if (its == parameters.end()) return "there is no argument '" + name + "'";
    PyObject*& to = values[static_cast<std::size_t>(its - parameters.begin())];
    if (to) return "argument '" + name + "' is given twice";
    to = value;
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (!values[i] && !parameters[i].optional) return "argument '" + parameters[i].name + "' is missing";
    if (values[i] && !fits(parameters[i], values[i]))
      return "argument '" + parameters[i].name + "': expected " + parameters[i].type + ", got " +
             type_of(values[i]);
  }
  // The kind is right: a number that its type does not hold.
  std::string out;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (!values[i] || (parameters[i].type != "int" && parameters[i].type != "float")) continue;
    out += (out.empty() ? "a number is out of range: '" : ", '") + parameters[i].name +
           "' = " + std::string(py::str(py::handle(values[i])));
  }
  return out.empty() ? "the arguments are not of the expected kinds" : out;
}

// The sentence; empty where the message is no such list.
std::string sentence_of(std::string_view message, PyObject* function, PyObject* args, PyObject* kwargs) {
  const bool constructs = message.find("(): incompatible constructor arguments.") != message.npos;
  if (!constructs && message.find("(): incompatible function arguments.") == message.npos) return {};
  constexpr std::string_view kFirst = "\n    1. ";
  const std::size_t begin = message.find(kFirst);
  if (begin == message.npos) return {};
  const std::string_view text = message.substr(begin + kFirst.size());
  const Signature signature(text.substr(0, text.find('\n')));
  if (const auto setter = setter_names.find(function); setter != setter_names.end())
    return signature.of + "." + setter->second + ": expected " + signature.parameters.at(0).type + ", got " +
           type_of(PyTuple_GET_ITEM(args, PyTuple_GET_SIZE(args) - 1));
  const std::string name(message.substr(0, message.find("()")));
  const std::string what =
      constructs ? signature.of : (signature.of.empty() ? "" : signature.of + ".") + name;
  return what + "(): " + complaint(signature, args, kwargs, !signature.of.empty());
}

// Python calls it: nothing may be thrown.
PyObject* call_or_say(PyObject* function, PyObject* args, PyObject* kwargs) noexcept {
  PyObject* const result = call(function, args, kwargs);
  if (result || !PyErr_ExceptionMatches(PyExc_TypeError)) return result;
  try {
    py::error_already_set error;
    const std::string sentence = sentence_of(std::string(py::str(error.value())), function, args, kwargs);
    if (sentence.empty())
      error.restore();
    else
      PyErr_SetString(PyExc_TypeError, sentence.c_str());
  } catch (py::error_already_set& its) {  // what is given has no text
    its.restore();
  } catch (const std::bad_alloc&) {
    PyErr_NoMemory();
  }
  return nullptr;
}

// Of pybind11's functions the way in.
void take_over(py::handle function, const std::string& sets = "") {
  if (!function || !PyCFunction_Check(function.ptr())) return;
  const PyObject* const record = PyCFunction_GET_SELF(function.ptr());
  if (!record || !PyCapsule_CheckExact(record)) return;
  PyMethodDef& its = *reinterpret_cast<PyCFunctionObject*>(function.ptr())->m_ml;
  const auto any = [](auto* of) { return reinterpret_cast<void (*)()>(of); };
  if (its.ml_flags != (METH_VARARGS | METH_KEYWORDS) || any(its.ml_meth) == any(call_or_say)) return;
  call = reinterpret_cast<PyCFunctionWithKeywords>(any(its.ml_meth));
  its.ml_meth = reinterpret_cast<PyCFunction>(any(call_or_say));
  if (!sets.empty()) setter_names[record] = sets;
}

void take_over_members(py::handle scope) {
  for (const auto& [name, member] : py::dict(scope.attr("__dict__"))) {
    if (PyObject_TypeCheck(member.ptr(), &PyProperty_Type)) {
      take_over(py::detail::get_function(member.attr("fget")));
      take_over(py::detail::get_function(member.attr("fset")), py::str(name));
    } else if (py::isinstance<py::staticmethod>(member)) {
      take_over(member.attr("__func__"));
    } else {
      take_over(py::detail::get_function(member));
    }
  }
}

}  // namespace

void refuse_wrong_calls_in_a_sentence(const py::module_& m) {
  take_over_members(m);
  for (const auto& [name, member] : py::dict(m.attr("__dict__")))
    if (py::isinstance<py::type>(member)) take_over_members(member);
}

}  // namespace sightline::python
