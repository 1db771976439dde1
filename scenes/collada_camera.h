// <camera>: perspective cameras.
#pragma once

#include <glm/glm.hpp>
#include <pugixml.hpp>

#include "core/scene.h"
#include "scenes/collada_document.h"

namespace lanewise::collada {

// The camera seen from its node. A node's scale and mirroring do not reach the frame, which is made of rotation and
// place alone. Of xfov, yfov and aspect_ratio two say all (xfov and aspect_ratio win if there are three); an aspect
// ratio that is not given is 4/3; znear and zfar are left out. Fails for orthographic cameras and fields of view not in
// (0, 180).
Camera read_camera(const Document& document, pugi::xml_node element, const glm::dmat4& to_world);

}  // namespace lanewise::collada
