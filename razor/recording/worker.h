// A worker of a frame that is recorded: what the timing port does with its operations.
#pragma once

#include "isa/address_space.h"
#include "razor/recording/frame_recorder.h"
#include "razor/recording/turns.h"

#include <cstdint>

namespace razor {

/// All members but the constructor are called by the worker's thread, in its turn.
class FrameRecorder::Worker {
public:
    Worker(FrameRecorder& recorder, const isa::address_space& space, Turns& turns, std::size_t number)
        : recorder_(recorder), space_(space), turns_(turns), number_(number) {}

    /// An operation begins, maybe after other workers' turns.
    void step() {
        if (--left_ == 0)
            pass();
        ++recorder_.time_;
    }
    void pass() {
        left_ = turn_operations;
        turns_.pass(number_);
    }
    void at(const char* file, std::uint32_t line) { site_ = recorder_.site(file, line); }
    void note(traces::Kind kind, const void* p, std::uint32_t bytes);

    std::int32_t phase = 0, kind = 0;
    std::int64_t pixel = -1; // for which the first active lane works; -1: none

private:
    /// Long enough that changing threads costs little, short enough that workers share what they make.
    static constexpr std::uint32_t turn_operations = 2000;

    FrameRecorder& recorder_;
    const isa::address_space& space_;
    Turns& turns_;
    std::size_t number_;
    std::uint32_t left_ = turn_operations;
    std::uint64_t site_ = 0;
    std::size_t region_ = 0; // of the last reference
};

/// The one that this thread runs; null outside a recorded frame.
extern constinit thread_local FrameRecorder::Worker* recorded_worker;

} // namespace razor
