#include "workbench/oracle/pixel_coverage.hpp"

namespace sightline::oracle {

std::vector<std::uint8_t> objects_that_cover(const ItemBuffer& image, std::uint32_t width,
                                             std::uint32_t height) {
  std::vector<std::uint8_t> found(image.pixels.size(), 0);
  // For each column, how many rows in a row end in a run of `width` pixels of one object, the same one.
  std::vector<std::uint32_t> rows(image.width, 0);
  std::vector<ObjectId> of(image.width, kNoObject);
  for (std::uint32_t y = 0; y < image.height; ++y) {
    const ObjectId* row = image.ids.data() + std::size_t{y} * image.width;
    std::uint32_t run = 0;
    for (std::uint32_t x = 0; x < image.width; ++x) {
      run = x > 0 && row[x] == row[x - 1] ? run + 1 : 1;
      const bool whole = run >= width && row[x] != kNoObject;
      rows[x] = !whole ? 0 : row[x] == of[x] ? rows[x] + 1 : 1;
      of[x] = whole ? row[x] : kNoObject;
      if (rows[x] >= height) found[row[x]] = 1;
    }
  }
  return found;
}

}  // namespace sightline::oracle
