#include "workbench/bake/pvs_file.hpp"

#include "workbench/io/files.hpp"

namespace sightline::bake {

void write_pvs_file(const CellPvs& cells, const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = or_throw(write_pvs(cells));
  const std::span<const std::byte> pieces[] = {bytes};
  io::write_file(file, pieces);
}

CellPvs read_pvs_file(const std::filesystem::path& file) {
  Result<CellPvs> cells = read_pvs(io::read_file(file));
  if (!cells) throw Error(sentence_about(file.string(), to_string(cells.error())));
  return *std::move(cells);
}

std::string sentence_about(const std::string& what, std::string_view sentence) {
  constexpr std::string_view kSubject = "pvs: ";
  if (sentence.starts_with(kSubject)) sentence.remove_prefix(kSubject.size());
  return what + ": " + std::string(sentence);
}

void check_belongs(const CellPvs& cells, const std::string& file, const Scene& scene) {
  if (cells.objects == scene.size() && cells.scene == fingerprint(scene)) return;
  throw Error(file + ": was baked for another scene than '" + scene.name + "'");
}

}  // namespace sightline::bake
