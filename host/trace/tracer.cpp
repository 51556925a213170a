#include "host/trace/tracer.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "sim/error.hpp"

namespace understory {
namespace {

void refuse(RTCDevice device, const char* what) {
  const RTCError error = rtcGetDeviceError(device);
  if (error != RTC_ERROR_NONE)
    throw Error(ErrorKind::unexpected,
                std::string("Embree: ") + what + " failed with error " + std::to_string(static_cast<int>(error)));
}

RTCRay embree_ray(const Ray& ray) {
  RTCRay r{};
  r.org_x = ray.origin.x;
  r.org_y = ray.origin.y;
  r.org_z = ray.origin.z;
  r.tnear = ray.nearest;
  r.dir_x = ray.direction.x;
  r.dir_y = ray.direction.y;
  r.dir_z = ray.direction.z;
  r.tfar = ray.farthest;
  r.mask = 0xffffffffu;
  return r;
}

}  // namespace

struct Tracer::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  ~Impl() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
};

Tracer::Tracer(std::span<const glm::vec3> vertices, std::span<const std::uint32_t> triangles)
    : impl_(std::make_unique<Impl>()) {
  constexpr std::size_t most = std::size_t(1) << 31;
  if (vertices.size() > most || triangles.size() / 3 > most)
    throw Error(ErrorKind::invalid_input, "tracing allows at most 2^31 vertices and triangles");
  for (const std::uint32_t index : triangles)
    if (index >= vertices.size())
      throw Error(ErrorKind::invalid_input, "triangle index " + std::to_string(index) + " is out of range: there are " +
                                                std::to_string(vertices.size()) + " vertices");
  impl_->device = rtcNewDevice(nullptr);
  if (!impl_->device) throw Error(ErrorKind::unexpected, "Embree: no device");
  impl_->scene = rtcNewScene(impl_->device);
  rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
  if (!triangles.empty()) {
    RTCGeometry geometry = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                              vertices.size());
    void* corners = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            3 * sizeof(std::uint32_t), triangles.size() / 3);
    refuse(impl_->device, "allocating the triangles");
    std::memcpy(positions, vertices.data(), vertices.size_bytes());
    std::memcpy(corners, triangles.data(), triangles.size() / 3 * 3 * sizeof(std::uint32_t));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(impl_->scene, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(impl_->scene);
  refuse(impl_->device, "building the hierarchy");
}

Tracer::~Tracer() = default;
Tracer::Tracer(Tracer&&) noexcept = default;
Tracer& Tracer::operator=(Tracer&&) noexcept = default;

void Tracer::blocked(std::span<const Ray> rays, std::span<std::uint8_t> out) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RTCRay ray = embree_ray(rays[i]);
    rtcOccluded1(impl_->scene, &context, &ray);
    out[i] = ray.tfar < 0 ? 1 : 0;  // Embree writes -inf where something is in the way
  }
}

void Tracer::nearest(std::span<const Ray> rays, std::span<Hit> out) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RTCRayHit query{embree_ray(rays[i]), {}};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(impl_->scene, &context, &query);
    out[i] = {};
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
    // Embree's normal is (v1 - v0) x (v2 - v0), not normalised.
    const glm::vec3 normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
    out[i] = {query.ray.tfar, query.hit.primID, glm::dot(normal, rays[i].direction) < 0};
  }
}

}  // namespace understory
