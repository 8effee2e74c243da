// Any text as shader scripts, cut in two at its first form feed: names found in it have a look, or there are
// none.
#include <string>
#include <vector>

#include "workbench/io/quake3_shaders.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sightline;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::size_t cut = std::min(text.find('\f'), text.size());
  const std::vector<std::string> scripts{text.substr(0, cut), text.substr(cut)};
  const io::quake3::ShaderScripts parsed(scripts);
  if (parsed.broken() > scripts.size()) __builtin_trap();
  for (std::size_t at = 0; at < size; at += 16) {
    const io::quake3::ShaderLook* look = parsed.find(text.substr(at, 64));
    if (look != nullptr && look->surface > Surface::transparent) __builtin_trap();
  }
  return 0;
}
