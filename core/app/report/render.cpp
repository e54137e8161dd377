#include "core/app/report/render.h"

#define GL_GLEXT_PROTOTYPES
#include <GL/osmesa.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/app/view/embedded.h"

namespace drape {

namespace {

constexpr int supersampling = 3;
constexpr int shadow_size = 2048;
constexpr int sky_size = 384;
constexpr int sky_directions = 64;

using Vertices = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
using SkyLight = Eigen::Matrix<float, Eigen::Dynamic, 2, Eigen::RowMajor>;

GLuint compile(GLenum kind, std::string_view source) {
  const GLuint shader = glCreateShader(kind);
  const char* text = source.data();
  const GLint length = static_cast<GLint>(source.size());
  glShaderSource(shader, 1, &text, &length);
  glCompileShader(shader);
  GLint done = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
  if (!done) {
    char log[512] = "";
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    throw std::runtime_error(std::string("the renderer's shader does not compile: ") + log);
  }
  return shader;
}

GLuint link(std::string_view vertex, std::string_view fragment) {
  const GLuint program = glCreateProgram();
  glAttachShader(program, compile(GL_VERTEX_SHADER, vertex));
  glAttachShader(program, compile(GL_FRAGMENT_SHADER, fragment));
  glLinkProgram(program);
  return program;
}

/// Without perspective, along -towards, just around a sphere at the origin. Depth grows away from the light.
Eigen::Matrix4f light_matrix(const Eigen::Vector3d& towards, double radius) {
  const Eigen::Vector3d helper =
      std::abs(towards[2]) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  Eigen::Matrix3d frame;
  frame.row(0) = helper.cross(towards).normalized();
  frame.row(1) = towards.cross(frame.row(0).transpose());
  frame.row(2) = -towards;
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = frame / radius;
  return m.cast<float>();
}

/// Evenly spread over the sphere (a Fibonacci spiral).
Eigen::Vector3d spread_direction(int k, int count) {
  const double z = 1 - (2 * k + 1.0) / count, around = k * 2.399963229728653;
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(around), r * std::sin(around), z};
}

/// Indices of the triangles whose vertices are all finite.
Triangles drawable(const TriangleMesh& mesh) {
  Triangles kept(mesh.triangles.rows(), 3);
  Eigen::Index count = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    bool finite = true;
    for (int k = 0; k < 3; ++k) finite &= mesh.vertices.row(mesh.triangles(t, k)).allFinite();
    if (finite) kept.row(count++) = mesh.triangles.row(t);
  }
  kept.conservativeResize(count, 3);
  return kept;
}

/// Adds what each vertex sees, with its front and with its back, of a sky that is brighter above than
/// below in the direction `towards`. `depth` holds the nearest depths along -towards.
void add_sky(const std::vector<float>& depth, const Eigen::Matrix4f& matrix, const Eigen::Vector3f& towards,
             const Vertices& x, const Vertices& normals, SkyLight& light, SkyLight& weight) {
  const float brightness = 0.42f + 0.58f * (0.5f + 0.5f * towards[2]);
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const float cosine = normals.row(i).dot(towards);
    const float amount = std::abs(cosine);
    const int side = cosine >= 0 ? 0 : 1;
    weight(i, side) += amount;
    const Eigen::Vector3f p = matrix.topLeftCorner<3, 3>() * x.row(i).transpose();
    const int column = std::clamp(int((p[0] * 0.5f + 0.5f) * sky_size), 0, sky_size - 1);
    const int row = std::clamp(int((p[1] * 0.5f + 0.5f) * sky_size), 0, sky_size - 1);
    // The bias grows with the slope of the surface within one cell of the depth map.
    const float bias = (1.5f + 1.5f * std::min(1 / std::max(amount, 0.05f), 6.0f)) / sky_size;
    const float nearest = depth[static_cast<std::size_t>(row) * sky_size + column];
    if (p[2] * 0.5f + 0.5f - bias <= nearest) light(i, side) += amount * brightness;
  }
}

