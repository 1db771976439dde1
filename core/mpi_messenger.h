// Ranks that mpirun has started.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/messenger.h"

namespace lanewise {

// Whether mpirun started this process as one of several: as the environment says.
bool is_launched();

// Between all processes of this mpirun; null without one, or alone. Throws Error if there are several and this program is built
// without MPI; what MPI itself finds wrong ends all of them. At most one may be made in a process; it must be destroyed on the thread
// that made it, when every rank destroys its own.
std::unique_ptr<Messenger> mpi_messenger();

// The library's name and version; empty: none is built in.
std::string mpi_library();

}  // namespace lanewise
