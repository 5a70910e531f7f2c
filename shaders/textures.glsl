// The textures of a draw's material.

layout(set = 0, binding = 6) uniform sampler2D textures[kTextures];

// Those that a pipeline reads: bits as of DrawConstants::rows.w. A processor takes every sample that a shader has, wanted
// or not.
layout(constant_id = 2) const uint kReadTextures = 31;

bool has_texture(uint role) {
  return (kReadTextures & draw.rows.w & (1u << role)) != 0;
}
