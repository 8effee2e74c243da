/* What another occlusion culler implements to be measured beside this library's: a shared library that
 * exports these eight functions, named to a benchmark by --peer FILE.so. Scenes, judge and clock are the
 * benchmark's. Arrays belong to the benchmark and stay as they are until the peer is destroyed. */
#ifndef SIGHTLINE_PEER_H
#define SIGHTLINE_PEER_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What the peer keeps between calls; it defines it. */
typedef struct sightline_peer sightline_peer;

/* For the table: what it is and how it was built. */
const char* sightline_peer_name(void);
/* For images of so many pixels; NULL where it cannot. */
sightline_peer* sightline_peer_create(uint32_t width, uint32_t height);
void sightline_peer_destroy(sightline_peer* peer);

/* Once a mesh, before the clock runs: x, y, z a position in metres, three indices a triangle,
 * counter-clockwise from the front; `two_sided`: both sides occlude. Returns the mesh's number, from 0 on. */
uint32_t sightline_peer_add_mesh(sightline_peer* peer, const float* positions, size_t position_count,
                                 const uint32_t* indices, size_t index_count, int two_sided);
/* Empties the image; world to clip column by column, depth 0 ... 1, the near plane that far from the eye. */
void sightline_peer_begin(sightline_peer* peer, const float world_to_clip[16], const float eye[3],
                          float near_distance);
void sightline_peer_draw_mesh(sightline_peer* peer, uint32_t mesh);
/* min x, y, z, max x, y, z a box. */
void sightline_peer_draw_boxes(sightline_peer* peer, const float* boxes, size_t count);
/* 1 where a box may be seen, 0 where it is hidden. */
void sightline_peer_query_boxes(sightline_peer* peer, const float* boxes, size_t count, uint8_t* visible);

#ifdef __cplusplus
}
#endif

#endif
