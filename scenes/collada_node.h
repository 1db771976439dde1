// <node>: the tree whose leaves are the scene's meshes, spheres, cameras and lights.
#pragma once

#include <glm/glm.hpp>
#include <pugixml.hpp>
#include <vector>

#include "core/scene.h"
#include "scenes/collada_document.h"
#include "scenes/collada_library.h"
#include "scenes/collada_light.h"

namespace lanewise::collada {

// Adds all that lies below the node to the scene, in world space; area lights are returned instead, since which of them
// shine depends on every mesh. check_size must have passed. Fails for transforms that are singular in their product and
// for spheres that they would make ellipsoids.
std::vector<AreaLight> instantiate(const Document& document, Library& library, pugi::xml_node node,
                                   const glm::dmat4& to_world, Scene& scene);

}  // namespace lanewise::collada
