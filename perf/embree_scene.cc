#include "perf/embree_scene.h"

#include <pmmintrin.h>
#include <xmmintrin.h>

#include <chrono>
#include <cmath>
#include <limits>

#include "core/types.h"

namespace lanewise::perf {
namespace {

template <class T>
T* new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, size_t stride, size_t count) {
  auto* data = static_cast<T*>(rtcSetNewGeometryBuffer(geometry, type, 0, format, stride, count));
  if (data == nullptr && count > 0) throw Error("embree: no memory for the geometry");
  return data;
}

void attach(RTCScene scene, RTCGeometry geometry) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

RTCRay make_ray(const Path<float>& p, float length) {
  RTCRay ray{};
  ray.org_x = p.o_x, ray.org_y = p.o_y, ray.org_z = p.o_z;
  ray.dir_x = p.d_x, ray.dir_y = p.d_y, ray.dir_z = p.d_z;
  ray.tfar = length;
  ray.mask = ~0u;
  return ray;
}

}  // namespace

EmbreeScene::EmbreeScene(const Scene& scene, const double (&center)[3])
    : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
  // Embree's manual asks for both.
  _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
  _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
  const auto relative = [&](const glm::dvec3& p, float* out) {
    for (int axis = 0; axis < 3; ++axis) out[axis] = static_cast<float>(p[axis] - center[axis]);
  };

  size_t vertices = 0;
  for (const Mesh& mesh : scene.meshes) vertices += mesh.positions.size();
  if (vertices > 0) {
    RTCGeometry triangles = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertex = new_buffer<float>(triangles, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 12, vertices);
    auto* index = new_buffer<uint32_t>(triangles, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, 12, scene.triangle_count());
    uint32_t first = 0;
    for (const Mesh& mesh : scene.meshes) {
      for (const glm::dvec3& p : mesh.positions) relative(p, vertex), vertex += 3;
      for (const auto& t : mesh.triangles) {
        for (const uint32_t v : t) *index++ = first + v;
      }
      first += static_cast<uint32_t>(mesh.positions.size());
    }
    attach(scene_, triangles);
  }
  if (!scene.spheres.empty()) {
    RTCGeometry spheres = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* ball = new_buffer<float>(spheres, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 16, scene.spheres.size());
    for (const Sphere& s : scene.spheres) {
      relative(s.center, ball);
      ball[3] = static_cast<float>(s.radius);
      ball += 4;
    }
    attach(scene_, spheres);
  }
  const auto start = std::chrono::steady_clock::now();
  rtcCommitScene(scene_);
  build_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) throw Error("embree: cannot build the scene");
}

EmbreeScene::~EmbreeScene() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void EmbreeScene::intersect(std::vector<RTCRayHit>& rays) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (RTCRayHit& ray : rays) rtcIntersect1(scene_, &context, &ray);
}

void EmbreeScene::occluded(std::vector<RTCRay>& rays) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (RTCRay& ray : rays) rtcOccluded1(scene_, &context, &ray);
}

std::vector<RTCRay> embree_rays(const RaySet& set) {
  std::vector<RTCRay> rays;
  rays.reserve(set.rays());
  for (size_t w = 0; w < set.waves.size(); ++w) {
    for (uint32_t i = 0; i < set.counts[w]; ++i) {
      Path<float> p = load_path<float>(set.waves[w].state(), i);
      if (set.shadow) {
        const float side = std::copysign(p.err, p.l_x * p.n_x + p.l_y * p.n_y + p.l_z * p.n_z);
        p.o_x += side * p.n_x, p.o_y += side * p.n_y, p.o_z += side * p.n_z;
        p.d_x = p.l_x, p.d_y = p.l_y, p.d_z = p.l_z;
      }
      rays.push_back(make_ray(p, set.shadow ? 1.0f : std::numeric_limits<float>::infinity()));
    }
  }
  return rays;
}

}  // namespace lanewise::perf
