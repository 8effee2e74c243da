// The command line: a thin face on the workbench. Results go to stdout, complaints to stderr.
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <new>
#include <span>

#include <sightline/version.hpp>
#include <sightline/workbench/error.hpp>

#include "command.hpp"
#include "workbench/report/page_folder.hpp"

namespace sightline::app {

CLI::Validator share() {
  const auto refuse = [](const std::string& text) -> std::string {
    double value = -1;
    const bool number = CLI::detail::lexical_cast(text, value);
    return number && value >= 0 && value <= 1 ? "" : "'" + text + "' is no share, expected 0 to 1";
  };
  return {refuse, "0 to 1"};
}

CLI::Validator whole_number() {
  // CLI11 lets a minus wrap round to the largest numbers, and takes them for what is larger still.
  const auto refuse = [](const std::string& text) -> std::string {
    std::uint64_t value = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool good = read.ec == std::errc{} && read.ptr == text.data() + text.size();
    return good ? "" : "'" + text + "': expected a whole number from 0 to 18446744073709551615";
  };
  return {refuse, ""};
}

CLI::Validator page_folder() {
  const auto refuse = [](const std::string& folder) -> std::string {
    try {
      const report::PageFolder trial(folder);
      return "";
    } catch (const Error& error) {
      return error.what();
    }
  };
  return {refuse, ""};
}

CLI::Validator output_file() {
  const auto refuse = [](const std::string& file) -> std::string {
    const std::filesystem::path folder = std::filesystem::path(file).parent_path();
    const bool open = access(folder.empty() ? "." : folder.c_str(), W_OK | X_OK) == 0;
    if (!file.empty() && open && !std::filesystem::is_directory(file)) return "";
    return "'" + file + "' cannot be written, expected a file in a folder that is there and open to writing";
  };
  return {refuse, ""};
}

CLI::Validator not_empty() {
  const auto refuse = [](const std::string& text) -> std::string {
    return text.empty() ? "it is empty, expected a name" : "";
  };
  return {refuse, ""};
}

void add_faces(CLI::App& command, RasterState& state) {
  static const std::map<std::string, RasterState> kStates{{"materials", RasterState::materials},
                                                          {"both", RasterState::both_sides},
                                                          {"front", RasterState::front_faces}};
  command
      .add_option_function<std::string>(
          "--faces", [&state](const std::string& name) { state = kStates.at(name); },
          "sides of triangles that are drawn: as the materials say, both, or front alone; what is exact is "
          "so "
          "in that state")
      ->check(CLI::IsMember(kStates).description(""))
      ->type_name("materials|both|front");
}

std::pair<std::uint32_t, std::uint32_t> parse_size(const std::string& text) {
  std::uint32_t width = 0, height = 0;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, width);
  if (first.ec == std::errc{} && first.ptr != end && *first.ptr == 'x') {
    const auto second = std::from_chars(first.ptr + 1, end, height);
    if (second.ec == std::errc{} && second.ptr == end && width > 0 && height > 0 && width <= 4096 &&
        height <= 4096) {
      return {width, height};
    }
  }
  throw Error("--size '" + text + "': expected WIDTHxHEIGHT in pixels, 1 to 4096 each, such as 1280x720");
}

std::vector<std::string> split(const std::string& option, const std::string& list) {
  std::vector<std::string> out;
  for (std::size_t start = 0; start <= list.size();) {
    const std::size_t comma = std::min(list.find(',', start), list.size());
    if (comma == start)
      throw Error(option + " '" + list + "': an entry is empty, expected values with single commas between");
    out.push_back(list.substr(start, comma - start));
    start = comma + 1;
  }
  return out;
}

namespace {

// CLI11's own words, but for the one case in which they hide what was typed: an unknown command.
std::string complaint(const CLI::App& app, const CLI::ParseError& error, std::span<char*> words) {
  const CLI::App* at = &app;
  for (const std::string word : words) {
    const auto commands = at->get_subcommands([](const CLI::App*) { return true; });
    if (commands.empty() || word.starts_with('-')) break;
    const auto found = std::ranges::find(commands, word, [](const CLI::App* of) { return of->get_name(); });
    if (found == commands.end()) {
      std::string known;
      for (const CLI::App* command : commands) known += (known.empty() ? "" : ", ") + command->get_name();
      return "'" + word + "': no such command, expected one of " + known;
    }
    at = *found;
  }
  return std::string(error.what()) + "; see sightline --help";
}

int run(int argc, char** argv) {
  CLI::App app{"Sightline decides what not to draw: visibility culling, measured and proven.", "sightline"};
  app.set_version_flag("--version", std::string(kVersion));
  app.require_subcommand(1);
  int exit = Exit::done;
  add_methods(app, exit);
  add_compare(app, exit);
  add_verify(app, exit);
  add_reproduce(app, exit);
  add_bake(app, exit);
  add_query(app, exit);
  add_occluders(app, exit);
  add_casters(app, exit);
  add_generate(app, exit);
  add_info(app, exit);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // prints help or version
    throw Error(complaint(app, error, std::span(argv, argv + argc).subspan(argc > 0)));
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout)) throw Error("standard output: cannot be written to");
  return exit;
}

}  // namespace
}  // namespace sightline::app

int main(int argc, char** argv) {
  try {
    return sightline::app::run(argc, argv);
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "sightline: out of memory: the scene or the image is too large for this machine\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "sightline: %s\n", error.what());
  }
  return sightline::app::Exit::wrong_call;
}
