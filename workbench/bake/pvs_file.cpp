#include "workbench/bake/pvs_file.hpp"

#include "workbench/io/files.hpp"

namespace sightline::bake {

void write_pvs_file(const CellPvs& cells, const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = or_throw(write_pvs(cells));
  const std::span<const std::byte> pieces[] = {bytes};
  io::write_file(file, pieces);
}

CellPvs read_pvs_file(const std::filesystem::path& file) {
  return or_throw(read_pvs(io::read_file(file), file.string()));
}

void check_belongs(const CellPvs& cells, const std::string& file, const Scene& scene) {
  if (cells.objects == scene.size() && cells.scene == fingerprint(scene)) return;
  throw Error(file + ": was baked for another scene than '" + scene.name + "'");
}

}  // namespace sightline::bake
