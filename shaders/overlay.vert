#version 450
#extension GL_GOOGLE_include_directive : require

#include "shared.h"

layout(push_constant) uniform Constants { OverlayConstants constants; };

layout(location = 0) in vec2 pixel;      // from the top left
layout(location = 1) in vec2 atlas;
layout(location = 2) in vec4 srgb;       // encoded rgb, alpha

layout(location = 0) out vec2 at;
layout(location = 1) out vec4 color;

// A target that encodes to sRGB when it is written takes colours decoded (IEC 61966-2-1); one that
// keeps them as they are written, encoded.
layout(constant_id = 0) const bool kEncoded = false;

vec3 decoded(vec3 c) {
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

void main() {
  at = atlas;
  color = vec4(kEncoded ? srgb.rgb : decoded(srgb.rgb), srgb.a);
  gl_Position = vec4(pixel * constants.pixel_to_clip.xy - 1.0, 0.0, 1.0);
}
