#include "core/app/picture/ray_scene.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/numerics/mesh/area_vectors.h"

namespace drape {

namespace {

#if RTC_VERSION_MAJOR < 4  // the calls of Embree 4
void rtcIntersect1(RTCScene scene, RTCRayHit* hit) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  ::rtcIntersect1(scene, &context, hit);
}
void rtcOccluded1(RTCScene scene, RTCRay* ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  ::rtcOccluded1(scene, &context, ray);
}
#endif

// Shares of the scene's radius.
constexpr float offset = 2e-5f;        // of rays to lights from the surface
constexpr float floor_offset = 3e-4f;  // of rays to lights from the floor
constexpr float floor_margin = 1e-4f;  // of heights that count as the floor's

RTCRayHit embree_ray(const Ray& ray, float length = std::numeric_limits<float>::infinity()) {
  RTCRayHit query{};
  query.ray.org_x = ray.origin()[0], query.ray.org_y = ray.origin()[1], query.ray.org_z = ray.origin()[2];
  query.ray.dir_x = ray.direction()[0], query.ray.dir_y = ray.direction()[1],
  query.ray.dir_z = ray.direction()[2];
  query.ray.tfar = length;
  query.ray.mask = ~0u;
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return query;
}

}  // namespace

RayScene::RayScene(const Drawing& drawing)
    // One thread builds, so that equal drawings give equal trees, and the run's other threads are left alone.
    : device_(rtcNewDevice("threads=1,start_threads=0,set_affinity=0"), rtcReleaseDevice) {
  if (!device_) throw std::runtime_error("Embree, which draws pictures, does not start");
  for (auto* scene : {&all_, &obstacles_}) {
    scene->reset(rtcNewScene(device_.get()), rtcReleaseScene);
    rtcSetSceneFlags(scene->get(), RTC_SCENE_FLAG_ROBUST);  // no ray slips between two triangles
  }
  Eigen::AlignedBox3d box = bounding_box(drawing.mesh.vertices);
  for (const TriangleMesh* obstacle : drawing.obstacles) box.extend(bounding_box(obstacle->vertices));
  if (box.isEmpty()) box.extend(Eigen::Vector3d::Zero());
  centre_ = box.center();
  radius_ = static_cast<float>(std::max(box.diagonal().norm() / 2, 1e-9));
  if (drawing.floor) floor_ = static_cast<float>(*drawing.floor - centre_[2]);
  add(drawing.mesh, smooth_normals(drawing.mesh));
  for (const TriangleMesh* obstacle : drawing.obstacles) {
    Positions normals;
    const TriangleMesh creased = split_at_creases(*obstacle, normals);
    add(creased, normals);
  }
  rtcCommitScene(all_.get());
  rtcCommitScene(obstacles_.get());
  const RTCError error = rtcGetDeviceError(device_.get());
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::runtime_error("no memory is left to draw a picture");
  if (error != RTC_ERROR_NONE)
    throw std::runtime_error("Embree, which draws pictures, fails with error " + std::to_string(error));
}

void RayScene::add(const TriangleMesh& mesh, const Positions& normals) {
  const auto id = static_cast<unsigned>(surfaces_.size());
  surfaces_.push_back(
      {(mesh.vertices.rowwise() - centre_.transpose()).cast<float>(), normals.cast<float>(), mesh.triangles});
  if (mesh.triangles.rows() == 0) return;
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  const auto copy = [&](RTCBufferType type, RTCFormat format, const auto& rows) {
    void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, 12, rows.rows());
    if (buffer)
      std::copy_n(rows.data(), rows.size(), static_cast<std::decay_t<decltype(rows(0, 0))>*>(buffer));
  };
  copy(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, surfaces_.back().x);
  copy(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(all_.get(), geometry, id);
  if (id > 0) rtcAttachGeometryByID(obstacles_.get(), geometry, id);
  rtcReleaseGeometry(geometry);
}

/// The point with barycentric coordinates (1 - u - v, u, v) of a triangle, met by a ray.
SurfacePoint RayScene::Surface::point(int triangle, float u, float v, const Ray& ray) const {
  const Eigen::Vector3f weight(1 - u - v, u, v);
  Eigen::Matrix3f corners, n;
  SurfacePoint point;
  for (int k = 0; k < 3; ++k) {
    const int i = triangles(triangle, k);
    corners.col(k) = x.row(i);
    n.col(k) = normals.row(i);
  }
  const Eigen::Vector3f across = (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0));
  const float twice_area = across.norm();
  point.front = across.dot(ray.direction()) < 0;
  const float side = point.front ? 1 : -1;
  point.face_normal = side / std::max(twice_area, std::numeric_limits<float>::min()) * across;
  point.position = corners * weight;
  point.normal = side * (n * weight);
  const float length = point.normal.norm();
  point.normal = length > 0.01f ? Eigen::Vector3f(point.normal / length) : point.face_normal;
  // Interpolated normals may turn away from the eye near a silhouette: they are bent back.
  const float away = point.normal.dot(ray.direction());
  if (away > -0.02f) point.normal = (point.normal - (away + 0.02f) * ray.direction()).normalized();
  point.facing = std::clamp(-point.normal.dot(ray.direction()), 0.0f, 1.0f);
  // Flat triangles shadow the smooth surface that their normals suggest, in steps along the shadow's border.
  // Rays therefore start on that surface where it bulges out (J. Hanika, Hacking the Shadow Terminator, Ray
  // Tracing Gems II, 2021).
  point.light_origin = point.position;
  for (int k = 0; k < 3; ++k) {
    const float below = std::min(side * (point.position - corners.col(k)).dot(n.col(k)), 0.0f);
    point.light_origin -= weight[k] * side * below * n.col(k);
    const Eigen::Vector3f across_edge =
        (corners.col((k + 2) % 3) - corners.col((k + 1) % 3)).cross(ray.direction()).normalized();
    point.edge_distance[k] = std::abs(across_edge.dot(corners.col((k + 1) % 3) - point.position));
  }
  return point;
}

