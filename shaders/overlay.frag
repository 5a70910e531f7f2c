#version 450

layout(set = 0, binding = 4) uniform sampler2D glyphs;

layout(location = 0) in vec2 at;
layout(location = 1) in vec4 color;

layout(location = 0) out vec4 result;

// Where glyphs lie on whole pixels, their texel is as good as a blend of four, and faster.
layout(constant_id = 0) const bool kWholePixels = false;

void main() {
  float cover = kWholePixels ? texelFetch(glyphs, ivec2(at * vec2(textureSize(glyphs, 0))), 0).r
                             : texture(glyphs, at).r;
  result = vec4(color.rgb, color.a * cover);
}
