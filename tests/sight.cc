#include "tests/sight.h"

#include <cmath>

namespace lanewise::test {
namespace {

using glm::dvec3;

constexpr double kNear = 1e-9;

// Distance to the sphere along the ray; 0: none.
double distance_to(const Sphere& sphere, const Ray& ray) {
  const dvec3 to = sphere.center - ray.o;
  const double along = glm::dot(to, ray.d);
  const double square = sphere.radius * sphere.radius - glm::dot(to, to) + along * along;
  if (square < 0) return 0;
  const double first = along - std::sqrt(square), second = along + std::sqrt(square);
  return first > kNear ? first : second > kNear ? second : 0;
}

// Cramer's rule.
double distance_to(const dvec3& a, const dvec3& b, const dvec3& c, const Ray& ray) {
  const dvec3 e1 = b - a, e2 = c - a, s = ray.o - a;
  const double det = -glm::dot(ray.d, glm::cross(e1, e2));
  if (det == 0) return 0;
  const double u = -glm::dot(ray.d, glm::cross(s, e2)) / det, v = -glm::dot(ray.d, glm::cross(e1, s)) / det;
  const double t = glm::dot(s, glm::cross(e1, e2)) / det;
  return u >= 0 && v >= 0 && u + v <= 1 && t > kNear ? t : 0;
}

dvec3 refract(const dvec3& d, const dvec3& n, double ratio) {
  const double cosine = -glm::dot(d, n);
  return ratio * d + (ratio * cosine - std::sqrt(1 - ratio * ratio * (1 - cosine * cosine))) * n;
}

}  // namespace

std::optional<Hit> nearest(const Scene& scene, const Ray& ray) {
  double closest = 1e300;
  std::optional<Hit> hit;
  const auto take = [&](double t, uint32_t material, const void* shape, const dvec3& normal) {
    if (t == 0 || t >= closest) return;
    closest = t;
    const bool front = glm::dot(normal, ray.d) < 0;
    hit = Hit{&scene.materials[material], shape, ray.o + t * ray.d, front ? normal : -normal, front};
  };
  for (const Sphere& sphere : scene.spheres) {
    const double t = distance_to(sphere, ray);
    take(t, sphere.material, &sphere, glm::normalize(ray.o + t * ray.d - sphere.center));
  }
  for (const Mesh& mesh : scene.meshes) {
    for (const auto& [i, j, k] : mesh.triangles) {
      const dvec3 &a = mesh.positions[i], &b = mesh.positions[j], &c = mesh.positions[k];
      take(distance_to(a, b, c, ray), mesh.material, &mesh, glm::normalize(glm::cross(b - a, c - a)));
    }
  }
  return hit;
}

bool is_light(const std::optional<Hit>& hit) {
  return hit && hit->material->kind == Material::Kind::kEmission && hit->front;
}

bool meets(const Sphere& sphere, const dvec3& from, const dvec3& to) {
  const double length = glm::length(to - from);
  const dvec3 d = (to - from) / length;
  const double along = glm::clamp(glm::dot(sphere.center - from, d), 0.0, length);
  return glm::length(from + along * d - sphere.center) < sphere.radius;
}

Ray reflected(const Ray& ray, const Hit& hit) { return {hit.p, glm::reflect(ray.d, hit.n)}; }

Ray refracted_through(const Ray& ray, const Hit& hit) {
  const Sphere& sphere = *static_cast<const Sphere*>(hit.shape);
  const Ray inside{hit.p, refract(ray.d, hit.n, 1 / hit.material->ior)};
  const dvec3 exit = hit.p + 2 * glm::dot(sphere.center - hit.p, inside.d) * inside.d;
  return {exit, refract(inside.d, glm::normalize(sphere.center - exit), hit.material->ior)};
}

double reflectance(const Ray& ray, const Hit& hit) {
  const double ior = hit.material->ior, in = -glm::dot(ray.d, hit.n), out = std::sqrt(1 - (1 - in * in) / (ior * ior));
  const double s = (in - ior * out) / (in + ior * out), p = (out - ior * in) / (out + ior * in);
  return (s * s + p * p) / 2;
}

Camera fit_camera(const Scene& scene) {
  Camera camera = scene.cameras.at(0);
  const Bounds box = bounds(scene);
  const double tan_y = std::tan(camera.xfov / 2) / camera.aspect;
  camera.to_world[3] = glm::dvec4(box.center() + 1.5 * box.diagonal() * dvec3(camera.to_world[2]), 1);
  camera.xfov = 2 * std::atan(240 * 2 * tan_y / 600);
  camera.aspect = 4.0 / 3.0;
  return camera;
}

}  // namespace lanewise::test
