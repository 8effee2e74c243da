#include "workbench/oracle/triangle_judge.hpp"

#include <string>
#include <utility>

#include <sightline/workbench/error.hpp>

namespace sightline::oracle {

Scene one_object_a_triangle(const Scene& scene) {
  Scene out;
  out.name = scene.name;
  constexpr std::array<std::uint32_t, 3> kCorners{0, 1, 2};
  constexpr std::array<Vec3, 3> kNormals{Vec3{0, 1, 0}, Vec3{0, 1, 0}, Vec3{0, 1, 0}};
  for (ObjectId object = 0; object < scene.size(); ++object) {
    const Mesh& mesh = scene.meshes[scene.mesh[object]];
    for (std::uint32_t i = 0; i < mesh.index_count; i += 3) {
      std::array<Vec3, 3> corners;
      for (std::uint32_t c = 0; c < 3; ++c) {
        const std::uint32_t v = mesh.first_vertex + scene.indices[mesh.first_index + i + c];
        corners[c] = transform_point(scene.transform[object], scene.positions[v]);
      }
      if (mirrors(scene.transform[object])) std::swap(corners[1], corners[2]);
      out.add_object(out.add_mesh(corners, kNormals, kCorners), {},
                     {scene.surface[object], scene.sides[object]});
    }
  }
  return out;
}

TriangleJudge::Truth& TriangleJudge::truth(const View& view) {
  if (!truth_) {
    truth_ = std::make_unique<Truth>();
    truth_->triangles = one_object_a_triangle(scene_);
    truth_->judge.emplace(truth_->triangles);
    for (ObjectId object = 0; object < scene_.size(); ++object)
      owners_.insert(owners_.end(), scene_.triangles(object), object);
  }
  if (truth_->view != view) {
    truth_->image = truth_->judge->render(view);
    truth_->view = view;
  }
  return *truth_;
}

TriangleJudge::Verdict TriangleJudge::judge(const View& view, const TriangleGeometry& geometry,
                                            const Frame& frame) {
  Truth& all = truth(view);
  submitted_.assign(owners_.size(), 0);
  for (const DrawCommand& draw : frame.draws) {
    const std::size_t first = draw.first_instance, end = first + draw.index_count / 3;
    if (draw.first_index != 3 * first || draw.vertex_offset != 0 || end > geometry.sources.size())
      throw Error("draw commands: a range of triangles " + std::to_string(first) + " to " +
                  std::to_string(end) + " is not one of the method's " +
                  std::to_string(geometry.sources.size()));
    for (std::size_t t = first; t < end; ++t) submitted_[geometry.sources[t]] = 1;
  }
  std::vector<ObjectId> lost;
  std::vector<std::uint8_t> sees(scene_.size(), 0);
  for (std::uint32_t t = 0; t < owners_.size(); ++t) {
    if (!all.image.sees(t)) continue;
    sees[owners_[t]] = 1;
    if (!submitted_[t]) lost.push_back(t);
  }
  Verdict verdict;
  const std::vector<std::uint32_t> confirmed = all.judge->confirmed_pixels(view, all.image, lost);
  for (std::size_t i = 0; i < lost.size(); ++i) {
    if (confirmed[i] == 0) continue;
    verdict.loss.lost_pixels += confirmed[i];
    const ObjectId owner = owners_[lost[i]];
    if (verdict.loss.lost.empty() || verdict.loss.lost.back() != owner) verdict.loss.lost.push_back(owner);
  }
  std::vector<std::uint8_t> kept(scene_.size(), 0);
  for (const ObjectId object : frame.visible) kept[object] = 1;
  for (ObjectId object = 0; object < scene_.size(); ++object) {
    verdict.truly_visible += sees[object];
    if (kept[object] && !sees[object]) verdict.loss.excess.push_back(object);
  }
  return verdict;
}

}  // namespace sightline::oracle
