#version 450
#extension GL_GOOGLE_include_directive : require

#include "frame.glsl"
#include "textures.glsl"


layout(location = 0) in vec2 texcoord;

void main() {
  float alpha = draw.color.a;
  if (has_texture(kBaseColor)) {
    alpha *= texture(textures[kBaseColor], texcoord).a;
  }
  if (alpha < draw.surface.w) {
    discard;
  }
}
