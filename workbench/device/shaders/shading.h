// The light that every picture is drawn with.
vec4 shade_of(vec3 world_position, vec3 world_normal, uint colour) {
  const vec4 base = unpackUnorm4x8(colour);
  const vec3 to_eye = view.eye.w > 0 ? -view.forward.xyz : view.eye.xyz - world_position;
  vec3 n = normalize(world_normal);
  if (dot(n, to_eye) < 0) n = -n;  // both faces are drawn
  const vec3 sun = normalize(vec3(0.45, 0.75, 0.5));
  const vec3 sky = mix(vec3(0.30, 0.27, 0.25), vec3(0.50, 0.58, 0.70), 0.5 + 0.5 * n.y);
  const vec3 light = sky + vec3(0.95, 0.88, 0.75) * max(dot(n, sun), 0);
  return vec4(base.rgb * light, base.a);
}
