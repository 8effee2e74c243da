#include "workbench/io/gltf_uri.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include <sightline/workbench/error.hpp>

namespace sightline::io::gltf {

namespace {

std::vector<std::byte> decode_base64(std::string_view text) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  static constexpr auto kValues = [] {
    std::array<std::uint8_t, 256> values{};
    values.fill(255);
    for (std::size_t i = 0; i < kDigits.size(); ++i) {
      values[static_cast<unsigned char>(kDigits[i])] = static_cast<std::uint8_t>(i);
    }
    return values;
  }();
  for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.remove_suffix(1);
  std::vector<std::byte> out;
  out.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0, held = 0;
  for (const char c : text) {
    const std::uint8_t value = kValues[static_cast<unsigned char>(c)];
    if (value == 255) throw Error("has a data URI that is not base64");
    bits = (bits << 6 | value) & 0xffffff;
    held += 6;
    if (held >= 8) {
      held -= 8;
      out.push_back(static_cast<std::byte>(bits >> held & 0xff));
    }
  }
  return out;
}

std::string decode_percent(std::string_view text) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
  };
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 && digit(text[i + 2]) >= 0) {
      out.push_back(static_cast<char>(digit(text[i + 1]) * 16 + digit(text[i + 2])));
      i += 2;
    } else {
      out.push_back(text[i]);
    }
  }
  return out;
}

bool lies_within(const std::filesystem::path& path, const std::filesystem::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace

std::optional<std::vector<std::byte>> decode_data_uri(std::string_view uri) {
  if (!uri.starts_with("data:")) return {};
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64")) {
    throw Error("has a data URI that is not base64");
  }
  return decode_base64(uri.substr(comma + 1));
}

std::filesystem::path find_uri(std::string_view uri, const std::filesystem::path& folder) {
  const std::string shown(uri.substr(0, 100));
  if (folder.empty())
    throw Error(fmt::format("lies in another file ('{}'), expected all data within this one", shown));
  const std::string text = decode_percent(uri);
  const std::filesystem::path relative(text);
  const bool climbs = std::find(relative.begin(), relative.end(), "..") != relative.end();
  if (text.empty() || text.size() > 1024 || text.find('\0') != std::string::npos || relative.is_absolute() ||
      text.find(':') != std::string::npos || text.find('\\') != std::string::npos || climbs) {
    throw Error(fmt::format("has the URI '{}', expected a relative path within the file's folder", shown));
  }
  std::error_code error;
  const std::filesystem::path home = std::filesystem::canonical(folder, error);
  const std::filesystem::path path = std::filesystem::canonical(folder / relative, error);
  if (error) throw Error(fmt::format("lies in '{}', which cannot be found: {}", shown, error.message()));
  if (!lies_within(path, home))
    throw Error(fmt::format("lies in '{}', which leads out of the file's folder", shown));
  return path;
}

}  // namespace sightline::io::gltf
