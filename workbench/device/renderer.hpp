// Draws scenes off-screen. It knows no method: whoever culls records passes of its own between its draws.
#pragma once

#include <functional>
#include <optional>

#include <sightline/workbench/frame.hpp>
#include <sightline/workbench/held_scene.hpp>

#include "workbench/device/frame_times.hpp"
#include "workbench/device/recorder.hpp"
#include "workbench/device/scene_buffers.hpp"
#include "workbench/device/sent_list.hpp"
#include "workbench/device/visible_draws.hpp"

namespace sightline::device {

/// Which sides are culled of what is drawn in a state.
vk::CullModeFlagBits culled_in(submission::DrawState state) noexcept;

/// Of indirect draws, in bytes: a DrawCommand is what the device reads.
inline constexpr vk::DeviceSize kCommandSize = sizeof(DrawCommand);

class Renderer {
public:
  /// Copies the scene to the device. Scene and device outlive the renderer.
  Renderer(Device& device, const Scene& scene);

  [[nodiscard]] Device& device() const noexcept { return device_; }
  [[nodiscard]] const Scene& scene() const noexcept { return scene_; }
  [[nodiscard]] const SceneBuffers& buffers() const noexcept { return buffers_; }
  [[nodiscard]] const VisibleDraws& draws() const noexcept { return draws_; }

  /// Throws Error where objects or meshes were added to the scene since it was copied, as update() and
  /// frame() do.
  void require_same_scene() const { held_.require_same(); }

  /// Sends the new transforms of moved objects. Throws Error for an object that is not in the scene or has no
  /// finite bounds.
  void update(std::span<const ObjectId> moved);

  /// Records, submits and waits for a frame of the view's size. Throws Error for a view that does not pass
  /// check(). Depth and colour hold the last frame until they are cleared.
  FrameTimes frame(const View& view, const std::function<void(Recorder&)>& record,
                   Timed timed = Timed::frame);

  enum class Style : std::uint8_t { depth, lit };
  enum class Clear : std::uint8_t { nothing, colour, depth, both };
  /// Draws the solid objects of `draws` after clearing.
  void draw_solid(const Recorder& frame, const DrawBuffers& draws, Style style, Clear clear,
                  Recorder::Compare compare = Recorder::Compare::nearer_or_equal) const;
  /// The same with a pipeline of one's own and colour; its shaders find `extra` after the list's address.
  void draw_solid(const Recorder& frame, const DrawBuffers& draws, const GraphicsPipeline& pipeline,
                  vk::DeviceAddress extra, Recorder::Compare compare) const;
  /// Draws what hides nothing over the picture: first cut-outs, then the transparent objects, blended.
  void draw_rest(const Recorder& frame, const DrawBuffers& draws) const;
  /// All transparent objects, farthest first for the frame's view; 0 where there are none. Sorted when first
  /// asked for in a frame.
  [[nodiscard]] vk::DeviceAddress transparent_order();

  /// Draws what a CPU method hands over, in its order, which is by submission::DrawState: a cleared picture,
  /// then one multi-draw-indirect call a state, or each draw as a call of its own.
  void draw(const Recorder& frame, std::span<const ObjectId> visible, std::span<const DrawCommand> draws,
            bool one_by_one = false);

  /// The last frame's picture.
  [[nodiscard]] Picture picture() const;
  [[nodiscard]] std::vector<float> depth() const;

private:
  void resize(std::uint32_t width, std::uint32_t height);
  void sort_transparent(const View& view);
  /// Commands of one state, and who they draw.
  struct Commands {
    vk::Buffer buffer;
    std::uint32_t first, count;
    vk::DeviceAddress list;
    submission::DrawState state;
  };
  static Commands commands_of(const DrawBuffers& draws, submission::DrawState state) noexcept;
  void bind(const Recorder& frame, const GraphicsPipeline& pipeline, const Commands& commands,
            Recorder::Compare compare, vk::DeviceAddress extra) const;
  static void submit(const Recorder& frame, const Commands& commands);
  void draw_indirect(const Recorder& frame, const GraphicsPipeline& pipeline, const Commands& commands,
                     Recorder::Compare compare, vk::DeviceAddress extra) const;
  void bind_lit(const Recorder& frame, const Commands& commands) const;
  void draw_lit(const Recorder& frame, const Commands& commands) const;

  Device& device_;
  const Scene& scene_;
  HeldScene held_;
  SceneBuffers buffers_;
  VisibleDraws draws_;
  Box extent_;
  std::optional<Targets> targets_;
  Timer timer_;
  vk::raii::CommandBuffers commands_;
  Buffer view_buffer_, transparent_order_;
  SentList<ObjectId> host_list_;
  SentList<DrawCommand> host_commands_;
  vk::raii::DescriptorPool descriptors_;
  vk::raii::DescriptorSets view_set_;
  std::vector<std::uint64_t> sort_keys_;
  std::optional<View> unsorted_;  ///< the frame's view, until its transparent objects are sorted
  GraphicsPipeline depth_pipeline_, lit_pipeline_, cut_out_pipeline_, blend_pipeline_;
};

/// Writes a PNG, as io::write_file does. Throws Error where that cannot be.
void save_png(const Picture& picture, const std::string& path);

}  // namespace sightline::device
