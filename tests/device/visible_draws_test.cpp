// From flags to draw commands on the device, against the plain loop on the host.
#include "workbench/device/visible_draws.hpp"

#include <random>

#include "device/fixtures.hpp"

namespace sightline {
namespace {

using VisibleDrawsTest = DeviceTest;
using device::VisibleDraws;

constexpr std::uint32_t kMeshes = 3, kTransparent = 5;

/// Triangles of three meshes; the last objects are transparent.
Scene triangles(std::uint32_t opaque) {
  Scene scene;
  const std::vector<Vec3> corners{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, normals(3, Vec3{0, 0, 1});
  for (std::uint32_t i = 0; i < kMeshes; ++i)
    scene.add_mesh(corners, normals, std::vector<std::uint32_t>{0, 1, 2});
  Affine at;
  at.rows = {Vec4{1, 0, 0, 0}, Vec4{0, 1, 0, 0}, Vec4{0, 0, 1, -5}};
  for (std::uint32_t i = 0; i < opaque + kTransparent; ++i) {
    scene.add_object(i * 7 % kMeshes, at, i < opaque ? Surface::opaque : Surface::transparent);
  }
  return scene;
}

/// What is listed, mesh by mesh.
std::vector<std::vector<std::uint32_t>> expected(const Scene& scene, const std::vector<std::uint32_t>& flags,
                                                 VisibleDraws::Condition condition) {
  std::vector<std::vector<std::uint32_t>> of_mesh(kMeshes);
  for (ObjectId o = 0; o < scene.size(); ++o) {
    const bool listed = (flags[o] & condition.mask) == condition.value;
    if (listed && scene.surface[o] == Surface::opaque) of_mesh[scene.mesh[o]].push_back(o);
  }
  return of_mesh;
}

std::vector<std::vector<std::uint32_t>> listed(device::Device& device, const device::DrawBuffers& draws) {
  constexpr std::size_t kWords = sizeof(device::shared::CommandData) / 4;
  const std::vector<std::uint32_t> commands = device::read_words(device, draws.commands, kMeshes * kWords),
                                   list = device::read_words(device, draws.list, draws.list.size() / 4);
  std::vector<std::vector<std::uint32_t>> of_mesh;
  for (std::size_t mesh = 0; mesh < kMeshes; ++mesh) {
    const std::uint32_t count = commands[mesh * kWords + 1], first = commands[mesh * kWords + 4];
    EXPECT_LE(first + count, list.size());
    of_mesh.emplace_back(list.begin() + first, list.begin() + first + count);
  }
  return of_mesh;
}

TEST_F(VisibleDrawsTest, ListsWhatThePlainLoopListsWhateverTheCount) {
  // Words have 32 slots and blocks 2,048; beyond 64 blocks a lane adds up several.
  for (const std::uint32_t opaque : {0u, 1u, 31u, 32u, 33u, 2047u, 2048u, 2049u, 9024u, 140000u}) {
    SCOPED_TRACE(opaque);
    const Scene scene = triangles(opaque);
    device::Renderer renderer(device(), scene);
    const VisibleDraws& draws = renderer.draws();
    const device::DrawBuffers first = draws.make_buffers(device()), second = draws.make_buffers(device());
    std::vector<ObjectId> order(kTransparent);
    for (std::uint32_t i = 0; i < kTransparent; ++i) order[i] = opaque + kTransparent - 1 - i;
    const device::Buffer far_to_near = device::upload(device(), order, "an order");
    std::mt19937 random(opaque);
    for (const bool all : {false, true, false}) {
      std::vector<std::uint32_t> words(scene.size());
      for (std::uint32_t& word : words) word = all ? 7 : random() % 8;
      const device::Buffer flags = device::upload(device(), words, "flags");
      constexpr VisibleDraws::Condition kOdd{1, 1}, kSix{6, 6};
      const VisibleDraws::List odd{kOdd, kSix, &first}, six{kSix, {}, &second};
      renderer.frame(view_of({}, 16, 16), [&](device::Recorder& frame) {
        draws.build(frame, flags.address(), odd, far_to_near.address(), &six);
      });
      EXPECT_EQ(listed(device(), first), expected(scene, words, kOdd));
      EXPECT_EQ(listed(device(), second), expected(scene, words, kSix));
      const std::vector<std::uint32_t> commands =
          device::read_words(device(), first.commands, (kMeshes + kTransparent) * 5);
      const std::vector<std::uint32_t> list = device::read_words(device(), first.list, scene.size());
      for (std::uint32_t i = 0; i < kTransparent; ++i) {
        EXPECT_EQ(list[opaque + i], order[i]);
        EXPECT_EQ(commands[(kMeshes + i) * 5 + 1], (words[order[i]] & 6) == 6 ? 1u : 0u);
      }
    }
  }
}

}  // namespace
}  // namespace sightline
