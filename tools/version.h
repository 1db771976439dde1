#pragma once

namespace lanewise {

inline constexpr char kVersion[] = LANEWISE_VERSION;  // the project's, from CMakeLists.txt

}  // namespace lanewise
