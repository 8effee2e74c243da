/** @file
 * The C API of Sightline: the library, usable from C, C++, C#, Rust and whatever else calls C.
 *
 *   sightline_world* world = sightline_world_create();
 *   sightline_box_view boxes = sightline_boxes_centre_half_float(t->position, t->half, sizeof *t, n);
 *   sightline_handles handles = sightline_handles_of(&t->handle, sizeof *t, n);
 *   if (sightline_world_insert(world, &boxes, &handles, NULL) != SIGHTLINE_OK) puts(sightline_last_error());
 *
 * Refusals. A function that can fail returns a status, changes nothing and writes nothing where it fails;
 * sightline_last_error() says why. NULL where a pointer is needed is SIGHTLINE_BAD_ARGUMENT, and so is a
 * count of more than memory can hold. Running out of memory is no status: it ends the process.
 *
 * Objects. What `_create` makes, and an object that a function hands out through a pointer to a pointer, is
 * the caller's, who gives it to the `_destroy` of its type; every `_destroy` takes NULL.
 *
 * Versions. A struct that begins with `struct_size` is made by the function beside it, which fills in the
 * size and the defaults; members are added at its end. The library takes a struct of an older header, whose
 * missing members count as default, and refuses one that is longer than it knows: a program does not run
 * with a library older than its headers. All other structs stay as they are. tests/c/abi.txt in the source
 * holds all of it.
 *
 * Lengths are metres, the world is right-handed with y up, matrices are column-major and multiply columns,
 * clip depth is 0 to 1 (either way round). Numbers in the caller's arrays need no alignment where they are
 * given with a stride.
 *
 * Unless a function says otherwise: Errors: none. Cost: constant. Threads: any, on objects that no other
 * changes. Allocates: nothing. */
#ifndef SIGHTLINE_H
#define SIGHTLINE_H

#include <sightline/c/frustum.h>
#include <sightline/c/inspect.h>
#include <sightline/c/instances.h>
#include <sightline/c/occlusion.h>
#include <sightline/c/pvs.h>
#include <sightline/c/ranges.h>
#include <sightline/c/rays.h>
#include <sightline/c/shadows.h>
#include <sightline/c/snapshot.h>
#include <sightline/c/status.h>
#include <sightline/c/view.h>
#include <sightline/c/world.h>

#endif
