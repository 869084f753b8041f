// Taking tiles: from the front of the worker's own stretch of the screen's curve, and when that is used up
// the back half of another's, of those who share its tree first and of near ones before far ones
// (razor/frame/stretches.h).
#pragma once

#include "razor/kernels/context.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

/// Strides taken, or the tiles in them: first ... end - 1. None: there was nothing left.
struct Run {
    sint first, end;
};

inline sint length_code(sint word) {
    return word & ((1 << stretch_bits) - 1);
}
inline sint length_of_code(sint code) {
    sint bits = (code + stretch_bias) << stretch_shift;
    return to_int(as_float(bits));
}
/// Of a length rounded down to one that can be written.
inline sint code_of_length(sint length) {
    sint bits = as_int(to_float(length)) >> stretch_shift;
    return max(bits - stretch_bias, sint(0));
}

/// A run from the front of the worker's own stretch: what leaves the next shorter length that can be written.
inline Run take_own(const Context& c, pointer<shared_int> own) {
    sint word = load_acquire(own);
    for (;;) {
        sint code = length_code(word);
        if (branch(code == 0))
            return {0, 0};
        sint begin = word >> stretch_bits;
        sint length = length_of_code(code);
        sint left = code_of_length(length - 1);
        sint end = begin + length;
        end = end - length_of_code(left);
        sint rest = (end << stretch_bits) | left;
        sint seen = compare_exchange(own, word, rest);
        if (branch(seen == word))
            return {begin, end};
        tally(c.counters->lost_races, 1);
        word = seen; // a thief was faster
    }
}

/// The back half of a stretch, if there is anything left of it: a run of it, the rest for the worker's own.
inline Run steal_from(const Context& c, pointer<shared_int> victim, pointer<shared_int> own) {
    sint word = load_acquire(victim);
    for (;;) {
        sint code = length_code(word);
        if (branch(code == 0))
            return {0, 0};
        sint begin = word >> stretch_bits;
        sint length = length_of_code(code);
        sint kept = code_of_length(length >> 1);
        sint left = (begin << stretch_bits) | kept;
        sint seen = compare_exchange(victim, word, left);
        if (branch(seen == word)) {
            sint first = begin + length_of_code(kept);
            sint end = begin + length;
            tally(c.counters->steals, 1);
            tally(c.counters->stolen_strides, end - first);
            sint rest = code_of_length(end - first - 1);
            sint next = end - length_of_code(rest);
            sint mine = (next << stretch_bits) | rest;
            store_release(own, mine); // which was empty: nobody else writes it
            return {first, next};
        }
        tally(c.counters->lost_races, 1);
        word = seen;
    }
}

/// A run from the back of the worker's own stretch, where others do not look for the same nodes; none if less
/// than `least` strides are left.
[[gnu::noinline]] inline Run take_back(const Context& c, sint least) {
    pointer<StretchRecord> stretches = load(field(c.frame, &FrameHeader::stretches));
    sint place = load(field(c.self, &WorkerRecord::place));
    pointer<shared_int> own = field(stretches + place, &StretchRecord::left);
    sint word = load_acquire(own);
    for (;;) {
        sint length = length_of_code(length_code(word));
        if (branch(length < least))
            return {0, 0};
        sint begin = word >> stretch_bits;
        sint end = begin + length;
        sint left = code_of_length(length - 1);
        sint rest = (begin << stretch_bits) | left;
        sint seen = compare_exchange(own, word, rest);
        if (branch(seen == word))
            return {begin + length_of_code(left), end};
        tally(c.counters->lost_races, 1);
        word = seen;
    }
}

/// From whoever has something left. Places that differ in low bits alone are near, so that nobody's victims
/// come in the same order as another's.
[[gnu::noinline]] inline Run steal(const Context& c, pointer<StretchRecord> stretches, sint place) {
    pointer<shared_int> own = field(stretches + place, &StretchRecord::left);
    sint workers = load(field(c.frame, &FrameHeader::worker_count));
    sint span = load(field(c.frame, &FrameHeader::place_span));
    sint first = load(field(c.tree, &TreeRecord::first_place));
    sint end = load(field(c.tree, &TreeRecord::end_place));
    for (sint others = 0; branch(others < 2); ++others) {
        for (sint apart = 1; branch(apart < span); ++apart) {
            sint victim = place ^ apart;
            sbool shares = victim >= first;
            shares = shares & (victim < end);
            sbool wanted = shares ^ (others != 0);
            wanted = wanted & (victim < workers);
            if (branch(wanted)) {
                Run run = steal_from(c, field(stretches + victim, &StretchRecord::left), own);
                if (branch(run.first < run.end))
                    return run;
            }
        }
    }
    return {0, 0};
}

/// The next strides for this worker.
inline Run take_run(const Context& c) {
    pointer<StretchRecord> stretches = load(field(c.frame, &FrameHeader::stretches));
    sint place = load(field(c.self, &WorkerRecord::place));
    Run run = take_own(c, field(stretches + place, &StretchRecord::left));
    if (branch(run.first == run.end))
        run = steal(c, stretches, place);
    return run;
}

/// The tiles of a run's strides.
inline Run tiles_of(const Context& c, const Run& run) {
    sint first = load(field(c.frame, &FrameHeader::tiles_first));
    sint end = load(field(c.frame, &FrameHeader::tiles_end));
    sint stride = load(field(c.frame, &FrameHeader::stride_log2));
    Run tiles;
    tiles.first = first + (run.first << stride);
    tiles.end = first + (run.end << stride);
    tiles.end = min(tiles.end, end);
    return tiles;
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
