#pragma once

namespace lanewise {

inline constexpr char kVersion[] = "0.1.0";  // the project's, as in CMakeLists.txt

}  // namespace lanewise
