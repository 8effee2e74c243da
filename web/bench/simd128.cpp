// Culling columns of boxes by hand in WebAssembly's SIMD: what the library's flat culling is held beside.
#include <wasm_simd128.h>

#include <cstddef>
#include <cstdint>

extern unsigned char __heap_base;

extern "C" {

/// Where the arrays may lie.
__attribute__((export_name("heap"))) unsigned char* heap() {
  return &__heap_base;
}

/// Six columns of `count` numbers, a multiple of four; six planes of four numbers. Writes the indices of the
/// boxes that reach in front of all planes; returns how many.
__attribute__((export_name("cull"))) std::size_t cull(const float* columns, std::size_t count,
                                                      const float* planes, std::uint32_t* ids) {
  const float* corner[6][3];
  v128_t coefficient[6][4];
  for (int p = 0; p < 6; ++p) {
    for (int axis = 0; axis < 3; ++axis)
      corner[p][axis] =
          columns + count * static_cast<std::size_t>(planes[4 * p + axis] > 0 ? 3 + axis : axis);
    for (int k = 0; k < 4; ++k) coefficient[p][k] = wasm_f32x4_splat(planes[4 * p + k]);
  }
  std::size_t seen = 0;
  for (std::size_t i = 0; i < count; i += 4) {
    v128_t inside = wasm_i32x4_splat(-1);
    for (int p = 0; p < 6; ++p) {  // all of them: a branch a plane costs more than it saves
      v128_t d = coefficient[p][3];
      for (int axis = 0; axis < 3; ++axis)
        d = wasm_f32x4_add(d, wasm_f32x4_mul(coefficient[p][axis], wasm_v128_load(corner[p][axis] + i)));
      inside = wasm_v128_and(inside, wasm_f32x4_ge(d, wasm_f32x4_splat(0)));
    }
    for (std::uint32_t bits = wasm_i32x4_bitmask(inside); bits != 0; bits &= bits - 1)
      ids[seen++] = static_cast<std::uint32_t>(i) + static_cast<std::uint32_t>(__builtin_ctz(bits));
  }
  return seen;
}
}
