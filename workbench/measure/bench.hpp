// A scene with the methods under examination, on the CPU or on a Vulkan device, and the oracle that judges
// them.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <sightline/workbench/method.hpp>

#include "workbench/device/frame_times.hpp"
#include "workbench/oracle/oracle.hpp"

namespace sightline::measure {

/// A method under examination, with the name it is reported by.
struct Subject {
  std::string name;  ///< the specification it was made from: "vfc-vc?contribution=off"
  std::unique_ptr<Method> method;
  Frame frame = {};  ///< its last answer
};

class Bench {
public:
  /// On the CPU, or on a device where one is given. Scene and device outlive the bench. On the CPU `samples`
  /// places of each pixel are judged, for 0 its centre. Throws Error for a method that does not exist or does
  /// not fit, and for samples on a device.
  Bench(Scene& scene, std::span<const std::string> specifications, device::Device* device = nullptr,
        std::uint32_t samples = 0);
  ~Bench();

  [[nodiscard]] Scene& scene() noexcept { return scene_; }
  [[nodiscard]] const Scene& scene() const noexcept { return scene_; }
  [[nodiscard]] std::span<Subject> subjects() noexcept { return subjects_; }
  [[nodiscard]] std::span<const Subject> subjects() const noexcept { return subjects_; }
  /// Whether places of pixels are judged other than their centres.
  [[nodiscard]] bool judges_samples() const noexcept { return samples_ > 0; }
  [[nodiscard]] oracle::Oracle& oracle() noexcept { return *oracle_; }
  /// Null on the CPU.
  [[nodiscard]] device::Renderer* renderer() noexcept { return renderer_.get(); }
  /// "cpu", or the device's name.
  [[nodiscard]] std::string device_name() const;

  /// Adds a method that is in no registry; on a device it is drawn there.
  Subject& add(std::string name, std::unique_ptr<Method> method);
  void remove_last() { subjects_.pop_back(); }

  /// One frame of one subject, which is told what it took unless passes were timed, too; on the CPU it is
  /// culled alone.
  device::FrameTimes run(Subject& subject, const View& view, device::Timed timed = device::Timed::frame);
  /// What the subject's last frame was worth, which was of this view. With `picture`, on a device, its
  /// picture is compared, too; the next picture is drawn anew in any case.
  enum class Compare : std::uint8_t { sets, pictures };
  oracle::Judgement judge(Subject& subject, const View& view, Compare what = Compare::sets);

  /// Tells everybody who holds a copy that these objects have moved.
  void update(std::span<const ObjectId> moved);

private:
  Scene& scene_;
  std::uint32_t samples_;
  std::unique_ptr<device::Renderer> renderer_;
  std::unique_ptr<oracle::Oracle> oracle_;
  std::vector<Subject> subjects_;
};

/// Names of all methods that can work on the scene, on the CPU or on a device.
std::vector<std::string> fitting_methods(const Scene& scene, bool on_device = false);

/// Of those, the ones that promise something that can be held against them: exact or conservative. On a
/// device, those with a form of their own for it: drawing what others keep proves less.
std::vector<std::string> promising_methods(const Scene& scene, bool on_device = false);

}  // namespace sightline::measure
