#include "workbench/io/quake3_shaders.hpp"

#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <optional>
#include <utility>
#include <vector>

namespace sightline::io::quake3 {

namespace {

char lower(char c) noexcept {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

std::string lowered(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(), [](char c) { return c == '\\' ? '/' : lower(c); });
  return out;
}

std::string without_extension(std::string name) {
  const std::size_t slash = name.rfind('/'), dot = name.rfind('.');
  if (dot != std::string::npos && (slash == std::string::npos || dot > slash)) name.resize(dot);
  return name;
}

bool is(std::string_view token, std::string_view word) noexcept {
  return std::ranges::equal(token, word, {}, lower);
}

bool is_one_of(std::string_view token, std::initializer_list<std::string_view> words) noexcept {
  return std::ranges::any_of(words, [&](std::string_view word) { return is(token, word); });
}

/// Words between blanks, or within quotes; comments are blanks. A brace stands alone between blanks, as the
/// game has it.
class Words {
public:
  explicit Words(std::string_view text) : text_(text.substr(0, text.find('\0'))) {}

  /// The next word; nothing at the end.
  std::optional<std::string_view> next() {
    bool ignored = false;
    skip_blanks(ignored);
    return take();
  }
  /// The next word of this line; nothing where the line ends or a brace stands.
  std::optional<std::string_view> next_on_line() {
    const std::size_t before = at_;
    bool crossed = false;
    skip_blanks(crossed);
    if (!crossed) {
      const auto word = take();
      if (word && *word != "{" && *word != "}") return word;
    }
    at_ = before;
    return {};
  }

private:
  void skip_blanks(bool& crossed_line) {
    while (at_ < text_.size()) {
      if (static_cast<unsigned char>(text_[at_]) <= ' ') {
        crossed_line = crossed_line || text_[at_] == '\n';
        ++at_;
      } else if (text_.substr(at_, 2) == "//") {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (text_.substr(at_, 2) == "/*") {
        const std::size_t end = std::min(text_.find("*/", at_ + 2), text_.size());
        crossed_line = crossed_line || text_.substr(at_, end - at_).find('\n') != std::string_view::npos;
        at_ = std::min(end + 2, text_.size());
      } else {
        return;
      }
    }
  }

  std::optional<std::string_view> take() {
    if (at_ >= text_.size()) return {};
    if (text_[at_] == '"') {
      const std::size_t end = std::min(text_.find('"', at_ + 1), text_.size());
      const std::string_view word = text_.substr(at_ + 1, end - at_ - 1);
      at_ = std::min(end + 1, text_.size());
      return word;
    }
    const std::size_t start = at_;
    while (at_ < text_.size() && static_cast<unsigned char>(text_[at_]) > ' ') ++at_;
    return text_.substr(start, at_ - start);
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

/// What is collected of one shader.
struct Definition {
  int stages = 0;
  bool first_blends = false, first_is_tested = false;
  bool texture_moves = false, inverted = false;
  std::uint8_t cutoff = 128;
  std::string image;
  bool sorted_late = false, not_drawn = false, faces_the_eye = false, is_sky = false;
  Cull cull = Cull::backs;

  [[nodiscard]] bool is_drawn() const noexcept { return stages > 0 || is_sky || not_drawn; }
  [[nodiscard]] ShaderLook look() const noexcept {
    ShaderLook out;
    out.cull = faces_the_eye ? Cull::none : cull;
    // What the first stage leaves open no later stage fills: those are drawn over it at the same depth.
    if (first_is_tested) {
      out.surface = Surface::cut_out;
      out.alpha_cutoff = cutoff, out.inverted = inverted;
      if (!texture_moves) out.image = image;
    } else if (not_drawn || first_blends || sorted_late) {
      out.surface = Surface::transparent;
    }
    return out;
  }
};

/// In lower case, without extension; empty for what is no file ("$lightmap").
std::string image_name(std::string_view name) {
  if (name.starts_with('$') || name.starts_with('*')) return {};
  return without_extension(lowered(name));
}

/// "add", "filter", "blend", or two factors; GL_ONE GL_ZERO replaces what is there.
bool blends(Words& words) {
  const auto source = words.next_on_line(), target = words.next_on_line();
  if (!source) return false;
  return !(target && is(*source, "gl_one") && is(*target, "gl_zero"));
}

/// Behind opaque things and decals come grates, then what is blended.
bool is_late(std::string_view sort) noexcept {
  if (is_one_of(sort, {"portal", "sky", "opaque", "decal"})) return false;
  int number = 0;
  const auto [end, error] = std::from_chars(sort.data(), sort.data() + sort.size(), number);
  return error != std::errc{} || number > 4;
}

Cull cull_of(std::string_view word) noexcept {
  if (is_one_of(word, {"none", "twosided", "disable"})) return Cull::none;
  return is_one_of(word, {"back", "backside", "backsided"}) ? Cull::fronts : Cull::backs;
}

void read_directive(std::string_view word, Words& words, Definition& shader) {
  const auto on_line = [&] { return words.next_on_line().value_or(""); };
  if (is(word, "cull")) {
    shader.cull = cull_of(on_line());
  } else if (is(word, "sort")) {
    shader.sorted_late = is_late(on_line());
  } else if (is(word, "surfaceparm")) {
    const std::string_view what = on_line();
    shader.not_drawn = shader.not_drawn || is_one_of(what, {"nodraw", "fog"});
    shader.is_sky = shader.is_sky || is(what, "sky");
  } else if (is(word, "skyparms")) {
    shader.is_sky = true;
  } else if (is(word, "deformvertexes")) {
    shader.faces_the_eye = shader.faces_the_eye || is_one_of(on_line(), {"autosprite", "autosprite2"});
  }
  while (words.next_on_line()) {
  }
}

void read_stage_directive(std::string_view word, Words& words, Definition& shader) {
  const auto on_line = [&] { return words.next_on_line().value_or(""); };
  if (shader.stages != 1) {
  } else if (is(word, "blendfunc")) {
    shader.first_blends = blends(words);
  } else if (is(word, "alphafunc")) {
    const std::string_view test = on_line();
    shader.first_is_tested = true;
    shader.inverted = is(test, "lt128");
    shader.cutoff = is(test, "gt0") ? 1 : 128;
  } else if (is_one_of(word, {"map", "clampmap"})) {
    shader.image = image_name(on_line());
  } else if (is_one_of(word, {"animmap", "tcmod", "tcgen", "alphagen"})) {
    shader.texture_moves = true;
  }
  while (words.next_on_line()) {
  }
}

/// From behind a shader's opening brace to its closing one; nothing where that is missing.
std::optional<Definition> read_definition(Words& words) {
  Definition shader;
  int depth = 1;
  while (const auto word = words.next()) {
    if (*word == "{") {
      shader.stages += depth == 1;
      ++depth;
    } else if (*word == "}") {
      if (--depth == 0) return shader;
    } else if (depth == 1) {
      read_directive(*word, words, shader);
    } else if (depth == 2) {
      read_stage_directive(*word, words, shader);
    }
  }
  return {};
}

}  // namespace

ShaderScripts::ShaderScripts(std::span<const std::string> scripts) {
  for (const std::string& script : scripts) broken_ += script.size() > kMaxScript || !add(script);
}

bool ShaderScripts::add(std::string_view script) {
  std::vector<std::pair<std::string, ShaderLook>> found;
  Words words(script);
  while (const auto name = words.next()) {
    const std::string shader = lowered(*name);
    const auto open = words.next();
    if (!open || *open != "{") return false;
    const std::optional<Definition> definition = read_definition(words);
    if (!definition) return false;
    // One that draws nothing and is no sky is not there for the game either: it takes the plain image.
    if (definition->is_drawn()) found.emplace_back(shader, definition->look());
  }
  for (auto& [name, look] : found) looks_.try_emplace(std::move(name), std::move(look));
  return true;
}

const ShaderLook* ShaderScripts::find(std::string_view name) const {
  const auto found = looks_.find(without_extension(lowered(name)));
  return found == looks_.end() ? nullptr : &found->second;
}

}  // namespace sightline::io::quake3
