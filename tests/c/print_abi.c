/* Prints what programs and other languages rely on: sizes and the places of last members, and all numbers
 * with a name. scripts/check-abi.sh holds it against tests/c/abi.txt. */
#include <sightline/sightline.h>

#include <stdio.h>

#define STRUCT(type, last) \
  printf("struct %s: %zu bytes, %s at %zu\n", #type, sizeof(type), #last, offsetof(type, last))
#define VALUE(name) printf("value %s: %lld\n", #name, (long long)(name))

int main(void) {
  STRUCT(sightline_box, max);
  STRUCT(sightline_box_view, origin);
  STRUCT(sightline_camera, shift);
  STRUCT(sightline_cascade, depths);
  STRUCT(sightline_column, count);
  STRUCT(sightline_cull_costs, reserved);
  STRUCT(sightline_cull_options, levels);
  STRUCT(sightline_cull_output, fades);
  STRUCT(sightline_cull_result, reserved);
  STRUCT(sightline_cull_view, casters);
  STRUCT(sightline_cull_zones, user);
  STRUCT(sightline_depth_range, far_plane);
  STRUCT(sightline_debug_box, objects);
  STRUCT(sightline_distance_range, max);
  STRUCT(sightline_distances, count);
  STRUCT(sightline_error, message);
  STRUCT(sightline_frustum, origin);
  STRUCT(sightline_handle, generation);
  STRUCT(sightline_handles, count);
  STRUCT(sightline_inspection, box_count);
  STRUCT(sightline_instance_options, zones);
  STRUCT(sightline_instance_placement, origin);
  STRUCT(sightline_instance_range, count);
  STRUCT(sightline_instance_result, culled_occlusion);
  STRUCT(sightline_jobs, reserved);
  STRUCT(sightline_level_options, cut);
  STRUCT(sightline_light, reserved);
  STRUCT(sightline_object_columns, distances);
  STRUCT(sightline_occluder_parts, box_count);
  STRUCT(sightline_occluder_placement, origin);
  STRUCT(sightline_placements, count);
  STRUCT(sightline_order_report, count);
  STRUCT(sightline_pvs_cells, visible_count);
  STRUCT(sightline_range_options, zones);
  STRUCT(sightline_range_result, culled_occlusion);
  STRUCT(sightline_ray, max_distance);
  STRUCT(sightline_slot_change, object);
  STRUCT(sightline_slot_range, count);
  STRUCT(sightline_sphere_view, count);
  STRUCT(sightline_stream_options, ahead);
  STRUCT(sightline_stream_report, memory);
  STRUCT(sightline_stream_sector, reserved);
  STRUCT(sightline_view, origin);
  STRUCT(sightline_view_stats, visible);
  VALUE(SIGHTLINE_OK);
  VALUE(SIGHTLINE_BAD_ARGUMENT);
  VALUE(SIGHTLINE_BAD_BOX);
  VALUE(SIGHTLINE_STALE_HANDLE);
  VALUE(SIGHTLINE_BAD_VIEW);
  VALUE(SIGHTLINE_BUFFER_TOO_SMALL);
  VALUE(SIGHTLINE_STALE_BUFFER);
  VALUE(SIGHTLINE_BAD_MESH);
  VALUE(SIGHTLINE_TOO_MANY);
  VALUE(SIGHTLINE_BAD_FILE);
  VALUE(SIGHTLINE_MIN_MAX_FLOAT);
  VALUE(SIGHTLINE_MIN_MAX_DOUBLE);
  VALUE(SIGHTLINE_CENTRE_HALF_FLOAT);
  VALUE(SIGHTLINE_CENTRE_HALF_DOUBLE);
  VALUE(SIGHTLINE_ARRAYS_FLOAT);
  VALUE(SIGHTLINE_BOTH_SIDES);
  VALUE(SIGHTLINE_FRONT_SIDE);
  VALUE(SIGHTLINE_COVERAGE_CENTRES);
  VALUE(SIGHTLINE_COVERAGE_AREA);
  VALUE(SIGHTLINE_OCCLUDES_WHOLE);
  VALUE(SIGHTLINE_OCCLUDES_PARTS);
  VALUE(SIGHTLINE_OCCLUDES_THIN);
  VALUE(SIGHTLINE_OCCLUDES_EMPTY);
  VALUE(SIGHTLINE_OCCLUSION_NONE);
  VALUE(SIGHTLINE_OCCLUSION_AUTOMATIC);
  VALUE(SIGHTLINE_LIGHT_DIRECTIONAL);
  VALUE(SIGHTLINE_LIGHT_SPOT);
  VALUE(SIGHTLINE_LIGHT_POINT);
  VALUE(SIGHTLINE_NO_OCCLUDER);
  VALUE(SIGHTLINE_OWN_VIEW);
  VALUE(SIGHTLINE_OUTSIDE);
  VALUE(SIGHTLINE_CROSSING);
  VALUE(SIGHTLINE_INSIDE);
  VALUE(SIGHTLINE_NO_INDEX);
  VALUE(SIGHTLINE_NO_OBJECT);
  VALUE(SIGHTLINE_NO_SLOT);
  VALUE(SIGHTLINE_DEBUG_SECTOR);
  VALUE(SIGHTLINE_DEBUG_CHUNK);
  VALUE(SIGHTLINE_DEBUG_OCCLUDER);
  VALUE(SIGHTLINE_NO_CELL);
  VALUE(SIGHTLINE_ALL_LAYERS);
  VALUE(SIGHTLINE_SECTOR_OUT);
  VALUE(SIGHTLINE_SECTOR_COMING);
  VALUE(SIGHTLINE_SECTOR_IN);
  VALUE(SIGHTLINE_SECTOR_CHANGED);
  VALUE(SIGHTLINE_SECTOR_DAMAGED);
  VALUE(SIGHTLINE_MAX_CASCADES);
  VALUE(SIGHTLINE_MAX_LEVELS);
  VALUE(SIGHTLINE_NO_LEVELS);
  VALUE(SIGHTLINE_MAX_VIEWS);
  VALUE(SIGHTLINE_CULL_PADDING);
  return 0;
}