/// The canvas without its alpha, over a soft grey where nothing was drawn.
Image over_backdrop(const std::vector<unsigned char>& canvas, int width, int height, bool plain) {
  Image image{width, height, {}};
  image.pixels.resize(3 * static_cast<std::size_t>(width) * height);
  for (std::size_t i = 0; i < image.pixels.size() / 3; ++i) {
    const float shade = plain ? 1.0f : float(i / width) / height;
    const float backdrop[3] = {248 - 26 * shade, 248 - 24 * shade, 249 - 21 * shade};
    for (int k = 0; k < 3; ++k) {
      image.pixels[3 * i + k] =
          canvas[4 * i + 3] ? canvas[4 * i + k] : static_cast<unsigned char>(backdrop[k]);
    }
  }
  return image;
}

}  // namespace

Positions smooth_normals(const TriangleMesh& mesh) {
  Positions normals = Positions::Zero(mesh.vertices.rows(), 3);
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    const Eigen::Vector3d a = mesh.vertices.row(mesh.triangles(t, 0));
    const Eigen::Vector3d b = mesh.vertices.row(mesh.triangles(t, 1));
    const Eigen::Vector3d c = mesh.vertices.row(mesh.triangles(t, 2));
    const Eigen::Vector3d n = (b - a).cross(c - a);
    if (!n.allFinite()) continue;
    for (int k = 0; k < 3; ++k) normals.row(mesh.triangles(t, k)) += n.transpose();
  }
  for (Eigen::Index i = 0; i < normals.rows(); ++i) {
    const double length = normals.row(i).norm();
    if (length > 0) normals.row(i) /= length;
  }
  return normals;
}

TriangleMesh merged(const std::vector<TriangleMesh>& meshes) {
  TriangleMesh all;
  for (const TriangleMesh& mesh : meshes) {
    const Eigen::Index n = all.vertices.rows(), m = all.triangles.rows();
    all.vertices.conservativeResize(n + mesh.vertices.rows(), 3);
    all.vertices.bottomRows(mesh.vertices.rows()) = mesh.vertices;
    all.triangles.conservativeResize(m + mesh.triangles.rows(), 3);
    all.triangles.bottomRows(mesh.triangles.rows()) = mesh.triangles.array() + static_cast<int>(n);
  }
  return all;
}

struct Renderer::Context {
  int width, height;
  std::function<bool()> leave;
  OSMesaContext mesa = nullptr;
  std::vector<unsigned char> canvas;  // RGBA, supersampled
  GLuint program = 0, depth_program = 0, array = 0, buffers[5] = {}, depth_texture[2] = {},
         depth_target[2] = {};

  Context(int w, int h, std::function<bool()> asked) : width(w), height(h), leave(std::move(asked)) {
    // clang-format off
    const int attributes[] = {OSMESA_FORMAT, OSMESA_RGBA, OSMESA_DEPTH_BITS, 24,
                              OSMESA_PROFILE, OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION, 3, OSMESA_CONTEXT_MINOR_VERSION, 3, 0};
    // clang-format on
    mesa = OSMesaCreateContextAttribs(attributes, nullptr);
    canvas.resize(4 * static_cast<std::size_t>(canvas_width()) * canvas_height());
    if (!mesa || !activate()) {
      throw std::runtime_error("OSMesa gives no OpenGL 3.3 context; is libosmesa6 whole?");
    }
    OSMesaPixelStore(OSMESA_Y_UP, 0);
    program = link(Embedded::cloth_vertex_shader(), Embedded::cloth_fragment_shader());
    depth_program = link(Embedded::depth_vertex_shader(), Embedded::depth_fragment_shader());
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glGenBuffers(5, buffers);
    glGenTextures(2, depth_texture);
    glGenFramebuffers(2, depth_target);
    for (int k = 0; k < 2; ++k) make_depth_target(k, k == 0 ? shadow_size : sky_size);
    glEnable(GL_DEPTH_TEST);
    glClearColor(0, 0, 0, 0);
  }
  ~Context() { OSMesaDestroyContext(mesa); }

