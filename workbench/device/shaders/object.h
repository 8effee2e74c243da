// An object of the list in its place; every pass that draws objects uses this, so depths agree to the bit.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 world_normal;
layout(location = 2) out flat uint object;
layout(location = 3) out flat uint colour;
invariant gl_Position;
out float gl_ClipDistance[1];

void place_object() {
  object = list.at[gl_InstanceIndex];
  const ObjectData data = objects.at[object];
  const vec4 local = vec4(position, 1);
  world_position = vec3(dot(data.rows[0], local), dot(data.rows[1], local), dot(data.rows[2], local));
  // The inverse transpose up to scale: cofactors of the linear part.
  const vec3 a = data.rows[0].xyz, b = data.rows[1].xyz, c = data.rows[2].xyz;
  world_normal = vec3(dot(cross(b, c), normal), dot(cross(c, a), normal), dot(cross(a, b), normal));
  colour = data.colour;
  gl_Position = on_pixel_grid(world_position);
  gl_ClipDistance[0] = before_far_end(world_position);
}
