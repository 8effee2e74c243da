// A command: declares its options on the application and leaves what to run as the callback.
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <sightline/workbench/parameters.hpp>
#include <sightline/workbench/scene.hpp>

namespace sightline::app {

/// Exit codes, which scripts rely on.
enum Exit : int { done = 0, check_failed = 1, wrong_call = 2 };

/// Each adds its subcommand; the subcommand's callback sets `exit`.
void add_methods(CLI::App& app, int& exit);
void add_info(CLI::App& app, int& exit);
void add_generate(CLI::App& app, int& exit);
void add_verify(CLI::App& app, int& exit);
void add_compare(CLI::App& app, int& exit);
void add_reproduce(CLI::App& app, int& exit);
void add_bake(CLI::App& app, int& exit);
void add_query(CLI::App& app, int& exit);
void add_occluders(CLI::App& app, int& exit);
void add_casters(CLI::App& app, int& exit);

inline constexpr const char* kSceneHelp =
    "a file (.glb, .gltf, .bsp, archive.pk3:maps/name.bsp) or a generated world "
    "(world:forest?trees=30000&seed=7)";

/// Adds `command` with a callback that runs `run()` and keeps its exit code.
template <class Run>
void on_run(CLI::App& command, int& exit, Run run) {
  command.callback([&exit, run = std::move(run)]() mutable { exit = run(); });
}

/// Gives the scene what was baked for it; nothing for an empty name. Throws Error for a file of another
/// scene.
void attach_pvs(Scene& scene, const std::string& file);

/// The option --faces: which sides of triangles are drawn.
void add_faces(CLI::App& command, RasterState& state);

/// "WxH" as two numbers; refuses anything else with a sentence.
std::pair<std::uint32_t, std::uint32_t> parse_size(const std::string& text);

/// A whole number in decimal digits, for CLI::Option::transform; a number, for CLI::Option::check.
CLI::Validator whole(std::uint64_t low, std::uint64_t high);
CLI::Validator number(double low, double high);
inline constexpr std::uint64_t kAnySeed = std::numeric_limits<std::uint64_t>::max();

/// A folder for a page, made, one that is there already, and a file's folder, all tried before any work is
/// done; a name that is not empty. A file's name may end otherwise than in `ending` only by having none.
CLI::Validator page_folder();
CLI::Validator output_folder();
CLI::Validator output_file(const std::string& ending = "");
CLI::Validator not_empty();

/// A file or folder and the option that names it; nothing where the path is empty.
struct NamedPath {
  const char* option;
  std::string path;
};
/// Refuses what would be written over what is read, or over something else that is written.
void expect_apart(const std::vector<NamedPath>& read, const std::vector<NamedPath>& written);

/// What a parameter may be: "0 to 5", or its choices.
std::string range_of(const ParameterInfo& parameter);

/// "A,B,C", the value of an option, as a list; refuses empty entries. Parameters of a method may hold no
/// comma.
std::vector<std::string> split(const std::string& option, const std::string& list);

/// Told how much is done; draws one line on stderr when it is a terminal.
std::function<void(std::size_t done, std::size_t all)> progress(std::string what);
/// "40 s", "3 min 5 s", "2 h 10 min".
std::string in_words(double seconds);

}  // namespace sightline::app
