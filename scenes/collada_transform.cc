#include "scenes/collada_transform.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <vector>

namespace lanewise::collada {
namespace {

double radians(double degrees) { return degrees * (std::numbers::pi / 180); }

glm::dvec3 unit(const Document& document, pugi::xml_node node, const glm::dvec3& v) {
  const double length = glm::length(v);
  if (!(length > 0 && std::isfinite(length))) document.fail(node, "an axis has no direction");
  return v / length;
}

glm::dmat4 matrix(const Document& document, pugi::xml_node node) {
  const std::vector<double> v = document.numbers(node, 16);
  if (v[12] != 0 || v[13] != 0 || v[14] != 0 || v[15] != 1) document.fail(node, "the last row is not 0 0 0 1");
  glm::dmat4 m;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) m[column][row] = v[4 * row + column];
  }
  return m;
}

glm::dmat4 look_at(const Document& document, pugi::xml_node node) {
  const std::vector<double> v = document.numbers(node, 9);
  const glm::dvec3 eye(v[0], v[1], v[2]);
  const glm::dvec3 z = unit(document, node, eye - glm::dvec3(v[3], v[4], v[5]));
  const glm::dvec3 x = unit(document, node, glm::cross(glm::dvec3(v[6], v[7], v[8]), z));
  return {glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), glm::dvec4(eye, 1)};
}

// RenderMan's skew: a shear along t that turns the axis a by the angle towards t and keeps what is at right angles to
// both.
glm::dmat4 skew(const Document& document, pugi::xml_node node) {
  const std::vector<double> v = document.numbers(node, 7);
  const glm::dvec3 a = unit(document, node, {v[1], v[2], v[3]});
  const glm::dvec3 t = unit(document, node, {v[4], v[5], v[6]});
  const double cosine = glm::dot(a, t);
  const double sine = glm::length(glm::cross(a, t));
  const double tangent = std::tan(radians(v[0]));
  const double reach = sine - cosine * tangent;
  if (!(std::abs(v[0]) < 90 && sine > 1e-6 && reach > 1e-6)) document.fail(node, "the skew is singular");
  const glm::dvec3 along = (tangent / reach / (sine * sine)) * (a - cosine * t);  // shear per unit of position
  return glm::dmat4(glm::dmat3(1.0) + glm::outerProduct(t, along));
}

// Quarter turns come out exact, so that walls placed by them meet.
glm::dmat4 rotate(const Document& document, pugi::xml_node node) {
  const std::vector<double> v = document.numbers(node, 4);
  const glm::dvec3 a = unit(document, node, {v[0], v[1], v[2]});
  int quarters = 0;
  const double rest = radians(std::remquo(v[3], 90.0, &quarters));
  double cosine = std::cos(rest);
  double sine = std::sin(rest);
  for (int i = 0; i < (quarters & 3); ++i) {
    const double turned = cosine;
    cosine = -sine;
    sine = turned;
  }
  const glm::dmat3 cross(glm::dvec3(0, a.z, -a.y), glm::dvec3(-a.z, 0, a.x), glm::dvec3(a.y, -a.x, 0));
  return glm::dmat4(cosine * glm::dmat3(1.0) + sine * cross + (1 - cosine) * glm::outerProduct(a, a));
}

glm::dvec3 triple(const Document& document, pugi::xml_node node) {
  const std::vector<double> v = document.numbers(node, 3);
  return {v[0], v[1], v[2]};
}

// Identity for elements that are no transform.
glm::dmat4 element_transform(const Document& document, pugi::xml_node node) {
  const char* name = node.name();
  const glm::dmat4 identity(1.0);
  if (std::strcmp(name, "matrix") == 0) return matrix(document, node);
  if (std::strcmp(name, "translate") == 0) return glm::translate(identity, triple(document, node));
  if (std::strcmp(name, "scale") == 0) return glm::scale(identity, triple(document, node));
  if (std::strcmp(name, "lookat") == 0) return look_at(document, node);
  if (std::strcmp(name, "skew") == 0) return skew(document, node);
  if (std::strcmp(name, "rotate") == 0) return rotate(document, node);
  return identity;
}

}  // namespace

glm::dmat4 asset_transform(const Document& document) {
  const pugi::xml_node asset = document.root().child("asset");
  glm::dmat4 axes(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 0, 1, 0), glm::dvec4(0, -1, 0, 0), glm::dvec4(0, 0, 0, 1));
  if (const pugi::xml_node up = asset.child("up_axis")) {
    const char* name = up.child_value();
    if (std::strstr(name, "Z_UP") != nullptr) {
      axes = glm::dmat4(1.0);
    } else if (std::strstr(name, "X_UP") != nullptr) {
      // The specification's x up has -y to the right and z towards the viewer.
      axes =
          glm::dmat4(glm::dvec4(0, 0, 1, 0), glm::dvec4(-1, 0, 0, 0), glm::dvec4(0, -1, 0, 0), glm::dvec4(0, 0, 0, 1));
    } else if (std::strstr(name, "Y_UP") == nullptr) {
      document.fail(up, quoted(name) + " is none of X_UP, Y_UP and Z_UP");
    }
  }
  const pugi::xml_node unit_element = asset.child("unit");
  const double meter = document.attribute_number(unit_element, "meter").value_or(1.0);
  if (!(meter > 0))
    document.fail(unit_element, "a unit of " + quoted(unit_element.attribute("meter").value()) + " metres");
  return glm::scale(axes, glm::dvec3(meter));
}

glm::dmat4 node_transform(const Document& document, pugi::xml_node node) {
  glm::dmat4 product(1.0);
  for (const pugi::xml_node element : node.children()) {
    const glm::dmat4 m = element_transform(document, element);
    if (!invertible(m)) document.fail(element, "the transform is singular");
    product = product * m;
  }
  return product;
}

}  // namespace lanewise::collada
