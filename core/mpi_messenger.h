// Ranks that mpirun has started.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/messenger.h"

namespace lanewise {

// Whether mpirun started this process, and its rank, 0 without mpirun: as the environment says.
bool is_launched();
uint32_t launched_rank();

// Between all processes of this mpirun; null without mpirun. Throws Error if it has started several
// and this program is built without MPI, and whatever MPI reports. At most one may be made in a process; it must be destroyed on
// the thread that made it, when every rank destroys its own.
std::unique_ptr<Messenger> mpi_messenger();

// The library's name and version; empty: none is built in.
std::string mpi_library();

}  // namespace lanewise
