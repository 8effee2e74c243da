// "name?key=value&key=value": how worlds and methods take their parameters, declared once in a table that
// parsing, help texts and documentation all read.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace sightline {

/// A parameter's declaration. A number is bounded by [min, max]; a choice lists its words in `choices`,
/// separated by '|'.
struct ParameterInfo {
  std::string_view name;
  std::string_view summary;
  std::string_view fallback;  ///< the default, as text
  double min = 0, max = 0;
  bool integer = false;
  std::string_view choices = {};
};

/// Parsed parameters: every declared name has a value within its bounds.
class Parameters {
public:
  [[nodiscard]] double number(std::string_view name) const noexcept;
  [[nodiscard]] std::uint32_t count(std::string_view name) const noexcept;
  [[nodiscard]] std::string_view word(std::string_view name) const noexcept;
  void set(std::string name, std::string value) { values_[std::move(name)] = std::move(value); }

private:
  std::map<std::string, std::string, std::less<>> values_;
};

/// The part before '?'.
std::string_view specified_name(std::string_view specification) noexcept;

/// Reads the part after '?' against the declarations. Throws Error for keys that are not declared and values
/// that are not as they should be; `what` names the thing in its sentence.
Parameters parse_parameters(std::string_view what, std::string_view specification,
                            std::span<const ParameterInfo> declared);

}  // namespace sightline
