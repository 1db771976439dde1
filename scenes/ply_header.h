// The header of a Stanford PLY file, before a library trusts it.
#pragma once

#include <string>

namespace lanewise {

// The same file with a header written anew: Assimp 5.2 loops for ever on some that are broken, and allocates what
// others ask for. Throws Error, naming the path, unless the text begins with a PLY header of vertices with x, y, z, in
// a known format, and holds at least the bytes that its elements need.
std::string checked_ply(const std::string& path, const std::string& text);

}  // namespace lanewise
