// What tools and floor take of the light that comes to a body from all around.

layout(std430, set = 0, binding = 3) readonly buffer Contacts { ContactSpot contacts[]; };

// Share of the light from all around that the tools and the floor leave: a tool overhangs the body outside each
// contact, most at its edge and no more one and a half radii further out.
float openness(vec3 rest, float world_height, vec3 normal) {
  float open = 1.0;
  for (uint i = 0; i < draw.rows.y; ++i) {
    vec4 spot = contacts[draw.rows.x + i].center_and_radius;
    float away = distance(rest, spot.xyz) / spot.w;
    open *= 1.0 - 0.3 * (1.0 - smoothstep(0.7, 2.5, away));
  }
  float height = (world_height - frame.floor_level.x) / frame.floor_level.y;
  float downward = 0.5 - 0.5 * normal.y;
  return open * (1.0 - 0.6 * downward * (1.0 - smoothstep(0.0, 0.5, height)));
}
