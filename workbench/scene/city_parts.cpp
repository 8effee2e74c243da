#include "workbench/scene/city_parts.hpp"

#include <initializer_list>

#include "workbench/scene/patterns.hpp"
#include "workbench/scene/shapes.hpp"

namespace sightline::scene {

namespace {

/// Boxes as one shape.
Shape boxes(std::initializer_list<Box> all) {
  Shape out;
  for (const Box& one : all) out.append(box(one));
  return out;
}

/// The shape turned a quarter about y: what looked along z looks along x.
Shape quarter_turned(Shape shape) {
  for (auto* vectors : {&shape.positions, &shape.normals}) {
    for (Vec3& v : *vectors) v = {v.z, v.y, -v.x};
  }
  return shape;
}

Shape crown() {
  Shape out = card(1, 1);
  out.append(quarter_turned(card(1, 1)));
  return out;
}

/// From the wall down to the street.
Shape awning() {
  Shape out = card(1, 1);
  for (Vec3& p : out.positions) p = {p.x, 0.5f * p.y, 0.5f - p.y};
  for (Vec3& n : out.normals) n = {0, 0.894427191f, 0.447213595f};
  return out;
}

/// A grate on three sides; its floor is part of it, where the pattern has a bar all along.
Shape balcony() {
  Shape out = card(1, 1, 8, 4);
  for (Vec3& p : out.positions) p.z = 0.5f;
  for (const float side : {-0.5f, 0.5f}) {
    Shape wing = quarter_turned(card(1, 1, 4, 4));
    for (Vec3& p : wing.positions) p.x = side;
    out.append(wing);
  }
  Shape floor = box({{-0.5f, -0.1f, -0.5f}, {0.5f, 0, 0.5f}});
  out.append(floor);
  return out;
}

}  // namespace

CityParts::CityParts(Scene& scene) : scene_(scene) {
  const std::uint32_t leaves = scene.add_alpha_image(leaves_pattern(128, 0.6f, 21));
  const std::uint32_t bars = scene.add_alpha_image(grate_pattern(32, 8, 2));
  const auto add_part = [&](const Shape& shape, const Material& material) {
    parts_.push_back(
        {scene.add_mesh(shape.positions, shape.normals, shape.indices, shape.texture_coordinates), material});
  };
  const Material solid{Surface::opaque, Sides::front}, sheet{Surface::opaque, Sides::both};
  const Box unit{{-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}};
  add_part(box({{-0.5f, -1, -0.5f}, {0.5f, 0, 0.5f}}), solid);  // ground
  add_part(box(unit), solid);                                   // tower
  add_part(box(unit), solid);                                   // roof
  add_part(card(1, 1), sheet);                                  // sign
  add_part(awning(), sheet);                                    // awning
  add_part(balcony(), {Surface::cut_out, Sides::both, bars});   // balcony
  add_part(card(1, 1), solid);                                  // billboard
  add_part(boxes({{{-0.08f, 0, -0.08f}, {0.08f, 5, 0.08f}}, {{-0.1f, 5, -0.1f}, {0.1f, 5.2f, 1.6f}}}), solid);
  add_part(boxes({{{-0.5f, 0.4f, -0.2f}, {0.5f, 0.5f, 0.2f}}, {{-0.5f, 0.5f, -0.25f}, {0.5f, 1, -0.2f}}}),
           solid);
  add_part(box({{-0.25f, 0, -0.25f}, {0.25f, 0.9f, 0.25f}}), solid);
  add_part(boxes({{{-0.5f, 0, -0.5f}, {0.5f, 2.4f, -0.48f}}, {{-0.5f, 2.4f, -0.5f}, {0.5f, 2.5f, 0.5f}}}),
           {Surface::transparent, Sides::both});
  add_part(boxes({{{-0.9f, 0.3f, -2.1f}, {0.9f, 0.9f, 2.1f}}, {{-0.8f, 0.9f, -1.2f}, {0.8f, 1.5f, 1.1f}}}),
           solid);
  add_part(card(1, 1, 6, 2), {Surface::cut_out, Sides::both, bars});  // fence
  add_part(card(1, 1), solid);                                        // hoarding
  add_part(box(unit), solid);                                         // trunk
  add_part(crown(), {Surface::cut_out, Sides::both, leaves});         // crown
}

void CityParts::add(CityPart part, const Affine& place) {
  const Part& of = parts_[static_cast<std::size_t>(part)];
  scene_.add_object(of.mesh, place, of.material);
}

}  // namespace sightline::scene
