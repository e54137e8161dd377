#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 colour;    // sRGB
layout(location = 3) in vec2 sky;       // sky light on the front and on the back

uniform mat4 view;
uniform mat4 projection;
uniform mat4 shadow;

out vec3 eye_position;
out vec3 eye_normal;
out vec3 albedo;
out vec2 sky_light;
out vec3 shadow_place;

void main() {
  vec4 p = view * vec4(position, 1.0);
  eye_position = p.xyz;
  eye_normal = mat3(view) * normal;
  albedo = colour;
  sky_light = sky;
  shadow_place = (shadow * vec4(position, 1.0)).xyz * 0.5 + 0.5;
  gl_Position = projection * p;
}
