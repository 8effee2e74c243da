#include "workbench/io/gltf_document.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <sightline/workbench/error.hpp>

#include "workbench/io/files.hpp"
#include "workbench/io/gltf_uri.hpp"

namespace sightline::io::gltf {

namespace {

std::uint32_t component_size(std::uint64_t type) {
  switch (type) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      throw Error(fmt::format("has component type {}, expected 5120 … 5123, 5125 or 5126", type));
  }
}

struct ElementType {
  std::string_view name;
  std::uint32_t components;
};
constexpr ElementType kElementTypes[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}};

const ElementType& element_type(const std::string& name) {
  for (const ElementType& type : kElementTypes) {
    if (type.name == name) return type;
  }
  throw Error(fmt::format("has type '{}', expected SCALAR, VEC2, VEC3 or VEC4", name.substr(0, 20)));
}

std::uint32_t read_index(const std::byte* at, std::uint32_t size) noexcept {
  std::uint32_t value = 0;
  std::memcpy(&value, at, size);
  return value;
}

/// The chunks of a GLB file.
struct Container {
  Bytes json, binary;
};

Container open_container(Bytes bytes) {
  constexpr std::uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
  if (bytes.empty()) throw Error("is empty, expected a GLB or JSON");
  if (bytes.size() < 4 || std::memcmp(bytes.data(), "glTF", 4) != 0) return {bytes, {}};
  if (bytes.size() < 20)
    throw Error(fmt::format("is {} bytes long, expected a GLB header and a chunk", bytes.size()));
  const auto version = read_at<std::uint32_t>(bytes, 4), length = read_at<std::uint32_t>(bytes, 8);
  if (version != 2) throw Error(fmt::format("has GLB version {}, expected 2", version));
  if (length < 20 || length > bytes.size()) {
    throw Error(fmt::format("says it is {} bytes long, but has {}", length, bytes.size()));
  }
  bytes = bytes.first(length);
  Container out;
  for (std::size_t at = 12; at < bytes.size();) {
    if (!fits(at, 8, bytes.size())) throw Error(fmt::format("has a broken chunk header at byte {}", at));
    const auto size = read_at<std::uint32_t>(bytes, at), kind = read_at<std::uint32_t>(bytes, at + 4);
    if (!fits(at + 8, size, bytes.size())) {
      throw Error(fmt::format("has a chunk of {} bytes at byte {}, beyond its end", size, at));
    }
    const Bytes chunk = bytes.subspan(at + 8, size);
    if (at == 12) {
      if (kind != kJsonChunk) throw Error("has no JSON in its first chunk");
      out.json = chunk;
    } else if (kind == kBinaryChunk && out.binary.empty()) {
      out.binary = chunk;
    }
    at += 8 + std::size_t{size};
  }
  return out;
}

Json parse(Bytes text) {
  const auto* begin = reinterpret_cast<const char*>(text.data());
  try {
    return Json::parse(begin, begin + text.size());
  } catch (const Json::parse_error& error) {
    throw Error(fmt::format("is not JSON, nor a GLB, which begins with glTF: wrong at byte {} of {}",
                            error.byte, text.size()));
  } catch (const Json::exception&) {
    throw Error("is not JSON that can be read: it holds a number out of range");
  }
}

}  // namespace

