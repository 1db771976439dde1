// <texture>: the way from an effect to the file of a picture.
#pragma once

#include <pugixml.hpp>
#include <string>

#include "scenes/collada_document.h"

namespace lanewise::collada {

// What the <texture> of an effect calls its picture's file: by sampler, surface and <image> (COLLADA 1.4), by sampler and
// image (1.5), or, as some exporters write it, by the image's id. Fails for references that lead nowhere.
std::string image_file(const Document& document, pugi::xml_node effect, pugi::xml_node texture);

}  // namespace lanewise::collada
