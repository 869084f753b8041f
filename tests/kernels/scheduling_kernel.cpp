#include "tests/kernels/scheduling_kernel.h"

#include "razor/kernels/screen_curve.h"
#include "razor/kernels/stretches.h"

namespace razor::test::ISA_TARGET {

using namespace razor::ISA_TARGET;

namespace {

std::int32_t value(sint a) {
    std::int32_t word = 0;
    store(pointer<std::int32_t>(&word), a);
    return word;
}

} // namespace

void curve(const CurveArguments& a);
void curve(const CurveArguments& a) {
    for (int tile = 0; tile < a.columns * a.rows; ++tile) {
        TilePlace p = place_on_curve(sint(a.columns), sint(a.rows), sint(tile));
        store(pointer<std::int32_t>(a.column + tile), p.column);
        store(pointer<std::int32_t>(a.row + tile), p.row);
    }
}

void take(TakeArguments& a);
void take(TakeArguments& a) {
    Context c = make_context(pointer<FrameHeader>(a.frame), sint(a.worker));
    c.counters = a.counters;
    a.last = -1;
    for (int n = 0; n < a.runs; ++n) {
        Run run = a.least != 0 ? take_back(c, sint(a.least)) : take_run(c);
        if (branch(run.first == run.end))
            return;
        a.first_run = value(run.first);
        a.last = value(run.end) - 1;
        Run tiles = tiles_of(c, run);
        for (sint tile = tiles.first; branch(tile < tiles.end); ++tile)
            fetch_add(pointer<shared_int>(a.taken) + tile, sint(1));
    }
}

} // namespace razor::test::ISA_TARGET
