#include "core/app/picture/ray_scene.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/app/picture/surface.h"

namespace drape {

namespace {

#if RTC_VERSION_MAJOR < 4
void intersect(RTCScene scene, RTCRayHit* hit) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, hit);
}
void occlude(RTCScene scene, RTCRay* ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, ray);
}
#else
void intersect(RTCScene scene, RTCRayHit* hit) { rtcIntersect1(scene, hit); }
void occlude(RTCScene scene, RTCRay* ray) { rtcOccluded1(scene, ray); }
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

struct RayScene::Embree {
  RTCDevice device = nullptr;
  RTCScene all = nullptr, obstacle_alone = nullptr;
  DrawnSurface surfaces[2];  // cloth, obstacle

  Embree() {
    // One thread builds, so that equal drawings give equal trees, and the run's other threads are left alone.
    device = rtcNewDevice("threads=1,start_threads=0,set_affinity=0");
    if (!device) throw std::runtime_error("Embree, which draws pictures, does not start");
    for (RTCScene* scene : {&all, &obstacle_alone}) {
      *scene = rtcNewScene(device);
      rtcSetSceneFlags(*scene, RTC_SCENE_FLAG_ROBUST);  // no ray slips between two triangles
    }
  }
  ~Embree() {
    for (RTCScene scene : {all, obstacle_alone})
      if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  void attach(int id) {
    const DrawnSurface& surface = surfaces[id];
    if (surface.triangles.rows() == 0) return;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    const auto copy = [&](RTCBufferType type, RTCFormat format, const auto& rows) {
      void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, 12, rows.rows());
      if (buffer)
        std::copy_n(rows.data(), rows.size(), static_cast<std::decay_t<decltype(rows(0, 0))>*>(buffer));
    };
    copy(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, surface.x);
    copy(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, surface.triangles);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(all, geometry, id);
    if (id == 1) rtcAttachGeometryByID(obstacle_alone, geometry, id);
    rtcReleaseGeometry(geometry);
  }

  void commit() {
    rtcCommitScene(all);
    rtcCommitScene(obstacle_alone);
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::runtime_error("no memory is left to draw a picture");
    if (error != RTC_ERROR_NONE)
      throw std::runtime_error("Embree, which draws pictures, fails with error " + std::to_string(error));
  }

  std::optional<SurfacePoint> nearest(RTCScene scene, const Ray& ray) const {
    RTCRayHit query = embree_ray(ray);
    intersect(scene, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    SurfacePoint point =
        surfaces[query.hit.geomID].point(static_cast<int>(query.hit.primID), query.hit.u, query.hit.v, ray);
    point.surface = query.hit.geomID == 0 ? SurfacePoint::Surface::cloth : SurfacePoint::Surface::obstacle;
    point.distance = query.ray.tfar;
    return point;
  }

  bool blocked(const Ray& ray, float length = std::numeric_limits<float>::infinity()) const {
    RTCRayHit query = embree_ray(ray, length);
    occlude(all, &query.ray);
    return query.ray.tfar < 0;
  }
};

RayScene::RayScene(const Drawing& drawing) : embree_(std::make_unique<Embree>()) {
  Eigen::AlignedBox3d box;
  for (const TriangleMesh* mesh : {&drawing.mesh, drawing.obstacle}) {
    if (!mesh) continue;
    for (Eigen::Index i = 0; i < mesh->vertices.rows(); ++i)
      if (mesh->vertices.row(i).allFinite()) box.extend(mesh->vertices.row(i).transpose());
  }
  if (box.isEmpty()) box.extend(Eigen::Vector3d::Zero());
  centre_ = box.center();
  radius_ = static_cast<float>(std::max(box.diagonal().norm() / 2, 1e-9));
  if (drawing.floor) floor_ = static_cast<float>(*drawing.floor - centre_[2]);
  embree_->surfaces[0] = DrawnSurface(drawing.mesh, centre_, smooth_normals(drawing.mesh));
  if (drawing.obstacle) {
    Positions normals;
    const TriangleMesh creased = split_at_creases(*drawing.obstacle, normals);
    embree_->surfaces[1] = DrawnSurface(creased, centre_, normals);
  }
  embree_->attach(0);
  embree_->attach(1);
  embree_->commit();
}

RayScene::~RayScene() = default;

std::optional<SurfacePoint> RayScene::nearest(const Ray& ray) const {
  std::optional<SurfacePoint> point = embree_->nearest(embree_->all, ray);
  if (floor_ && ray.direction()[2] < 0 && ray.origin()[2] > *floor_) {
    const float distance = (*floor_ - ray.origin()[2]) / ray.direction()[2];
    // Neither cloth that lies on the floor nor an obstacle that is the floor may flicker.
    const bool cloth = point && point->surface == SurfacePoint::Surface::cloth;
    const float level = *floor_ + (cloth ? -floor_margin : floor_margin) * radius_;
    if (!point || point->position[2] < level) {
      point.emplace();
      point->surface = SurfacePoint::Surface::floor;
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
  if (far && embree_->blocked({point->position + off_surface, bulge}, 1))
    point->light_origin = point->position;
  point->light_origin += off_surface;
  return point;
}

std::optional<SurfacePoint> RayScene::nearest_obstacle(const Ray& ray) const {
  return embree_->nearest(embree_->obstacle_alone, ray);
}

bool RayScene::blocked(const Ray& ray) const { return embree_->blocked(ray); }

}  // namespace drape
