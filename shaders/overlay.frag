#version 450
#extension GL_GOOGLE_include_directive : require

#include "srgb.glsl"

layout(set = 0, binding = 4) uniform sampler2D atlas;

layout(location = 0) in vec2 at;
layout(location = 1) in vec4 color;

layout(location = 0) out vec4 result;

// Where glyphs lie on whole pixels, their texel is as good as a blend of four, and faster. There
// the target keeps colours as they are written, as in overlay.vert.
layout(constant_id = 0) const bool kWholePixels = false;

void main() {
  vec4 texel = kWholePixels ? texelFetch(atlas, ivec2(at * vec2(textureSize(atlas, 0))), 0)
                            : texture(atlas, at);
  result = color * vec4(kWholePixels ? texel.rgb : decoded(texel.rgb), texel.a);
}
