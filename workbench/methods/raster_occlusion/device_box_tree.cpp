#include "workbench/methods/raster_occlusion/device_box_tree.hpp"

namespace sightline::methods {

DeviceBoxTree::DeviceBoxTree(device::Renderer& renderer) : renderer_(renderer), tree_(renderer.scene()) {
  device::Device& device = renderer.device();
  std::vector<device::shared::BoxData> boxes;
  for (std::uint32_t node = 0; node < tree_.total(); ++node) boxes.push_back(box_of(node));
  boxes_ = upload(device, boxes, "the tree's boxes");
  nodes_ = upload(device, tree_.nodes(), "the tree");
  children_ = upload(device, tree_.children(), "the tree");
  parents_ = upload(device, tree_.parents(), "the tree");
}

device::Buffer DeviceBoxTree::words() const {
  return {renderer_.device(), std::uint64_t{tree_.total()} * 4, device::Memory::device, "the tree's words"};
}

device::shared::BoxData DeviceBoxTree::box_of(std::uint32_t node) const {
  return node < tree_.interior() ? device::box_data(tree_.box(node), 0)
                                 : device::box_data(renderer_.scene(), node - tree_.interior());
}

void DeviceBoxTree::update(std::span<const ObjectId> moved) {
  tree_.refit(renderer_.scene(), moved, changed_);
  if (changed_.empty()) return;
  device::Device& device = renderer_.device();
  const std::size_t each = sizeof(device::shared::BoxData);
  if (staging_.size() < changed_.size() * each) {
    staging_ = device::Buffer(device, changed_.size() * each, device::Memory::upload, "moved boxes");
  }
  regions_.clear();
  for (std::size_t i = 0; i < changed_.size(); ++i) {
    staging_.mapped<device::shared::BoxData>()[i] = box_of(changed_[i]);
    regions_.push_back({i * each, changed_[i] * each, each});
  }
  device.run([&](const vk::raii::CommandBuffer& commands) {
    commands.copyBuffer(staging_.handle(), boxes_.handle(), regions_);
    device::full_barrier(commands);
  });
}

}  // namespace sightline::methods