const Json* find(const Json& object, const char* key) noexcept {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

const Json::array_t& array_of(const Json& object, const char* key) {
  static const Json::array_t kEmpty;
  const Json* found = find(object, key);
  if (found == nullptr) return kEmpty;
  if (!found->is_array()) throw Error(fmt::format("has '{}' that is not an array", key));
  return *found->get_ptr<const Json::array_t*>();
}

double number_of(const Json& value, const char* what) {
  if (!value.is_number() || !std::isfinite(value.get<double>())) {
    throw Error(fmt::format("has '{}' that is not a finite number", what));
  }
  return value.get<double>();
}

std::uint64_t whole_of(const Json& object, const char* key, std::uint64_t fallback) {
  const Json* found = find(object, key);
  if (found == nullptr) return fallback;
  const double number = number_of(*found, key);
  if (number < 0 || number >= 4294967296.0 || number != std::floor(number)) {
    throw Error(fmt::format("has '{}' = {}, expected a whole number from 0 and below 2^32", key, number));
  }
  return static_cast<std::uint64_t>(number);
}

std::uint64_t whole_of(const Json& object, const char* key) {
  if (find(object, key) == nullptr) throw Error(fmt::format("lacks '{}'", key));
  return whole_of(object, key, 0);
}

std::string text_of(const Json& object, const char* key) {
  const Json* found = find(object, key);
  return found != nullptr && found->is_string() ? found->get<std::string>() : std::string();
}

void numbers_of(const Json& value, const char* what, std::span<double> out) {
  if (!value.is_array() || value.size() != out.size()) {
    throw Error(fmt::format("has '{}' that is not {} numbers", what, out.size()));
  }
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = number_of(value[i], what);
}

bool Accessor::is_unsigned_integer() const noexcept {
  return component_type_ == kUnsignedByte || component_type_ == kUnsignedShort ||
         component_type_ == kUnsignedInt;
}

const std::byte* Accessor::element(std::uint64_t i) const noexcept {
  std::uint64_t low = 0, high = sparse_count_;
  while (low < high) {
    const std::uint64_t middle = (low + high) / 2;
    const std::uint32_t at = read_index(sparse_indices_ + middle * sparse_index_size_, sparse_index_size_);
    if (at == i) return sparse_values_ + middle * sparse_stride_;
    if (at < i) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return data_ == nullptr ? nullptr : data_ + i * stride_;
}

float Accessor::component(std::uint64_t i, std::uint32_t k) const noexcept {
  const std::byte* at = element(i);
  if (at == nullptr) return 0;
  at += std::size_t{k} * component_size_;
  const auto as = [&]<class T>(T value, float greatest) {
    std::memcpy(&value, at, sizeof value);
    const auto number = static_cast<float>(value);
    return normalised_ ? std::max(number / greatest, -1.0f) : number;
  };
  switch (component_type_) {
    case kByte:
      return as(std::int8_t{}, 127);
    case kUnsignedByte:
      return as(std::uint8_t{}, 255);
    case kShort:
      return as(std::int16_t{}, 32767);
    case kUnsignedShort:
      return as(std::uint16_t{}, 65535);
    case kUnsignedInt:
      return as(std::uint32_t{}, 4294967295.0f);
    default: {
      float value;
      std::memcpy(&value, at, sizeof value);
      return value;
    }
  }
}

std::uint32_t Accessor::integer(std::uint64_t i) const noexcept {
  const std::byte* at = element(i);
  return at == nullptr ? 0 : read_index(at, component_size_);
}

Document::Document(Bytes bytes, const std::filesystem::path& folder) : folder_(folder) {
  const Container container = open_container(bytes);
  root_ = parse(container.json);
  if (!root_.is_object()) throw Error("is JSON, but not an object");
  const Json* asset = find(root_, "asset");
  const std::string version = asset != nullptr ? text_of(*asset, "version") : "";
  if (!version.starts_with("2.")) {
    throw Error(fmt::format("has glTF version '{}', expected 2.0", version.substr(0, 20)));
  }
  const Json::array_t& buffers = array_of(root_, "buffers");
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    try {
      buffers_.push_back(buffer(buffers[i], i, container.binary));
    } catch (const Error& error) {
      throw Error(fmt::format("buffer {} {}", i, error.what()));
    }
  }
  std::map<const std::byte*, std::size_t> distinct;
  for (const Bytes& buffer : buffers_) {
    std::size_t& size = distinct[buffer.data()];
    size = std::max(size, buffer.size());
  }
  for (const auto& [data, size] : distinct) buffer_bytes_ += size;
  sparse_budget_ = 64 * buffer_bytes_ + 65536;
}

Bytes Document::load(const std::string& uri) {
  if (const auto known = data_.find(uri); known != data_.end()) return known->second;
  if (auto data = decode_data_uri(uri)) return data_.emplace(uri, std::move(*data)).first->second;
  const std::filesystem::path path = find_uri(uri, folder_);
  const auto [place, added] = files_.try_emplace(path);
  if (added) place->second = load_file(path);
  return place->second;
}

std::vector<std::byte> Document::load_file(const std::filesystem::path& path) {
  std::error_code unknown;  // then reading says why
  const std::uintmax_t size = std::filesystem::file_size(path, unknown);
  if (!unknown && size > file_budget_) {
    throw Error(
        fmt::format("lies in '{}', which brings all files together over 4 GiB", path.filename().string()));
  }
  std::vector<std::byte> bytes = read_file(path);
  file_budget_ -= std::min<std::uint64_t>(bytes.size(), file_budget_);
  return bytes;
}

Bytes Document::image(std::uint64_t index) {
  const Json& description = at("images", index);
  if (find(description, "uri") != nullptr) return load(text_of(description, "uri"));
  std::uint64_t stride = 0;
  return buffer_view(whole_of(description, "bufferView"), stride);
}

Bytes Document::buffer(const Json& description, std::size_t index, Bytes binary_chunk) {
  const std::uint64_t length = whole_of(description, "byteLength");
  Bytes held;
  if (find(description, "uri") == nullptr) {
    if (index != 0) throw Error("has no URI, expected that of the first buffer of a GLB file alone");
    held = binary_chunk;
  } else {
    held = load(text_of(description, "uri"));
  }
  if (length > held.size())
    throw Error(fmt::format("says it is {} bytes long, but has {}", length, held.size()));
  return held.first(length);
}

const Json& Document::at(const char* kind, std::uint64_t index) const {
  const Json::array_t& all = array_of(root_, kind);
  if (index >= all.size()) {
    throw Error(fmt::format("refers to element {} of '{}', which has {}", index, kind, all.size()));
  }
  return all[index];
}

Bytes Document::buffer_view(std::uint64_t index, std::uint64_t& stride) const {
  const Json& view = at("bufferViews", index);
  const std::uint64_t buffer = whole_of(view, "buffer"), offset = whole_of(view, "byteOffset", 0),
                      length = whole_of(view, "byteLength");
  if (buffer >= buffers_.size())
    throw Error(fmt::format("refers to buffer {} of {}", buffer, buffers_.size()));
  if (!fits(offset, length, buffers_[buffer].size())) {
    throw Error(
        fmt::format("refers to bytes {} … +{} of a buffer of {}", offset, length, buffers_[buffer].size()));
  }
  stride = whole_of(view, "byteStride", 0);
  return buffers_[buffer].subspan(offset, length);
}

Accessor Document::make_accessor(const Json& description) {
  Accessor out;
  out.count_ = whole_of(description, "count");
  const std::uint64_t component = whole_of(description, "componentType");
  out.component_size_ = component_size(component);
  out.component_type_ = static_cast<std::uint32_t>(component);
  const ElementType& type = element_type(text_of(description, "type"));
  out.type_ = type.name;
  const Json* normalised = find(description, "normalized");
  out.normalised_ = normalised != nullptr && normalised->is_boolean() && normalised->get<bool>();
  const std::uint64_t element_size = std::uint64_t{out.component_size_} * type.components;
  if (const std::uint64_t view_index = whole_of(description, "bufferView", kNone); view_index != kNone) {
    const Bytes view = buffer_view(view_index, out.stride_);
    if (out.stride_ == 0) out.stride_ = element_size;
    if (out.stride_ < element_size) {
      throw Error(fmt::format("has a stride of {} bytes for elements of {}", out.stride_, element_size));
    }
    const std::uint64_t offset = whole_of(description, "byteOffset", 0);
    // Nothing here overflows: each number is below 2^32, so the product is below 2^64 - 2^33.
    if (out.count_ != 0 && !fits(offset, out.stride_ * (out.count_ - 1) + element_size, view.size())) {
      throw Error(fmt::format("has {} elements every {} bytes from byte {}, beyond its {} bytes", out.count_,
                              out.stride_, offset, view.size()));
    }
    out.data_ = view.data() + std::min<std::uint64_t>(offset, view.size());
  } else if (out.count_ > buffer_bytes_) {
    // Elements that no byte stands behind are all zero; a file can claim billions of them for free.
    throw Error(
        fmt::format("has {} elements without a buffer view, more than the file has bytes", out.count_));
  }
  if (const Json* sparse = find(description, "sparse")) read_sparse(*sparse, element_size, out);
  return out;
}

void Document::read_sparse(const Json& sparse, std::uint64_t element_size, Accessor& out) {
  const Json *indices = find(sparse, "indices"), *values = find(sparse, "values");
  if (indices == nullptr || values == nullptr) throw Error("is sparse, but lacks 'indices' or 'values'");
  const std::uint64_t count = whole_of(sparse, "count"), type = whole_of(*indices, "componentType");
  if (count > out.count_) throw Error(fmt::format("replaces {} of {} elements", count, out.count_));
  if (type != kUnsignedByte && type != kUnsignedShort && type != kUnsignedInt) {
    throw Error(fmt::format("has sparse indices of type {}, expected 5121, 5123 or 5125", type));
  }
  const std::uint32_t index_size = component_size(type);
  const auto place = [&](const Json& part, std::uint64_t size) {
    std::uint64_t stride = 0;
    const Bytes view = buffer_view(whole_of(part, "bufferView"), stride);
    const std::uint64_t offset = whole_of(part, "byteOffset", 0);
    if (!fits(offset, count * size, view.size())) throw Error("has sparse data beyond its buffer view");
    return view.data() + offset;
  };
  out.sparse_indices_ = place(*indices, index_size);
  out.sparse_values_ = place(*values, element_size);
  // Any number of accessors may name the same indices.
  if (count > sparse_budget_)
    throw Error("has more sparse indices than the file's size can stand for, those before it counted in");
  sparse_budget_ -= count;
  std::uint64_t next = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint32_t at = read_index(out.sparse_indices_ + i * index_size, index_size);
    if (at < next || at >= out.count_) throw Error("has sparse indices that do not ascend below its count");
    next = std::uint64_t{at} + 1;
  }
  out.sparse_count_ = count;
  out.sparse_index_size_ = index_size;
  out.sparse_stride_ = element_size;
}

const Accessor& Document::accessor(std::uint64_t index) {
  const auto found = accessors_.find(index);
  if (found != accessors_.end()) return found->second;
  try {
    return accessors_.emplace(index, make_accessor(at("accessors", index))).first->second;
  } catch (const Error& error) {
    throw Error(fmt::format("accessor {} {}", index, error.what()));
  }
}

}  // namespace sightline::io::gltf
