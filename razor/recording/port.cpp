// The timing port of a frame that is recorded (isa/simulated/port.h), or of packets whose memory is measured:
// operations pass, loads and stores are noted. What lanes load or store side by side is one reference, what
// they gather and scatter one each.
#include "isa/simulated/port.h"

#include "isa/services.h"
#include "razor/recording/touched_lines.h"
#include "razor/recording/worker.h"

#include <bit>
#include <utility>

namespace isa::timing {
namespace {

using razor::measured_lines;
using razor::recorded_worker;
using traces::Kind;

/// Other threads may run meanwhile: whoever comes back looks again at what is its own.
[[gnu::noinline]] stamp step() {
    if (razor::FrameRecorder::Worker* worker = recorded_worker)
        worker->step();
    return {};
}

void note(site where, Kind kind, const void* p, std::uint32_t bytes) {
    if (razor::FrameRecorder::Worker* worker = recorded_worker) {
        worker->step();
        worker->at(where.file, where.line);
        worker->note(kind, p, bytes);
    } else if (measured_lines != nullptr && bytes > 0) {
        measured_lines->note(p, bytes);
    }
}

void note_lanes(site where, Kind kind, const void* p, std::uint64_t lanes) {
    razor::FrameRecorder::Worker* worker = recorded_worker;
    if (worker == nullptr) {
        if (measured_lines != nullptr)
            for (std::uint64_t left = lanes; left != 0; left &= left - 1)
                measured_lines->note(static_cast<const float*>(p) + std::countr_zero(left), 4);
        return;
    }
    worker->step();
    worker->at(where.file, where.line);
    const auto* bytes = static_cast<const std::byte*>(p);
    while (lanes != 0) { // runs of lanes, from the first on
        const int begin = std::countr_zero(lanes), count = std::countr_one(lanes >> begin);
        worker->note(kind, bytes + 4 * begin, static_cast<std::uint32_t>(4 * count));
        if (begin + count == 64)
            break;
        lanes &= ~std::uint64_t{0} << (begin + count);
    }
}

void note_indexed(site where, Kind kind, const void* p, const std::int32_t* index, std::uint64_t lanes) {
    razor::FrameRecorder::Worker* worker = recorded_worker;
    if (worker == nullptr) {
        if (measured_lines != nullptr)
            for (std::uint64_t left = lanes; left != 0; left &= left - 1)
                measured_lines->note(static_cast<const std::int32_t*>(p) + index[std::countr_zero(left)], 4);
        return;
    }
    worker->step();
    worker->at(where.file, where.line);
    for (; lanes != 0; lanes &= lanes - 1)
        worker->note(kind, static_cast<const std::int32_t*>(p) + index[std::countr_zero(lanes)], 4);
}

} // namespace

stamp vector_op(operation, const stamp&) {
    return step();
}
stamp vector_op(operation, const stamp&, const stamp&) {
    return step();
}
stamp vector_op(operation, const stamp&, const stamp&, const stamp&) {
    return step();
}
stamp cross_op(operation, const stamp&, const stamp&) {
    return step();
}
stamp cross_to_scalar(operation, const stamp&, const stamp&) {
    return step();
}
stamp scalar_op(operation, const stamp&) {
    return step();
}
stamp scalar_op(operation, const stamp&, const stamp&) {
    return step();
}
stamp scalar_op(operation, const stamp&, const stamp&, const stamp&) {
    return step();
}
void branch(site, const stamp&, bool) {
    step();
}

stamp load(site where, const void* p, std::uint32_t bytes, const stamp&) {
    note(where, Kind::read, p, bytes);
    return {};
}
stamp load_broadcast(site where, const void* p, std::uint32_t bytes, const stamp&) {
    note(where, Kind::read, p, bytes);
    return {};
}
stamp load_vector(site where, const void* p, std::uint64_t lanes, const stamp&, const stamp&) {
    note_lanes(where, Kind::read, p, lanes);
    return {};
}
stamp gather(site where, const void* p, const std::int32_t* index, std::uint64_t lanes, const stamp&,
             const stamp&, const stamp&) {
    note_indexed(where, Kind::read, p, index, lanes);
    return {};
}
void store(site where, const void* p, std::uint32_t bytes, const stamp&, const stamp&) {
    note(where, Kind::write, p, bytes);
}
void store_vector(site where, const void* p, std::uint64_t lanes, const stamp&, const stamp&, const stamp&) {
    note_lanes(where, Kind::write, p, lanes);
}
void scatter(site where, const void* p, const std::int32_t* index, std::uint64_t lanes, const stamp&,
             const stamp&, const stamp&, const stamp&) {
    note_indexed(where, Kind::write, p, index, lanes);
}
void prefetch(site where, const void* p, const stamp&) {
    note(where, Kind::prefetch, p, 0);
}
void discard(site where, const void* p, std::uint32_t bytes, const stamp&) {
    note(where, Kind::flush, p, bytes);
}

void before_atomic(site where, atomic kind, const void* p, const stamp&, const stamp&) {
    note(where,
         kind == atomic::load_acquire    ? Kind::read
         : kind == atomic::store_release ? Kind::write
                                         : Kind::modify,
         p, 4);
}
stamp after_atomic(site, atomic, const void*, bool) {
    return {};
}
stamp wait_while(site where, const std::int32_t* p, std::int32_t value, const stamp&, const stamp&) {
    note(where, Kind::read, p, 4);
    while (__atomic_load_n(p, __ATOMIC_ACQUIRE) == value)
        if (razor::FrameRecorder::Worker* worker = recorded_worker)
            worker->pass();
    return {};
}

void request_page(void* service, std::int32_t space, std::int32_t kind, std::int32_t index) {
    static_cast<isa::page_service*>(service)->make_page(space, kind, index);
}
std::int32_t set_phase(std::int32_t phase) {
    razor::FrameRecorder::Worker* worker = recorded_worker;
    return worker == nullptr ? 0 : std::exchange(worker->phase, phase);
}
std::int32_t set_kind(std::int32_t kind) {
    if (measured_lines != nullptr)
        return std::exchange(measured_lines->kind, kind);
    razor::FrameRecorder::Worker* worker = recorded_worker;
    return worker == nullptr ? 0 : std::exchange(worker->kind, kind);
}
/// Words for whom it was before are pixels, from 1 on.
std::uint64_t set_owners(const std::int32_t* owner, std::uint64_t lanes) {
    razor::FrameRecorder::Worker* worker = recorded_worker;
    if (worker == nullptr)
        return 0;
    const std::int64_t pixel = lanes == 0 ? -1 : owner[std::countr_zero(lanes)];
    return static_cast<std::uint64_t>(std::exchange(worker->pixel, pixel) + 1);
}
/// All lanes of a packet are of one tile.
std::uint64_t narrow_owners(std::uint64_t) {
    razor::FrameRecorder::Worker* worker = recorded_worker;
    return worker == nullptr ? 0 : static_cast<std::uint64_t>(worker->pixel + 1);
}
void restore_owners(std::uint64_t before) {
    if (razor::FrameRecorder::Worker* worker = recorded_worker)
        worker->pixel = static_cast<std::int64_t>(before) - 1;
}
void note_level(const void*, std::uint64_t, std::int32_t) {}
void note_level_of(const void*, std::uint64_t, const void*) {}

} // namespace isa::timing
