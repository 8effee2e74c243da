// sightline methods: what there is, straight from the registry.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include <sightline/version.hpp>
#include <sightline/workbench/method.hpp>

#include "command.hpp"
#include "workbench/device/device.hpp"
#include "workbench/io/text_file.hpp"

namespace sightline::app {

namespace {

nlohmann::ordered_json to_json(const MethodInfo& info, const MethodForm& form) {
  nlohmann::ordered_json parameters = nlohmann::ordered_json::array();
  for (const ParameterInfo& parameter : form.parameters) {
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
          {"summary", info.summary}, {"guarantee", to_string(form.guarantee)},
          {"needs", form.needs},     {"parameters", std::move(parameters)}};
}

void print(const MethodInfo& info, const MethodForm& form) {
  fmt::print("{:<22} {:<13} {:<34} {}\n", info.name, to_string(form.guarantee), info.paper, info.summary);
  if (!form.needs.empty()) fmt::print("{:22} needs {}\n", "", form.needs);
  for (const ParameterInfo& parameter : form.parameters) {
    fmt::print("{:22} ?{}={}  ({}) {}\n", "", parameter.name, parameter.fallback, range_of(parameter),
               parameter.summary);
  }
}

}  // namespace

void add_methods(CLI::App& app, int& exit) {
  CLI::App& command =
      *app.add_subcommand("methods", "List the methods: name, paper, guarantee, parameters, what they need");
  auto json = std::make_shared<std::string>();
  command.add_option("--json", *json, "also write the list as JSON to FILE")
      ->check(output_file())
      ->type_name("FILE");
  on_run(command, exit, [json] {
    const std::vector<device::DeviceInfo> devices = device::list_devices();
    if (!json->empty()) {
      using Json = nlohmann::ordered_json;
      Json document{{"sightline", kVersion},
                    {"methods", Json::array()},
                    {"device_methods", Json::array()},
                    {"devices", Json::array()}};
      for (const MethodInfo& info : all_methods()) {
        if (info.cpu.exists()) document["methods"].push_back(to_json(info, info.cpu));
        if (info.device.exists()) document["device_methods"].push_back(to_json(info, info.device));
      }
      for (const device::DeviceInfo& info : devices) {
        document["devices"].push_back({{"name", info.name}, {"kind", info.kind}, {"driver", info.driver}});
      }
      io::write_file(*json, document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
    }
    fmt::print("On the CPU (--device cpu):\n");
    for (const MethodInfo& info : all_methods()) {
      if (info.cpu.exists()) print(info, info.cpu);
    }
    fmt::print(
        "\nOn a Vulkan device (--device NAME), where CPU methods without a form of their own are drawn "
        "too:\n");
    for (const MethodInfo& info : all_methods()) {
      if (info.device.exists()) print(info, info.device);
    }
    fmt::print("\nVulkan devices:{}\n", devices.empty() ? " none" : "");
    for (std::size_t i = 0; i < devices.size(); ++i) {
      fmt::print("{:>3}  {} ({}, {})\n", i, devices[i].name, devices[i].kind, devices[i].driver);
    }
    return Exit::done;
  });
}

}  // namespace sightline::app
