// What glTF materials say of culling: surface, sides, and the alpha of cut-outs.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include <sightline/workbench/scene.hpp>

#include "workbench/io/gltf_document.hpp"

namespace sightline::io::gltf {

/// A material, and where its texture lies on the mesh.
struct Look {
  Material material{Surface::opaque, Sides::front};
  std::uint64_t coordinate_set = 0;  ///< N of TEXCOORD_N
  std::uint64_t moved_by = kNone;  ///< the material whose KHR_texture_transform is not the identity: this one
  std::array<double, 6> move{1, 0, 0,
                             0, 1, 0};  ///< u' = (u, v, 1) · first three; v' = (u, v, 1) · last three
};

class MaterialReader {
public:
  /// Reads all materials of the document, and the images of cut-outs. Throws Error.
  MaterialReader(Document& document, Scene& scene);

  /// Of a primitive; glTF's own default, opaque and single-sided, where it names none.
  [[nodiscard]] const Look& look_of(const Json& primitive) const;

private:
  Look read(const Json& material, std::uint64_t index);
  void read_cut_out(const Json& material, std::uint64_t index, Look& look);
  void read_images();
  [[nodiscard]] std::uint64_t image_of(const Json& texture_info) const;

  Document& document_;
  Scene& scene_;
  Look default_;
  std::vector<Look> looks_;
  std::map<std::uint64_t, std::vector<std::size_t>> of_image_;  ///< cut-outs by the image they show
  std::size_t unread_ = 0;                                      ///< cut-outs whose image is an extension's
  std::uint32_t nothing_ = kNoAlphaImage;  ///< an image of one clear texel, once one is needed
};

}  // namespace sightline::io::gltf
