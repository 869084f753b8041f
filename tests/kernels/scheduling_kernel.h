// razor/kernels/screen_curve.h and stretches.h, once a target, for their tests.
#pragma once

#include "razor/frame/layout.h"

namespace razor {
struct Counters;
}

namespace razor::test {

struct CurveArguments {
    int columns = 0, rows = 0;
    std::int32_t *column = nullptr, *row = nullptr; // results: of each tile
};

struct TakeArguments {
    FrameHeader* frame = nullptr;
    int worker = 0;
    Counters* counters = nullptr;
    /// Times each tile was taken, by all workers.
    isa::shared<std::int32_t>* taken = nullptr;
    int runs = 0;                 // taken at most
    int least = 0;                // not 0: take_back() with it; else take_run()
    int first_run = 0, last = -1; // results: the last run's strides, first to last; -1: there was none
};

} // namespace razor::test
