// What a camera's rays meet and where mirrors and glass send them, in double precision and by the plainest means: where tests
// find the regions of a picture that they look at. For scenes of few triangles.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "core/scene.h"

namespace lanewise::test {

struct Ray {
  glm::dvec3 o, d;  // d: unit
};

struct Hit {
  const Material* material;
  const void* shape;  // the Mesh or Sphere
  glm::dvec3 p;
  glm::dvec3 n;  // unit, on the ray's side
  bool front;    // met from the front of the triangle, or from outside the sphere
};

// The nearest hit farther off than 1e-9.
std::optional<Hit> nearest(const Scene& scene, const Ray& ray);

// Whether a light shines along the ray towards its origin.
bool is_light(const std::optional<Hit>& hit);

// Whether the segment meets the sphere's inside.
bool meets(const Sphere& sphere, const glm::dvec3& from, const glm::dvec3& to);

Ray reflected(const Ray& ray, const Hit& hit);

// The ray that leaves a glass sphere in which the one that met it from outside has been refracted; nothing else is inside.
Ray refracted_through(const Ray& ray, const Hit& hit);

// Unpolarised reflectance of the glass that the ray meets from outside (Fresnel's equations).
double reflectance(const Ray& ray, const Hit& hit);

// The view that --view fit gives pictures of 480 x 360 pixels, as a camera of aspect 4 / 3 that gives it to any.
Camera fit_camera(const Scene& scene);

}  // namespace lanewise::test
