// Small scenes of cards: cut-outs before boxes, a grate before a room, and single- and double-sided cards.
// Each says where to look from; from there the things behind are seen through or past the cards.
#include <array>

#include "workbench/scene/patterns.hpp"
#include "workbench/scene/shapes.hpp"
#include "workbench/scene/worlds.hpp"

namespace sightline::scene {

namespace {

constexpr std::array kCardsParameters{ParameterInfo{
    "show", "cards of leaves before boxes, a grate before a room, or cards with and without backs", "leaves",
    0, 0, false, "leaves|grate|sides"}};

std::uint32_t add(Scene& scene, const Shape& shape) {
  return scene.add_mesh(shape.positions, shape.normals, shape.indices, shape.texture_coordinates);
}

Affine at(float x, float y, float z) {
  return {{Vec4{1, 0, 0, x}, Vec4{0, 1, 0, y}, Vec4{0, 0, 1, z}}};
}

/// At a place and turned half round about y, so that its back is where its front was.
Affine turned_at(float x, float y, float z) {
  return {{Vec4{-1, 0, 0, x}, Vec4{0, 1, 0, y}, Vec4{0, 0, -1, z}}};
}

/// At a place and mirrored in x.
Affine mirrored_at(float x, float y, float z) {
  return {{Vec4{-1, 0, 0, x}, Vec4{0, 1, 0, y}, Vec4{0, 0, 1, z}}};
}

/// A floor from -8 to 8, and three boxes of 1 m on it at z = -4.
void add_boxes_on_a_floor(Scene& scene) {
  scene.add_object(add(scene, box({{-8, -0.5f, -8}, {8, 0, 8}})), {});
  const std::uint32_t cube = add(scene, box({{-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}}));
  for (const float x : {-1.5f, 0.0f, 1.5f}) scene.add_object(cube, at(x, 0, -4));
}

/// Objects 0 … 3 a floor and three boxes, 4 … 6 cards of leaves before them, drawn on both sides; the middle
/// one without an image, which is drawn whole. From in front and from behind.
Scene leaf_cards() {
  Scene scene;
  add_boxes_on_a_floor(scene);
  const std::uint32_t leaves = scene.add_alpha_image(leaves_pattern(64, 0.5f, 1));
  const std::uint32_t sheet = add(scene, card(1.6f, 2));
  scene.add_object(sheet, at(-1.5f, 0, -1), {Surface::cut_out, Sides::both, leaves});
  scene.add_object(sheet, at(0, 0, -1), {Surface::cut_out, Sides::both});
  scene.add_object(sheet, turned_at(1.5f, 0, -1), {Surface::cut_out, Sides::both, leaves, 200});
  scene.viewpoints.push_back({"front", {0, 0.8f, 3}, {0, 0, -1}});
  scene.viewpoints.push_back({"behind", {0, 0.8f, -7}, {0, 0, 1}});
  return scene;
}

/// Objects 0 … 3 a floor and three boxes, 4 … 7 the walls and the lintel of a doorway before them, 8 the
/// grate in it, 9 a pane of glass behind the grate.
Scene grate_before_a_room() {
  Scene scene;
  add_boxes_on_a_floor(scene);
  for (const Box& wall : {Box{{-8, 0, -1}, {-1, 4, -0.8f}}, Box{{1, 0, -1}, {8, 4, -0.8f}},
                          Box{{-1, 2, -1}, {1, 4, -0.8f}}, Box{{-8, 0, -8}, {8, 4, -7.8f}}}) {
    scene.add_object(add(scene, box(wall)), {}, {Surface::opaque, Sides::front});
  }
  const std::uint32_t bars = scene.add_alpha_image(grate_pattern(32, 16, 4));
  scene.add_object(add(scene, card(2, 2, 4, 4)), at(0, 0, -0.9f), {Surface::cut_out, Sides::both, bars});
  scene.add_object(add(scene, card(2, 2)), at(0, 0, -1.2f), Surface::transparent);
  scene.viewpoints.push_back({"before the grate", {0, 1, 3}, {0, 0, -1}});
  scene.viewpoints.push_back({"at the grate", {0.3f, 1, -0.5f}, {0, 0, -1}});
  scene.viewpoints.push_back({"in the room", {0, 1, -7}, {0, 0, 1}});
  return scene;
}

/// Objects 0 … 3 a floor and three boxes; before each box an opaque card that could hide it: 4 single-sided,
/// its back to the front view; 5 double-sided, its back to it too; 6 single-sided and mirrored, its front to
/// it. From in front box 1 is seen, boxes 2 and 3 are not, and neither is card 4; from behind card 6 is not.
Scene sided_cards() {
  Scene scene;
  add_boxes_on_a_floor(scene);
  const std::uint32_t sheet = add(scene, card(1.6f, 2));
  scene.add_object(sheet, turned_at(-1.5f, 0, -3), {Surface::opaque, Sides::front});
  scene.add_object(sheet, turned_at(0, 0, -3), {Surface::opaque, Sides::both});
  scene.add_object(sheet, mirrored_at(1.5f, 0, -3), {Surface::opaque, Sides::front});
  scene.viewpoints.push_back({"front", {0, 0.6f, 6}, {0, 0, -1}});
  scene.viewpoints.push_back({"behind", {0, 0.6f, -8}, {0, 0, 1}});
  return scene;
}

Scene make_cards(const Parameters& parameters) {
  const std::string_view show = parameters.word("show");
  if (show == "grate") return grate_before_a_room();
  return show == "sides" ? sided_cards() : leaf_cards();
}

}  // namespace

extern const WorldInfo kCardsWorld{"cards", "cut-outs and single-sided cards before a few boxes",
                                   kCardsParameters, make_cards};

}  // namespace sightline::scene
