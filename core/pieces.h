// Work in pieces, which stops to be saved and goes on.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "core/render_control.h"
#include "core/workers.h"

namespace lanewise {

// Draws the pieces, so many workers at a time, until none is left, with pauses to save state(), a SavedRender, where that is due.
// False if it was left before: the render is stopped, or enough().
// pieces(): a vector of those that are left. draw(piece, worker, rays): adds the rays that it took to `rays`, and says whether the
// piece is done; from any thread. report(share): of the pieces that are done, some ten times a second. rays: of all that is drawn.
template <class Pieces, class DrawPiece, class Report, class State, class Enough>
bool draw_pieces(uint32_t workers, Intervals& intervals, uint64_t& rays, const Pieces& pieces, const DrawPiece& draw,
                 const Report& report, const State& state, const Enough& enough) {
  size_t all = 0, left = 0;
  do {
    const auto some = pieces();
    left = some.size();
    if (all == 0) all = left;
    std::atomic<size_t> done{0};
    const uint64_t rays_before = rays;
    run_workers(
        workers, some.size(),
        [&](size_t item, uint32_t worker) {
          uint64_t traced = 0;
          if (!intervals.pausing() && draw(some[item], worker, traced)) {
            ++done;
            intervals.drew();
          }
          return traced;
        },
        [&](const Progress& pass) {
          rays = rays_before + pass.rays;
          report(all > 0 ? 1 - static_cast<double>(left - done) / static_cast<double>(all) : 1);
        });
    left -= done;
    if (intervals.save_due()) intervals.save(state);
  } while (left > 0 && !intervals.stopped() && !enough());
  return left == 0;
}

}  // namespace lanewise
