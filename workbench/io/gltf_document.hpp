// A glTF 2.0 document whose every reference is checked before it is followed: the JSON, the buffers behind
// it, and accessors as bounded views of them.
//
// The JSON is parsed with nlohmann::json and not with tinygltf: tinygltf recurses into "extras", so that 200
// kB of opening brackets overflow its stack, and it copies every buffer and decodes every image on the way.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "workbench/io/byte_reader.hpp"

namespace sightline::io::gltf {

using Json = nlohmann::json;

/// The member, or null where there is none (or `object` is no object).
const Json* find(const Json& object, const char* key) noexcept;
/// The member as an array; empty where there is none. Throws Error if it is something else.
const Json::array_t& array_of(const Json& object, const char* key);
/// The member as a whole number below 2^32, or as a finite number; `fallback` where there is none.
std::uint64_t whole_of(const Json& object, const char* key, std::uint64_t fallback);
double number_of(const Json& value, const char* what);
/// The member as a whole number below 2^32. Throws Error where there is none.
std::uint64_t whole_of(const Json& object, const char* key);
std::string text_of(const Json& object, const char* key);
/// Exactly `out.size()` finite numbers.
void numbers_of(const Json& value, const char* what, std::span<double> out);

inline constexpr std::uint64_t kNone = ~std::uint64_t{0};

/// Component types (glTF 2.0, 3.6.2.2).
inline constexpr std::uint32_t kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
                               kUnsignedInt = 5125, kFloat = 5126;
/// Of a scene that is read or written: ids are kept as floats.
inline constexpr std::size_t kMaxObjects = std::size_t{1} << 24;

/// Elements of a buffer, each read where it stands. Every index below count() is safe.
class Accessor {
public:
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] std::string_view type() const noexcept { return type_; }
  [[nodiscard]] bool is_unsigned_integer() const noexcept;
  /// Component k of element i; normalised integers become -1 … 1.
  [[nodiscard]] float component(std::uint64_t i, std::uint32_t k) const noexcept;
  [[nodiscard]] std::uint32_t integer(std::uint64_t i) const noexcept;

private:
  friend class Document;
  [[nodiscard]] const std::byte* element(std::uint64_t i) const noexcept;

  std::uint64_t count_ = 0;
  std::string_view type_;
  std::uint32_t component_type_ = 0, component_size_ = 0;
  bool normalised_ = false;
  const std::byte* data_ = nullptr;  ///< null: all zero
  std::uint64_t stride_ = 0;
  std::uint64_t sparse_count_ = 0;  ///< elements replaced, their indices ascending
  std::uint32_t sparse_index_size_ = 0;
  const std::byte* sparse_indices_ = nullptr;
  const std::byte* sparse_values_ = nullptr;
  std::uint64_t sparse_stride_ = 0;
};

class Document {
public:
  /// `bytes` outlive the document. External buffers and images come from `folder`; empty: there are none.
  Document(Bytes bytes, const std::filesystem::path& folder);

  [[nodiscard]] const Json& root() const noexcept { return root_; }
  /// Element `index` of the top level array `kind`.
  [[nodiscard]] const Json& at(const char* kind, std::uint64_t index) const;
  /// Checked once, then kept.
  const Accessor& accessor(std::uint64_t index);
  /// The bytes of element `index` of 'images', whatever they are.
  [[nodiscard]] Bytes image(std::uint64_t index);
  /// Bytes of all buffers together, what several share counted once.
  [[nodiscard]] std::uint64_t buffer_bytes() const noexcept { return buffer_bytes_; }

private:
  Bytes buffer(const Json& description, std::size_t index, Bytes binary_chunk);
  Bytes load(const std::string& uri);
  std::vector<std::byte> load_file(const std::filesystem::path& path);
  [[nodiscard]] Bytes buffer_view(std::uint64_t index, std::uint64_t& stride) const;
  [[nodiscard]] Accessor make_accessor(const Json& description);
  void read_sparse(const Json& sparse, std::uint64_t element_size, Accessor& out);

  Json root_;
  std::filesystem::path folder_;
  // Buffers and images.
  std::map<std::string, std::vector<std::byte>, std::less<>> data_;  ///< by data URI
  std::map<std::filesystem::path, std::vector<std::byte>> files_;    ///< however their URIs are spelt
  std::uint64_t file_budget_ = std::uint64_t{1} << 32;               ///< bytes that may still be read
  std::vector<Bytes> buffers_;
  std::uint64_t buffer_bytes_ = 0;
  std::uint64_t sparse_budget_ = 0;  ///< indices of sparse accessors that may still be looked at
  std::map<std::uint64_t, Accessor> accessors_;
};

}  // namespace sightline::io::gltf
