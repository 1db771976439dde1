// How much a scene's nodes come to, before anything is built from them.
#pragma once

#include <pugixml.hpp>

#include "scenes/collada_document.h"
#include "scenes/collada_library.h"

namespace lanewise::collada {

// Fails if the nodes below root (a <visual_scene>), with all that they instantiate, contain themselves, lie more than
// 1000 deep, number above 1 million or hold more than 2^26 triangles. Takes time linear in the file even where
// instances of instances multiply to astronomical numbers.
void check_size(const Document& document, Library& library, pugi::xml_node root);

}  // namespace lanewise::collada
