// A view that lost something, written and looked at again.
#include "workbench/measure/replay.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/io.hpp>

#include "support/temporary_folder.hpp"
#include "workbench/camera/random_views.hpp"
#include "workbench/io/text_file.hpp"

namespace sightline::measure {
namespace {

using test::TemporaryFolder;

constexpr const char* kScene = "world:forest?trees=300&size=100";

// Keeps every other object that is in view.
class Half final : public Method {
public:
  explicit Half(const Scene& scene) : Method(scene), all_(create_method("vfc-vc", scene)) {}
  [[nodiscard]] Guarantee guarantee() const noexcept override { return Guarantee::conservative; }

private:
  void do_update(std::span<const ObjectId> objects) override { all_->update(objects); }
  void do_record(FrameContext& context) override {
    all_->record(context);
    std::erase_if(context.output.visible, [](ObjectId object) { return object % 2 == 0; });
  }
  std::unique_ptr<Method> all_;
};

Replay first_loss(double moving) {
  Scene scene = load_scene(kScene);
  Bench bench(scene, std::vector<std::string>{});
  bench.add("half", std::make_unique<Half>(scene));
  const Verification seen = verify(bench, camera::random_cameras(scene, 20, 1), 64, 48, moving);
  Replay replay{kScene, "", "half", "cpu", RasterState::materials, moving, 0, {}};
  EXPECT_FALSE(seen.methods.front().examples.empty());
  replay.lost = seen.methods.front().examples.back();
  return replay;
}

WorldPoint nowhere(const Replay&) {
  return {};
}

TEST(Replay, LosesTheSameAgainFromItsFile) {
  for (const double moving : {0.0, 0.5}) {
    const TemporaryFolder folder;
    const Replay first = first_loss(moving);
    ASSERT_GT(first.lost.pixels, 0u);
    save_replay(folder / "loss.json", first);
    const Replay again = load_replay(folder / "loss.json", nowhere);
    EXPECT_EQ(again.scene, first.scene);
    EXPECT_EQ(again.lost.moves, first.lost.moves);
    Scene scene = load_scene(again.scene);
    Bench bench(scene, std::vector<std::string>{});
    bench.add("half", std::make_unique<Half>(scene));
    const MethodVerdict now = look_again(bench, again);
    EXPECT_EQ(now.lost_pixels, first.lost.pixels);
    ASSERT_FALSE(now.examples.empty());
    EXPECT_EQ(now.examples.front().object, first.lost.object);
    // Of objects that stand where they stood, something else is lost.
    if (moving > 0) {
      Replay still = again;
      still.lost.moves = 0;
      Scene unmoved = load_scene(again.scene);
      Bench other(unmoved, std::vector<std::string>{});
      other.add("half", std::make_unique<Half>(unmoved));
      EXPECT_NE(look_again(other, still).lost_pixels, first.lost.pixels);
    }
  }
}

TEST(Replay, RefusesWhatIsNone) {
  const TemporaryFolder folder;
  save_replay(folder / "loss.json", first_loss(0));
  const std::string whole = io::read_file(folder / "loss.json", 1 << 20);
  const auto refused = [&](const std::string& text) {
    io::write_file(folder / "wrong.json", text);
    EXPECT_THROW(static_cast<void>(load_replay(folder / "wrong.json", nowhere)), Error) << text;
  };
  for (std::size_t size = 0; size + 3 < whole.size(); size += 7) refused(whole.substr(0, size));
  for (const auto& [from, to] : {std::pair{"\"moving\": 0.0", "\"moving\": 2"},
                                 {"\"moves\": 0", "\"moves\": -1"},
                                 {"\"moves\": 0", "\"moves\": 99999999999"},
                                 {"\"materials\"", "\"moon\""},
                                 {"\"half\"", "7"},
                                 {"\"moves\": 0", "\"moves\": 0, \"movse\": 0"},
                                 {"\"object\": ", "\"object\": -"},
                                 {"\"object\": ", "\"object\": 1099511627776"},
                                 {"\"samples\": ", "\"samples\": 1."},
                                 {"\"size\": [", "\"size\": [1, "},
                                 {"\"views\": [", "\"views\": [{}, {}, "}}) {
    std::string text = whole;
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    refused(text.replace(at, std::string(from).size(), to));
  }
  EXPECT_THROW(static_cast<void>(load_replay(folder / "missing.json", nowhere)), Error);
  // As deep as a stack is not.
  const std::string deep = std::string(200'000, '[') + std::string(200'000, ']');
  for (const char* name : {"\"lost\": ", "\"size\": ", "\"views\": ", "\"samples\": "}) {
    const std::size_t at = whole.find(name) + std::string(name).size();
    io::write_file(folder / "wrong.json", whole.substr(0, at) + deep + ", \"was\": " + whole.substr(at));
    EXPECT_THROW(static_cast<void>(load_replay(folder / "wrong.json", nowhere)), Error) << name;
  }
}

}  // namespace
}  // namespace sightline::measure
