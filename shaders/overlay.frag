#version 450

layout(set = 0, binding = 4) uniform sampler2D glyphs;

layout(location = 0) in vec2 at;
layout(location = 1) in vec4 color;

layout(location = 0) out vec4 result;

void main() {
  result = vec4(color.rgb, color.a * texture(glyphs, at).r);
}
