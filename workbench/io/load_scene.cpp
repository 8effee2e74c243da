// From what a user types to a checked scene.
#include <algorithm>
#include <cstdlib>

#include <sightline/workbench/io.hpp>
#include <sightline/workbench/worlds.hpp>

#include "workbench/io/files.hpp"
#include "workbench/io/pk3.hpp"

namespace sightline {

namespace {

constexpr std::string_view kOpenArenaData = "/usr/share/games/openarena/baseoa";

/// The archive itself, or the first of that name in the data folders.
std::filesystem::path find_archive(const std::filesystem::path& archive) {
  std::error_code ignored;
  const auto here = std::filesystem::status(archive, ignored).type();  // none of what may not be looked at
  if (archive.is_absolute() || here != std::filesystem::file_type::not_found) return archive;
  const char* variable = std::getenv("SIGHTLINE_DATA");
  std::string folders = variable != nullptr ? variable : "";
  folders.append(":").append(kOpenArenaData);
  for (std::size_t at = 0; at <= folders.size();) {
    const std::size_t end = std::min(folders.find(':', at), folders.size());
    const std::string folder = folders.substr(at, end - at);
    if (!folder.empty() && std::filesystem::exists(folder / archive, ignored)) return folder / archive;
    at = end + 1;
  }
  throw Error(archive.string() + ": no such file here, in the folders of SIGHTLINE_DATA, or in " +
              std::string(kOpenArenaData) + " (Debian package openarena-081-maps)");
}

/// The folder, or "." where the path has none.
std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : ".";
}

/// Levels lie in "maps" of the game's folder; one that does not is taken to lie in the folder itself.
std::filesystem::path game_of(const std::filesystem::path& level) {
  std::error_code ignored;
  const std::filesystem::path folder =
      std::filesystem::absolute(folder_of(level), ignored).lexically_normal();
  return folder.filename() == "maps" ? folder.parent_path() : folder;
}

Scene load_level(io::Bytes bytes, const std::string& name, const std::filesystem::path& game,
                 const LoadOptions& options) {
  io::GameFiles files(game);
  return io::read_level(bytes, name, files, options);
}

Scene load(std::string_view specification, const LoadOptions& options) {
  constexpr std::string_view kWorld = "world:", kArchive = ".pk3:";
  const std::string text(specification);
  if (text.empty())
    throw Error("no scene given, expected world:NAME or a .glb, .gltf, .bsp or archive.pk3:maps/name.bsp");
  if (text.find('\0') != std::string::npos)
    throw Error("the scene's name holds a zero byte, expected a file name");
  if (text.starts_with(kWorld)) return generate_world(specification.substr(kWorld.size()));
  if (const std::size_t at = text.find(kArchive); at != std::string::npos) {
    const std::filesystem::path archive = find_archive(text.substr(0, at + kArchive.size() - 1));
    return load_level(io::unpack_entry(archive, text.substr(at + kArchive.size())), text, folder_of(archive),
                      options);
  }
  const std::filesystem::path path(text);
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; });
  if (ending == ".bsp") return load_level(io::read_file(path), text, game_of(path), options);
  if (ending == ".glb" || ending == ".gltf") return read_gltf(io::read_file(path), text, folder_of(path));
  if (ending == ".pk3") throw Error(text + ": names an archive, expected archive.pk3:maps/name.bsp");
  throw Error(
      text +
      ": not a kind of scene, expected world:NAME or a .glb, .gltf, .bsp or archive.pk3:maps/name.bsp");
}

}  // namespace

Scene load_scene(std::string_view specification, const LoadOptions& options) {
  Scene scene = load(specification, options);
  check(scene);
  return scene;
}

}  // namespace sightline
