// The contract of all culling methods, on the CPU and on a Vulkan device, and the registry that finds them.
// To add one: a folder under methods/, a line in the registry, a page in docs/methods/.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include <sightline/occlusion.hpp>
#include <sightline/view.hpp>
#include <sightline/workbench/frame.hpp>
#include <sightline/workbench/held_scene.hpp>
#include <sightline/workbench/parameters.hpp>
#include <sightline/workbench/scene.hpp>
#include <sightline/workbench/triangle_draws.hpp>

namespace sightline {

namespace device {
class Recorder;
class Renderer;
}  // namespace device

enum class Guarantee : std::uint8_t {
  exact,         ///< the image equals the image drawn without culling
  conservative,  ///< never loses an object that has a visible pixel
  approximate,   ///< may lose something, so how much is always reported
};

std::string_view to_string(Guarantee guarantee) noexcept;

/// One frame: the view to be culled, where the answer goes, and on a device what records the commands.
struct FrameContext {
  const View& view;
  Frame& output;                         ///< reused frame after frame
  device::Recorder* recorder = nullptr;  ///< null on the CPU: culled, not drawn
};

/// One culling method at work on one scene. Scene and renderer outlive the method.
///
/// It works on the objects that the scene held when it was made, wherever they move. Once objects or meshes
/// are added to the scene or taken out, update() and record() throw Error, whatever the method: make it anew.
class Method {
public:
  virtual ~Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;

  /// With the parameters it was made with.
  [[nodiscard]] virtual Guarantee guarantee() const noexcept = 0;
  /// Of which places on the image that speaks: of any, or of pixel centres alone.
  [[nodiscard]] virtual Coverage coverage() const noexcept { return Coverage::area; }
  /// Told after Scene::move_object (and on a device Renderer::update) of each of `objects`, before the next
  /// frame. Throws Error, and changes nothing, for an object that is not in the scene or has no finite
  /// bounds.
  void update(std::span<const ObjectId> objects);
  /// Culls the view. On the CPU fills the output with what to draw; on a device records culling and drawing
  /// in named passes, and what is left in the targets is the picture. The same calls with the same views,
  /// scene and times told by report_frame_time() give the same answers, in the same order. Allocates nothing
  /// once output and method have grown to their sizes. Throws Error for a view that does not pass check().
  void record(FrameContext& context);
  /// Fills in what only the device knows once the last frame is finished: what it drew, ascending by id, and
  /// its counts. Not part of a frame, for checking. Does nothing where record() has said it all.
  virtual void read_back([[maybe_unused]] Frame& output) {}
  /// Told, where the caller knows, how long the last frame took, from the beginning of culling to the
  /// finished picture: methods that choose among ways of drawing go by it. Allocates nothing.
  virtual void report_frame_time([[maybe_unused]] double milliseconds) noexcept {}
  /// The triangles that the output's draws are ranges of, for a method that draws triangles instead of
  /// objects; null where draws are ranges of the scene's own meshes. Valid until update() or the method's
  /// end.
  [[nodiscard]] virtual const TriangleGeometry* geometry() const noexcept { return nullptr; }

protected:
  explicit Method(const Scene& scene) : scene_(scene), held_(scene, "method") {}

  const Scene& scene_;

private:
  /// update() and record(), once their arguments are known to be sound. On the CPU throws nothing.
  virtual void do_update(std::span<const ObjectId> objects) = 0;
  virtual void do_record(FrameContext& context) = 0;

  HeldScene held_;
};

/// Culls on the CPU: record() without a device.
inline void cull(Method& method, const View& view, Frame& output) {
  FrameContext context{view, output};
  method.record(context);
}

/// Where a method works: on a scene, and on a device where there is a renderer, which holds a copy of the
/// scene.
struct MethodSite {
  const Scene& scene;
  device::Renderer* renderer = nullptr;
};

/// A method as it runs on the CPU or on a device; without `create` there is no such form.
struct MethodForm {
  Guarantee guarantee = Guarantee::approximate;  ///< with default parameters
  std::span<const ParameterInfo> parameters;
  std::unique_ptr<Method> (*create)(const MethodSite&, const Parameters&) = nullptr;
  std::string_view needs = {};           ///< "" or what the scene or the device must have, in words
  bool (*fits)(const Scene&) = nullptr;  ///< whether the scene has it; null: any does

  [[nodiscard]] bool exists() const noexcept { return create != nullptr; }
  [[nodiscard]] bool suits(const Scene& scene) const { return exists() && (!fits || fits(scene)); }
};

struct MethodInfo {
  std::string_view name;
  std::string_view paper;            ///< where it was published
  std::string_view summary;          ///< what it does, one line
  MethodForm cpu = {}, device = {};  ///< at least one of them
};

/// All methods, in the order of the documentation.
std::span<const MethodInfo> all_methods() noexcept;

/// Finds by name; null where there is none.
const MethodInfo* find_method(std::string_view name) noexcept;

/// Makes a method from "NAME" or "NAME?key=value&…" in its form for the CPU. Throws Error for unknown names,
/// keys, values, an invalid scene, or one that lacks what the method needs.
std::unique_ptr<Method> create_method(std::string_view specification, const Scene& scene);
/// The same at a site. On a device: the form for it where there is one, else the one for the CPU, drawn by
/// the renderer. Throws Error where the device lacks something or its memory runs out.
std::unique_ptr<Method> create_method(std::string_view specification, const MethodSite& site);

}  // namespace sightline