  int canvas_width() const { return width * supersampling; }
  int canvas_height() const { return height * supersampling; }

  bool activate() {
    return OSMesaMakeCurrent(mesa, canvas.data(), GL_UNSIGNED_BYTE, canvas_width(), canvas_height());
  }

  void make_depth_target(int k, int size) {
    glBindTexture(GL_TEXTURE_2D, depth_texture[k]);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, size, size, 0, GL_DEPTH_COMPONENT, GL_FLOAT,
                 nullptr);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
      glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
    }
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) {
      glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, depth_target[k]);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_texture[k], 0);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
  }

  GLint place(const char* name) const { return glGetUniformLocation(program, name); }
  void set(const char* name, const Eigen::Matrix4f& m) const {
    glUniformMatrix4fv(place(name), 1, GL_FALSE, m.data());
  }
  void set(const char* name, const Eigen::Vector3d& v) const {
    glUniform3f(place(name), float(v[0]), float(v[1]), float(v[2]));
  }

  template <class Rows>
  void attribute(int index, const Rows& rows) const {
    glBindBuffer(GL_ARRAY_BUFFER, buffers[index]);
    glBufferData(GL_ARRAY_BUFFER, rows.size() * sizeof(float), rows.data(), GL_STATIC_DRAW);
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, int(Rows::ColsAtCompileTime), GL_FLOAT, GL_FALSE, 0, nullptr);
  }
  void triangles(const Triangles& t) const {
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[4]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, t.size() * sizeof(int), t.data(), GL_STATIC_DRAW);
  }

  void draw_depth(int target, int size, const Eigen::Matrix4f& matrix, int index_count) const {
    glBindFramebuffer(GL_FRAMEBUFFER, depth_target[target]);
    glViewport(0, 0, size, size);
    glClear(GL_DEPTH_BUFFER_BIT);
    glUseProgram(depth_program);
    glUniformMatrix4fv(glGetUniformLocation(depth_program, "projection"), 1, GL_FALSE, matrix.data());
    glDrawElements(GL_TRIANGLES, index_count, GL_UNSIGNED_INT, nullptr);
  }

  /// The share of the sky that each vertex sees, by as many depth maps as directions.
  SkyLight sky_light(const Vertices& x, const Vertices& normals, double radius, int index_count) const {
    SkyLight weight = SkyLight::Constant(x.rows(), 2, 1e-6f), light = SkyLight::Zero(x.rows(), 2);
    std::vector<float> depth(static_cast<std::size_t>(sky_size) * sky_size);
    for (int k = 0; k < sky_directions; ++k) {
      if (leave && leave()) throw PictureLeft();
      const Eigen::Vector3d towards = spread_direction(k, sky_directions);
      const Eigen::Matrix4f matrix = light_matrix(towards, radius);
      draw_depth(1, sky_size, matrix, index_count);
      glReadPixels(0, 0, sky_size, sky_size, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
      add_sky(depth, matrix, towards.cast<float>(), x, normals, light, weight);
    }
    return light.cwiseQuotient(weight);
  }

  /// The first `cloth_count` indices are the cloth's, the rest an obstacle's.
  void draw_surface(int mode, int cloth_count, int index_count) const {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, canvas_width(), canvas_height());
    glClear(GL_DEPTH_BUFFER_BIT | GL_COLOR_BUFFER_BIT);
    glUniform1i(place("mode"), mode);
    glBindTexture(GL_TEXTURE_2D, depth_texture[0]);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1, 1);
    glDrawElements(GL_TRIANGLES, cloth_count, GL_UNSIGNED_INT, nullptr);
    glUniform1i(place("mode"), 4);
    glDrawElements(GL_TRIANGLES, index_count - cloth_count, GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(sizeof(int) * static_cast<std::size_t>(cloth_count)));
    glDisable(GL_POLYGON_OFFSET_FILL);
  }

  void draw_edges(int index_count) const {
    glUniform1i(place("mode"), 3);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    glDepthFunc(GL_LEQUAL);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    glLineWidth(0.7f * supersampling);
    glDrawElements(GL_TRIANGLES, index_count, GL_UNSIGNED_INT, nullptr);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glDepthFunc(GL_LESS);
    glDisable(GL_BLEND);
  }
};