std::optional<SurfacePoint> RayScene::hit(RTCSceneTy* scene, const Ray& ray) const {
  RTCRayHit query = embree_ray(ray);
  rtcIntersect1(scene, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  SurfacePoint point =
      surfaces_[query.hit.geomID].point(static_cast<int>(query.hit.primID), query.hit.u, query.hit.v, ray);
  point.surface = query.hit.geomID == 0 ? Seen::Surface::cloth : Seen::Surface::obstacle;
  point.distance = query.ray.tfar;
  point.triangle = static_cast<int>(query.hit.primID);
  return point;
}

Ray RayScene::through(const Camera& camera, double right, double up) const {
  const auto world = camera.frame.transpose();
  const Eigen::Vector3d ahead(right * camera.tangent[0], up * camera.tangent[1], -1);
  return {(world * camera.eye - centre_).cast<float>(), (world * ahead).normalized().cast<float>()};
}

std::optional<SurfacePoint> RayScene::nearest(const Ray& ray) const {
  std::optional<SurfacePoint> point = hit(all_.get(), ray);
  if (floor_ && ray.direction()[2] < 0 && ray.origin()[2] > *floor_) {
    const float distance = (*floor_ - ray.origin()[2]) / ray.direction()[2];
    // Neither cloth that lies on the floor nor an obstacle that is the floor may flicker.
    const bool cloth = point && point->surface == Seen::Surface::cloth;
    const float level = *floor_ + (cloth ? -floor_margin : floor_margin) * radius_;
    if (!point || point->position[2] < level) {
      point.emplace();
      point->surface = Seen::Surface::floor;
      point->distance = distance;
      point->position = ray.pointAt(distance);
      point->normal = point->face_normal = Eigen::Vector3f::UnitZ();
      point->light_origin = point->position + floor_offset * radius_ * point->normal;
      return point;
    }
  }
  if (!point) return {};
  const Eigen::Vector3f off_surface = offset * radius_ * point->face_normal;
  const Eigen::Vector3f bulge = point->light_origin - point->position;
  // At a sharp fold the smooth surface may lie behind the next layer.
  const bool far = bulge.squaredNorm() > off_surface.squaredNorm();
  if (far && blocked({point->position + off_surface, bulge}, 1)) point->light_origin = point->position;
  point->light_origin += off_surface;
  return point;
}

std::optional<SurfacePoint> RayScene::nearest_obstacle(const Ray& ray) const {
  return hit(obstacles_.get(), ray);
}

bool RayScene::blocked(const Ray& ray, float length) const {
  RTCRayHit query = embree_ray(ray, length);
  rtcOccluded1(all_.get(), &query.ray);
  return query.ray.tfar < 0;
}

TriangleMesh split_at_creases(const TriangleMesh& mesh, Positions& normals) {
  constexpr double cosine_of_crease = 0.766;
  const Eigen::Index m = mesh.triangles.rows();
  const Positions areas = area_vectors(mesh);
  std::vector<std::vector<int>> around(mesh.vertices.rows());
  for (Eigen::Index t = 0; t < m; ++t)
    for (int k = 0; k < 3; ++k) around[mesh.triangles(t, k)].push_back(static_cast<int>(t));
  TriangleMesh split{Positions(3 * m, 3), Triangles(m, 3)};
  normals = Positions::Zero(3 * m, 3);
  for (Eigen::Index t = 0; t < m; ++t)
    for (int k = 0; k < 3; ++k) {
      const int i = mesh.triangles(t, k), corner = static_cast<int>(3 * t) + k;
      split.triangles(t, k) = corner;
      split.vertices.row(corner) = mesh.vertices.row(i);
      for (const int other : around[i])
        if (areas.row(t).dot(areas.row(other)) >=
            cosine_of_crease * areas.row(t).norm() * areas.row(other).norm())
          normals.row(corner) += areas.row(other);
      normals.row(corner).normalize();
    }
  return split;
}

}  // namespace drape
