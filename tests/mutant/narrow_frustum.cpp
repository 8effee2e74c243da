// A deliberate fault, linked in place of make_frustum (ld --wrap): the left plane stands ten degrees too far
// inwards. The command line built with it must find out: `verify` exits 1 and names the view and the object.
#include <sightline/frustum.hpp>

#include <cmath>

namespace sightline {

// The names that ld gives the wrapped function and what it wraps.
Frustum real_make_frustum(const View&) asm("__real__ZN9sightline12make_frustumERKNS_4ViewE");
Frustum narrow_frustum(const View&) asm("__wrap__ZN9sightline12make_frustumERKNS_4ViewE");

Frustum narrow_frustum(const View& view) {
  Frustum frustum = real_make_frustum(view);
  Plane& left = frustum.planes[Frustum::left];
  const Vec3 eye = eye_position(view), forward = view_direction(view);
  const float tilt = std::sin(0.17f);
  Vec3& n = left.normal;
  n = {n.x - tilt * forward.x, n.y - tilt * forward.y, n.z - tilt * forward.z};
  left.distance = -(n.x * eye.x + n.y * eye.y + n.z * eye.z);
  return frustum;
}

}  // namespace sightline
