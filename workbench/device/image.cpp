#include "workbench/device/image.hpp"

#include <fmt/format.h>

#include <sightline/workbench/error.hpp>

namespace sightline::device {

Image::Image(Device& device, vk::Format format, std::uint32_t width, std::uint32_t height,
             std::string_view what) try
    : device_(device),
      width_(width),
      height_(height),
      layout_(format == kDepthFormat ? vk::ImageLayout::eDepthAttachmentOptimal
                                     : vk::ImageLayout::eColorAttachmentOptimal),
      aspect_(format == kDepthFormat ? vk::ImageAspectFlagBits::eDepth : vk::ImageAspectFlagBits::eColor) {
  const std::uint32_t limit =
      std::min(device.limits().maxImageDimension2D, device.limits().maxFramebufferWidth);
  if (width == 0 || height == 0 || width > limit || height > limit) {
    throw Error(fmt::format("device '{}': no image of {} x {} pixels for {}, expected 1 to {} a side",
                            device.info().name, width, height, what, limit));
  }
  using Usage = vk::ImageUsageFlagBits;
  const auto usage =
      (format == kDepthFormat ? Usage::eDepthStencilAttachment | Usage::eSampled : Usage::eColorAttachment) |
      Usage::eTransferSrc;
  image_.emplace(device.handle(), vk::ImageCreateInfo{{},
                                                      vk::ImageType::e2D,
                                                      format,
                                                      {width, height, 1},
                                                      1,
                                                      1,
                                                      vk::SampleCountFlagBits::e1,
                                                      vk::ImageTiling::eOptimal,
                                                      usage});
  memory_ = device.memory().take(image_->getMemoryRequirements(), vk::MemoryPropertyFlagBits::eDeviceLocal,
                                 {}, MemoryPool::For::images, what);
  image_->bindMemory(memory_.memory(), memory_.offset());
  view_.emplace(
      device.handle(),
      vk::ImageViewCreateInfo{{}, **image_, vk::ImageViewType::e2D, format, {}, {aspect_, 0, 1, 0, 1}});
  device.run([&](const vk::raii::CommandBuffer& commands) {
    move_to(commands, vk::ImageLayout::eUndefined, layout_);
  });
} catch (const vk::SystemError& error) {
  throw Error(fmt::format("device: no image for {}: {}", what, error.what()));
}

void Image::move_to(const vk::raii::CommandBuffer& commands, vk::ImageLayout from, vk::ImageLayout to) const {
  const auto all = vk::PipelineStageFlagBits2::eAllCommands;
  const auto access = vk::AccessFlagBits2::eMemoryRead | vk::AccessFlagBits2::eMemoryWrite;
  const vk::ImageMemoryBarrier2 barrier{all,
                                        access,
                                        all,
                                        access,
                                        from,
                                        to,
                                        VK_QUEUE_FAMILY_IGNORED,
                                        VK_QUEUE_FAMILY_IGNORED,
                                        **image_,
                                        {aspect_, 0, 1, 0, 1}};
  commands.pipelineBarrier2(vk::DependencyInfo{{}, {}, {}, barrier});
}

void Image::begin_reading(const vk::raii::CommandBuffer& commands) const {
  move_to(commands, layout_, kReadLayout);
  full_barrier(commands);
}

void Image::end_reading(const vk::raii::CommandBuffer& commands) const {
  move_to(commands, kReadLayout, layout_);
}

void Image::copy_to(const vk::raii::CommandBuffer& commands, const Buffer& buffer, std::uint32_t row) const {
  move_to(commands, layout_, vk::ImageLayout::eTransferSrcOptimal);
  const vk::BufferImageCopy region{0, row, 0, {aspect_, 0, 0, 1}, {}, {width_, height_, 1}};
  commands.copyImageToBuffer(**image_, vk::ImageLayout::eTransferSrcOptimal, buffer.handle(), region);
  move_to(commands, vk::ImageLayout::eTransferSrcOptimal, layout_);
  full_barrier(commands);
}

std::vector<std::uint32_t> Image::read() const {
  const std::size_t count = std::size_t{width_} * height_;
  const Buffer back(device_, count * 4, Memory::readback, "reading an image back");
  device_.run([&](const vk::raii::CommandBuffer& commands) {
    full_barrier(commands);
    copy_to(commands, back);
  });
  std::vector<std::uint32_t> out(count);
  std::memcpy(out.data(), back.mapped<std::uint32_t>(), count * 4);
  return out;
}

}  // namespace sightline::device
