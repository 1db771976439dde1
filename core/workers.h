// Threads that share out the items of a list, with progress for the one who waits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "core/render.h"

namespace lanewise {

// Runs body(item, worker) for items 0 .. items - 1 on `threads` threads, or fewer if there are fewer items or the machine gives
// fewer threads, each item once, in rising order of their start. body returns the number of rays it traced. progress is called
// from the calling thread. If a body or progress throws, no further item starts, and the first exception is thrown again here.
void run_workers(uint32_t threads, size_t items, const std::function<uint64_t(size_t item, uint32_t worker)>& body,
                 const std::function<void(const Progress&)>& progress);

// Runs body(row) for the rows 0 .. rows - 1 of a picture in the same way.
void for_each_row(uint32_t threads, uint32_t rows, const std::function<void(uint32_t row)>& body);

}  // namespace lanewise