Renderer::Renderer(int width, int height, std::function<bool()> leave)
    : context_(std::make_unique<Context>(width, height, std::move(leave))) {}
Renderer::~Renderer() = default;

Image Renderer::draw(const Drawing& drawing, const Camera& camera) const {
  const Context& gl = *context_;
  context_->activate();

  const TriangleMesh all = drawing.obstacle ? merged({drawing.mesh, *drawing.obstacle}) : drawing.mesh;
  // Single precision is kept for offsets from the centre only.
  Eigen::AlignedBox3d box;
  for (Eigen::Index i = 0; i < all.vertices.rows(); ++i) {
    if (all.vertices.row(i).allFinite()) box.extend(all.vertices.row(i).transpose());
  }
  if (box.isEmpty()) box.extend(Eigen::Vector3d::Zero());
  const double radius = 1.01 * std::max(box.diagonal().norm() / 2, 1e-9);
  Vertices x = (all.vertices.rowwise() - box.center().transpose()).cast<float>();
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    if (!x.row(i).allFinite()) x.row(i).setZero();
  }
  Vertices normals = smooth_normals(all).cast<float>();
  if (drawing.normals) normals.topRows(drawing.normals->rows()) = drawing.normals->cast<float>();
  Colours colours = Colours::Constant(x.rows(), 3, 0.8f);
  if (drawing.colours) colours.topRows(drawing.colours->rows()) = *drawing.colours;
  const Triangles kept = drawable(all);
  const int index_count = static_cast<int>(kept.size());
  const int cloth_count = drawing.obstacle ? static_cast<int>(drawable(drawing.mesh).size()) : index_count;
  gl.attribute(0, x);
  gl.attribute(1, normals);
  gl.attribute(2, colours);
  gl.triangles(kept);

  const Eigen::Matrix3d to_world = camera.view.topLeftCorner<3, 3>().transpose();
  const Eigen::Vector3d key =
      (to_world * Eigen::Vector3d(-0.75, 0.25, 0.25) + Eigen::Vector3d(0, 0, 0.62)).normalized();
  const Eigen::Matrix4f shadow = light_matrix(key, radius);
  if (drawing.lit) {
    gl.attribute(3, gl.sky_light(x, normals, radius, index_count));
    gl.draw_depth(0, shadow_size, shadow, index_count);
  } else {
    gl.attribute(3, SkyLight(SkyLight::Ones(x.rows(), 2)));
  }

  Eigen::Matrix4d view = camera.view;
  view.topRightCorner<3, 1>() += view.topLeftCorner<3, 3>() * box.center();
  glUseProgram(gl.program);
  gl.set("view", Eigen::Matrix4f(view.cast<float>()));
  gl.set("projection", Eigen::Matrix4f(camera.projection.cast<float>()));
  gl.set("shadow", shadow);
  gl.set("key", key);
  gl.set("fill", Eigen::Vector3d((to_world * Eigen::Vector3d(0.8, 0.1, 0.45)).normalized()));
  glUniform1f(gl.place("shadow_bias"), 1.6f / shadow_size);
  gl.draw_surface(!drawing.lit ? 2 : drawing.colours ? 1 : 0, cloth_count, index_count);
  if (drawing.edges) gl.draw_edges(cloth_count);
  glFinish();
  return shrink(over_backdrop(gl.canvas, gl.canvas_width(), gl.canvas_height(), !drawing.lit), supersampling);
}

}  // namespace drape
