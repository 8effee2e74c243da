#include <sightline/workbench/parameters.hpp>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <set>

#include <sightline/workbench/error.hpp>

namespace sightline {

namespace {

bool parse_number(std::string_view text, double& value) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && stop == end && std::isfinite(value);
}

bool is_choice(std::string_view choices, std::string_view word) {
  while (!choices.empty()) {
    const std::size_t bar = choices.find('|');
    if (choices.substr(0, bar) == word) return true;
    if (bar == std::string_view::npos) break;
    choices.remove_prefix(bar + 1);
  }
  return false;
}

std::string text_of(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

const ParameterInfo* find(std::span<const ParameterInfo> declared, std::string_view name) {
  for (const ParameterInfo& info : declared) {
    if (info.name == name) return &info;
  }
  return nullptr;
}

std::string listed(std::span<const ParameterInfo> declared) {
  std::string names;
  for (const ParameterInfo& info : declared) names.append(names.empty() ? "" : ", ").append(info.name);
  return names.empty() ? "no parameter" : names;
}

/// What is wrong with the value; empty where nothing is.
std::string complaint(const ParameterInfo& info, std::string_view value) {
  if (!info.choices.empty()) {
    if (is_choice(info.choices, value)) return {};
    return "'" + std::string(info.name) + "' is '" + std::string(value) + "', expected one of " +
           std::string(info.choices);
  }
  double number = 0;
  if (parse_number(value, number) && number >= info.min && number <= info.max &&
      (!info.integer || number == std::floor(number))) {
    return {};
  }
  return "'" + std::string(info.name) + "' is '" + std::string(value) + "', expected " +
         (info.integer ? "a whole number" : "a number") + " from " + text_of(info.min) + " to " +
         text_of(info.max);
}

}  // namespace

double Parameters::number(std::string_view name) const noexcept {
  double value = 0;
  const auto found = values_.find(name);
  if (found != values_.end()) parse_number(found->second, value);
  return value;
}

std::uint32_t Parameters::count(std::string_view name) const noexcept {
  return static_cast<std::uint32_t>(number(name));
}

std::string_view Parameters::word(std::string_view name) const noexcept {
  const auto found = values_.find(name);
  return found == values_.end() ? std::string_view{} : found->second;
}

std::string_view specified_name(std::string_view specification) noexcept {
  return specification.substr(0, specification.find('?'));
}

Parameters parse_parameters(std::string_view what, std::string_view specification,
                            std::span<const ParameterInfo> declared) {
  Parameters out;
  for (const ParameterInfo& info : declared) out.set(std::string(info.name), std::string(info.fallback));
  const std::size_t question = specification.find('?');
  if (question == std::string_view::npos) return out;
  std::string_view rest = specification.substr(question + 1);
  const std::string subject = std::string(what) + " '" + std::string(specified_name(specification)) + "': ";
  std::set<std::string_view> given;
  while (!rest.empty()) {
    const std::string_view pair = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(rest.size(), pair.size() + 1));
    const std::size_t equals = pair.find('=');
    if (equals == std::string_view::npos) {
      throw Error(subject + "'" + std::string(pair) + "' is not of the form key=value");
    }
    const std::string_view key = pair.substr(0, equals), value = pair.substr(equals + 1);
    const ParameterInfo* info = find(declared, key);
    if (!info) {
      throw Error(subject + "it has no parameter '" + std::string(key) + "', expected " + listed(declared));
    }
    if (!given.insert(key).second)
      throw Error(subject + "'" + std::string(key) + "' is given twice, expected it once");
    if (const std::string wrong = complaint(*info, value); !wrong.empty()) throw Error(subject + wrong);
    out.set(std::string(key), std::string(value));
  }
  return out;
}

}  // namespace sightline
