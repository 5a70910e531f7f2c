#version 450
#extension GL_GOOGLE_include_directive : require

#include "shared.h"
#include "srgb.glsl"

layout(push_constant) uniform Constants { OverlayConstants constants; };

layout(location = 0) in vec2 pixel;      // from the top left
layout(location = 1) in vec2 atlas;
layout(location = 2) in vec4 srgb;       // encoded rgb, alpha

layout(location = 0) out vec2 at;
layout(location = 1) out vec4 color;

// A target that encodes to sRGB when it is written takes colours decoded; one that keeps them as
// they are written, encoded.
layout(constant_id = 0) const bool kEncoded = false;

void main() {
  at = atlas;
  color = vec4(kEncoded ? srgb.rgb : decoded(srgb.rgb), srgb.a);
  gl_Position = vec4(pixel * constants.pixel_to_clip.xy - 1.0, 0.0, 1.0);
}
