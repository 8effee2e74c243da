// From flags to draw commands on the device, against the plain loop on the host.
#include "workbench/device/visible_draws.hpp"

#include <map>
#include <random>
#include <utility>

#include "device/fixtures.hpp"

namespace sightline {
namespace {

using VisibleDrawsTest = DeviceTest;
using device::VisibleDraws;

constexpr std::uint32_t kMeshes = 3, kTransparent = 5;

/// Triangles of three meshes, every fifth a cut-out and every seventh drawn from its front alone, of these
/// every other mirrored; the last objects are transparent.
Scene triangles(std::uint32_t ordered) {
  Scene scene;
  const std::vector<Vec3> corners{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, normals(3, Vec3{0, 0, 1});
  for (std::uint32_t i = 0; i < kMeshes; ++i)
    scene.add_mesh(corners, normals, std::vector<std::uint32_t>{0, 1, 2});
  for (std::uint32_t i = 0; i < ordered + kTransparent; ++i) {
    const float mirror = i % 14 == 0 ? -1.0f : 1.0f;
    const Affine at{{Vec4{mirror, 0, 0, 0}, Vec4{0, 1, 0, 0}, Vec4{0, 0, 1, -5}}};
    const Surface surface = i >= ordered ? Surface::transparent
                            : i % 5 == 0 ? Surface::cut_out
                                         : Surface::opaque;
    scene.add_object(i * 11 % kMeshes, at, {surface, i % 7 == 0 ? Sides::front : Sides::both});
  }
  return scene;
}

using Batches = std::vector<std::vector<std::uint32_t>>;

/// What is listed, batch by batch.
Batches expected(const Scene& scene, const std::vector<std::uint32_t>& flags, VisibleDraws::Condition solid,
                 VisibleDraws::Condition rest) {
  std::map<std::pair<submission::DrawState, std::uint32_t>, std::vector<std::uint32_t>> batches;
  for (ObjectId o = 0; o < scene.size(); ++o) {
    const submission::DrawState state = submission::draw_state(scene, o);
    if (state == submission::DrawState::blended) continue;
    std::vector<std::uint32_t>& batch = batches[{state, scene.mesh[o]}];
    const VisibleDraws::Condition& condition = is_solid(state) ? solid : rest;
    if ((flags[o] & condition.mask) == condition.value) batch.push_back(o);
  }
  Batches out;
  for (const auto& [key, batch] : batches) out.push_back(batch);
  return out;
}

Batches listed(device::Device& device, const device::DrawBuffers& draws) {
  constexpr std::size_t kWords = sizeof(device::shared::CommandData) / 4;
  const std::uint32_t batches = draws.first_of(submission::DrawState::blended);
  const std::vector<std::uint32_t> commands = device::read_words(device, draws.commands, batches * kWords),
                                   list = device::read_words(device, draws.list, draws.list.size() / 4);
  Batches out;
  for (std::size_t batch = 0; batch < batches; ++batch) {
    const std::uint32_t count = commands[batch * kWords + 1], first = commands[batch * kWords + 4];
    EXPECT_LE(first + count, list.size());
    out.emplace_back(list.begin() + first, list.begin() + first + count);
  }
  return out;
}

TEST_F(VisibleDrawsTest, ListsWhatThePlainLoopListsWhateverTheCount) {
  // Words have 32 slots and blocks 2,048; beyond 64 blocks a lane adds up several.
  for (const std::uint32_t ordered : {0u, 1u, 31u, 32u, 33u, 2047u, 2048u, 2049u, 9024u, 140000u}) {
    SCOPED_TRACE(ordered);
    const Scene scene = triangles(ordered);
    device::Renderer renderer(device(), scene);
    const VisibleDraws& draws = renderer.draws();
    const device::DrawBuffers first = draws.make_buffers(device()), second = draws.make_buffers(device());
    std::vector<ObjectId> order(kTransparent);
    for (std::uint32_t i = 0; i < kTransparent; ++i) order[i] = ordered + kTransparent - 1 - i;
    const device::Buffer far_to_near = device::upload(device(), order, "an order");
    std::mt19937 random(ordered);
    for (const bool all : {false, true, false}) {
      std::vector<std::uint32_t> words(scene.size());
      for (std::uint32_t& word : words) word = all ? 7 : random() % 8;
      const device::Buffer flags = device::upload(device(), words, "flags");
      constexpr VisibleDraws::Condition kOdd{1, 1}, kSix{6, 6};
      const VisibleDraws::List odd{kOdd, kSix, &first}, six{kSix, {}, &second};
      renderer.frame(view_of({}, 16, 16), [&](device::Recorder& frame) {
        draws.build(frame, flags.address(), odd, far_to_near.address(), &six);
      });
      EXPECT_EQ(listed(device(), first), expected(scene, words, kOdd, kSix));
      EXPECT_EQ(listed(device(), second), expected(scene, words, kSix, {0, 1}));
      const std::uint32_t batches = first.first_of(submission::DrawState::blended);
      const std::vector<std::uint32_t> commands =
          device::read_words(device(), first.commands, (batches + kTransparent) * 5);
      const std::vector<std::uint32_t> list = device::read_words(device(), first.list, scene.size());
      for (std::uint32_t i = 0; i < kTransparent; ++i) {
        EXPECT_EQ(list[ordered + i], order[i]);
        EXPECT_EQ(commands[(batches + i) * 5 + 1], (words[order[i]] & 6) == 6 ? 1u : 0u);
      }
    }
  }
}

}  // namespace
}  // namespace sightline
