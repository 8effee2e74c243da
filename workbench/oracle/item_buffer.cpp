#include "workbench/oracle/item_buffer.hpp"

#include <algorithm>

namespace sightline::oracle {

std::size_t ItemBuffer::visible_count() const noexcept {
  return pixels.size() - static_cast<std::size_t>(std::count(pixels.begin(), pixels.end(), 0u));
}

}  // namespace sightline::oracle
