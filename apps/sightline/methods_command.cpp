// sightline methods: what there is, straight from the registry.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include <sightline/method.hpp>
#include <sightline/version.hpp>

#include "command.hpp"
#include "lab/file.hpp"

namespace sightline::app {

namespace {

nlohmann::ordered_json to_json(const MethodInfo& info) {
  nlohmann::ordered_json parameters = nlohmann::ordered_json::array();
  for (const ParameterInfo& parameter : info.parameters) {
    nlohmann::ordered_json entry{
        {"name", parameter.name}, {"summary", parameter.summary}, {"default", parameter.fallback}};
    if (parameter.choices.empty()) {
      entry["min"] = parameter.min, entry["max"] = parameter.max;
    } else {
      entry["choices"] = parameter.choices;
    }
    parameters.push_back(std::move(entry));
  }
  return {{"name", info.name},       {"paper", info.paper},
          {"summary", info.summary}, {"guarantee", to_string(info.guarantee)},
          {"needs", info.needs},     {"parameters", std::move(parameters)}};
}

void print(const MethodInfo& info) {
  fmt::print("{:<16} {:<13} {:<34} {}\n", info.name, to_string(info.guarantee), info.paper, info.summary);
  if (!info.needs.empty()) fmt::print("{:16} needs {}\n", "", info.needs);
  for (const ParameterInfo& parameter : info.parameters) {
    const std::string range = parameter.choices.empty()
                                  ? fmt::format("{:g} to {:g}", parameter.min, parameter.max)
                                  : std::string(parameter.choices);
    fmt::print("{:16} ?{}={}  ({}) {}\n", "", parameter.name, parameter.fallback, range, parameter.summary);
  }
}

}  // namespace

void add_methods(CLI::App& app, int& exit) {
  CLI::App& command =
      *app.add_subcommand("methods", "List the methods: name, paper, guarantee, parameters, what they need");
  auto json = std::make_shared<std::string>();
  command.add_option("--json", *json, "also write the list as JSON to FILE")->type_name("FILE");
  on_run(command, exit, [json] {
    if (!json->empty()) {
      nlohmann::ordered_json document{{"sightline", kVersion}, {"methods", nlohmann::ordered_json::array()}};
      for (const MethodInfo& info : cpu_methods()) document["methods"].push_back(to_json(info));
      lab::write_file(*json, document.dump(1) + "\n");
    }
    for (const MethodInfo& info : cpu_methods()) print(info);
    return Exit::done;
  });
}

}  // namespace sightline::app
