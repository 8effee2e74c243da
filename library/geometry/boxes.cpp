#include <sightline/boxes.hpp>

namespace sightline {

void Boxes::set(std::size_t i, const Box& box) noexcept {
  min_x[i] = box.min.x, min_y[i] = box.min.y, min_z[i] = box.min.z;
  max_x[i] = box.max.x, max_y[i] = box.max.y, max_z[i] = box.max.z;
}

void Boxes::push_back(const Box& box) {
  resize(size() + 1);
  set(size() - 1, box);
}

void Boxes::resize(std::size_t count) {
  for (auto* array : {&min_x, &min_y, &min_z, &max_x, &max_y, &max_z}) array->resize(count);
}

void Boxes::reserve(std::size_t count) {
  for (auto* array : {&min_x, &min_y, &min_z, &max_x, &max_y, &max_z}) array->reserve(count);
}

}  // namespace sightline
