// Device methods beside the picture of another, which culls nothing unless one is named, and the rasteriser's
// item buffer, frame by frame.
#pragma once

#include <string>
#include <vector>

#include <sightline/workbench/method.hpp>
#include "device/fixtures.hpp"
#include "workbench/scene/random.hpp"

namespace sightline {

class Examination {
public:
  Examination(device::Device& device, Scene& scene, const std::vector<std::string>& specifications,
              const std::string& reference = "none")
      : scene_(scene),
        renderer_(device, scene),
        judge_(renderer_),
        all_(reference == "none"),
        reference_(make(reference)) {
    for (const std::string& specification : specifications) {
      methods_.push_back({specification, make(specification)});
    }
  }

  device::Renderer& renderer() { return renderer_; }

  /// Moves that share of the objects a little.
  void move(double share, scene::Random& random) {
    moved_.clear();
    const auto count = static_cast<std::uint32_t>(share * static_cast<double>(scene_.size()));
    for (std::uint32_t i = 0; i < count; ++i) {
      const ObjectId object = random.below(static_cast<std::uint32_t>(scene_.size()));
      if (std::ranges::find(moved_, object) != moved_.end()) continue;
      Affine transform = scene_.transform[object];
      for (Vec4& row : transform.rows) row.w += random.between(-1, 1);
      scene_.move_object(object, transform);
      moved_.push_back(object);
    }
    follow();
  }
  void move_to(ObjectId object, const Affine& transform) {
    scene_.move_object(object, transform);
    moved_ = {object};
    follow();
  }

  /// Every method's frame from the view: the same picture to the bit, and nothing lost of what is visible
  /// where the reference draws all.
  void look(const View& view, const std::string& where) {
    const oracle::ItemBuffer truth = judge_.render(view);
    visible_ += truth.visible_count();
    draw(*reference_, view);
    const device::Picture expected = renderer_.picture();
    for (auto& [name, method] : methods_) {
      draw(*method, view);
      const device::Picture picture = renderer_.picture();
      std::size_t different = 0;
      for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        different += picture.pixels[i] != expected.pixels[i];
      method->read_back(frame_);
      kept_ += frame_.visible.size();
      std::vector<std::uint8_t> kept(scene_.size());
      for (const ObjectId object : frame_.visible) kept[object] = 1;
      std::size_t lost = 0;
      for (ObjectId object = 0; object < scene_.size(); ++object)
        lost += all_ && truth.sees(object) && !kept[object];
      EXPECT_EQ(lost, 0u) << name << " lost objects " << where;
      EXPECT_EQ(different, 0u) << name << " drew another picture " << where;
    }
  }

  [[nodiscard]] std::uint64_t visible() const { return visible_; }
  [[nodiscard]] std::uint64_t kept() const { return kept_; }
  [[nodiscard]] const Frame& last_frame() const { return frame_; }

private:
  void follow() {
    renderer_.update(moved_);
    reference_->update(moved_);
    for (auto& [name, method] : methods_) method->update(moved_);
  }

  void draw(Method& method, const View& view) {
    renderer_.frame(view, [&](device::Recorder& recorder) {
      FrameContext context{view, frame_, &recorder};
      method.record(context);
    });
  }

  std::unique_ptr<Method> make(const std::string& specification) {
    return create_method(specification, MethodSite{scene_, &renderer_});
  }

  struct Examined {
    std::string name;
    std::unique_ptr<Method> method;
  };

  Scene& scene_;
  device::Renderer renderer_;
  oracle::RasterItemBuffer judge_;
  bool all_;  // the reference draws all
  std::unique_ptr<Method> reference_;
  std::vector<Examined> methods_;
  std::vector<ObjectId> moved_;
  Frame frame_;
  std::uint64_t visible_ = 0, kept_ = 0;
};

inline const std::vector<std::string> kOcclusionMethods{"roc",          "hroc",           "ioc", "ihzb",
                                                        "vertex-chunk", "resident-chunk", "hiz"};

}  // namespace sightline
