// OpenSceneGraph's cull traversal over a tree of groups of up to 16, split along the longest axis, with three
// kinds of leaf: nodes of our own that only note their id, which is the least a traversal can do; drawables
// that stand in world space; and drawables under a transform each, which is how things that move are built.
#include <benchmark/benchmark.h>
#include <osg/Drawable>
#include <osg/Group>
#include <osg/MatrixTransform>
#include <osgUtil/CullVisitor>

#include <algorithm>
#include <numeric>

#include "judged.hpp"
#include "world_case.hpp"

namespace sightline::benchmarks {
namespace {

std::vector<ObjectId> collected;

class Leaf : public osg::Node {
public:
  Leaf(ObjectId id, const Box& box) : id_(id) {
    const osg::BoundingBox bounds(box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z);
    setInitialBound(osg::BoundingSphere(bounds));
  }
  void traverse(osg::NodeVisitor&) override { collected.push_back(id_); }

private:
  ObjectId id_;
};

class Thing : public osg::Drawable {
public:
  Thing(ObjectId id, const osg::BoundingBox& bounds) : id(id) {
    setInitialBound(bounds);
    setUseDisplayList(false);
  }
  void drawImplementation(osg::RenderInfo&) const override {}
  const ObjectId id;
};

enum class Kind { note, drawable, transformed };

osg::ref_ptr<osg::Node> leaf_of(ObjectId id, const Box& box, Kind kind) {
  if (kind == Kind::note) return new Leaf(id, box);
  const osg::Vec3 low(box.min.x, box.min.y, box.min.z), high(box.max.x, box.max.y, box.max.z);
  if (kind == Kind::drawable) return new Thing(id, osg::BoundingBox(low, high));
  const osg::Vec3 centre = (low + high) * 0.5f;
  osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(osg::Matrix::translate(centre));
  transform->addChild(new Thing(id, osg::BoundingBox(low - centre, high - centre)));
  return transform;
}

osg::ref_ptr<osg::Node> tree_of(const Boxes& boxes, std::span<ObjectId> ids, Kind kind) {
  osg::ref_ptr<osg::Group> group = new osg::Group;
  if (ids.size() <= 16) {
    for (const ObjectId id : ids) group->addChild(leaf_of(id, boxes[id], kind));
    return group;
  }
  std::array<float, 3> low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
  const auto at = [&](ObjectId id, int a) {
    return a == 0 ? boxes.min_x[id] : a == 1 ? boxes.min_y[id] : boxes.min_z[id];
  };
  for (const ObjectId id : ids) {
    for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], at(id, a)), high[a] = std::max(high[a], at(id, a));
  }
  int axis = 0;
  for (int a = 1; a < 3; ++a) {
    if (high[a] - low[a] > high[axis] - low[axis]) axis = a;
  }
  const std::size_t half = ids.size() / 2;
  std::nth_element(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(half), ids.end(),
                   [&](ObjectId a, ObjectId b) { return at(a, axis) < at(b, axis); });
  group->addChild(tree_of(boxes, ids.first(half), kind));
  group->addChild(tree_of(boxes, ids.subspan(half), kind));
  return group;
}

void take_things(const osgUtil::StateGraph& graph) {
  for (const auto& leaf : graph._leaves) {
    collected.push_back(static_cast<const Thing*>(leaf->_drawable.get())->id);
  }
}

void openscenegraph(benchmark::State& state, Kind kind) {
  const Case& c = case_of(1'000'000);
  std::vector<ObjectId> ids(c.flat.size());
  std::iota(ids.begin(), ids.end(), 0u);
  const osg::ref_ptr<osg::Node> root = tree_of(c.flat, ids, kind);
  root->getBound();
  const View view = looking(0.3f, tenth_of_view());
  const osg::Matrix to_eye(view.world_to_eye.m.data());
  osg::Matrix projection(view.eye_to_clip.m.data());
  // Its clip depth is -1 to 1.
  for (int column = 0; column < 4; ++column)
    projection(column, 2) = 2 * projection(column, 2) - projection(column, 3);
  osg::ref_ptr<osgUtil::CullVisitor> visitor = new osgUtil::CullVisitor;
  osg::ref_ptr<osgUtil::StateGraph> graph = new osgUtil::StateGraph;
  osg::ref_ptr<osgUtil::RenderStage> stage = new osgUtil::RenderStage;
  visitor->setStateGraph(graph);
  visitor->setRenderStage(stage);
  visitor->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
  visitor->setCullingMode(osg::CullSettings::VIEW_FRUSTUM_CULLING | osg::CullSettings::NEAR_PLANE_CULLING |
                          osg::CullSettings::FAR_PLANE_CULLING);
  for (auto _ : state) {
    collected.clear();
    visitor->reset();
    graph->clean();
    stage->reset();
    visitor->setStateGraph(graph);
    visitor->setRenderStage(stage);
    visitor->pushViewport(new osg::Viewport(0, 0, 1280, 720));
    visitor->pushProjectionMatrix(new osg::RefMatrix(projection));
    visitor->pushModelViewMatrix(new osg::RefMatrix(to_eye), osg::Transform::ABSOLUTE_RF);
    root->accept(*visitor);
    visitor->popModelViewMatrix();
    visitor->popProjectionMatrix();
    visitor->popViewport();
  }
  if (kind != Kind::note) {
    take_things(*graph);
    for (const auto& [set, child] : graph->_children) take_things(*child);
  }
  judge(state, c.flat, {&view, 1}, collected);
}
BENCHMARK_CAPTURE(openscenegraph, nodes_that_note_their_id, Kind::note)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(openscenegraph, drawables, Kind::drawable)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(openscenegraph, drawables_under_transforms, Kind::transformed)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sightline::benchmarks
