#version 330 core
in vec3 eye_position;
in vec3 eye_normal;
in vec3 albedo;
in vec2 sky_light;
in vec3 shadow_place;

uniform mat4 view;
uniform vec3 key;             // towards the key light, world
uniform vec3 fill;            // towards the fill light, world
uniform sampler2D shadow_map;
uniform float shadow_bias;
uniform int mode;             // 0 plain cloth, 1 lit colours, 2 flat colours, 3 lines, 4 obstacle

out vec4 pixel;

float nearest_share(float near, vec2 place) { return near <= texture(shadow_map, place).r ? 1.0 : 0.0; }

// The share of a 7x7 block of the shadow map that the light reaches; its corners decide where they agree.
float lit_share(float slope) {
  float near = shadow_place.z - shadow_bias * (1.0 + 2.0 * slope);
  vec2 texel = 1.0 / vec2(textureSize(shadow_map, 0));
  float corners = nearest_share(near, shadow_place.xy);
  for (int k = 0; k < 4; ++k) {
    corners += nearest_share(near, shadow_place.xy + vec2((k & 1) * 6 - 3, (k >> 1) * 6 - 3) * texel);
  }
  if (corners == 0.0 || corners == 5.0) return corners / 5.0;
  float sum = 0.0;
  for (int i = -3; i <= 3; ++i) {
    for (int j = -3; j <= 3; ++j) sum += nearest_share(near, shadow_place.xy + vec2(i, j) * texel);
  }
  return sum / 49.0;
}

void main() {
  if (mode == 3) {
    pixel = vec4(0.05, 0.06, 0.08, 0.28);
    return;
  }
  if (mode == 2) {
    pixel = vec4(albedo, 1.0);
    return;
  }
  bool front = gl_FrontFacing;
  vec3 base = mode == 1 ? albedo : (front ? vec3(0.83, 0.76, 0.66) : vec3(0.62, 0.70, 0.77));
  if (mode == 4) base = vec3(0.36, 0.38, 0.41);
  base = pow(base, vec3(2.2));
  if (mode == 1 && !front) base *= 0.9;

  vec3 n = normalize(eye_normal + vec3(0.0, 0.0, 1e-9)) * (front ? 1.0 : -1.0);
  vec3 to_eye = normalize(-eye_position);
  vec3 k = mat3(view) * key;
  float cosine = dot(n, k);
  float direct = cosine > 0.0 ? cosine * lit_share(sqrt(1.0 - cosine * cosine) / max(cosine, 0.15)) : 0.0;
  float side = max(dot(n, mat3(view) * fill), 0.0);
  float open = front ? sky_light.x : sky_light.y;

  vec3 light = vec3(1.02, 0.95, 0.83) * direct + vec3(0.11, 0.14, 0.19) * side * (0.3 + 0.7 * open)
             + vec3(0.40, 0.45, 0.52) * open;
  if (mode == 1) light = mix(light, vec3(0.85), 0.4);  // colours must stay readable inside folds
  // A faint sheen where cloth turns away separates a fold from what lies behind it.
  float sheen = pow(1.0 - max(dot(n, to_eye), 0.0), 4.0);
  vec3 colour = base * light + vec3(0.10) * sheen * open;
  pixel = vec4(pow(min(colour, vec3(1.0)), vec3(1.0 / 2.2)), 1.0);
}
