// Writes what the tiles of a run note as a trace: between windows, tile after tile, so that the file does not
// depend on the host's threads. Looks at the run and changes nothing.
#pragma once

#include "sim/config/config.h"
#include "sim/machine/report.h"
#include "sim/trace/tap.h"
#include "traces/background_writer.h"

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sim {

/// What is wanted of a trace. Spans hold both ends; what is not given is not left out.
struct TraceSettings {
    std::string level = "core"; // core, l1, l2, ..., dram
    std::vector<std::string> structures, phases;
    struct Span {
        std::uint64_t first = 0, last = ~std::uint64_t{0};
        bool all() const { return first == 0 && last == ~std::uint64_t{0}; }
    };
    Span tiles, cores;                                // cores of the chip, numbered through
    std::uint64_t begin = 0, end = ~std::uint64_t{0}; // cycles, `end` no more
    double sample = 1;                                // of all lines
    traces::Picture picture;                          // whose pixels owners of work are, if any
    std::string program, configuration;               // for the trace's description
};

class LineSharing;

class Recorder {
public:
    /// Throws ConfigError where the settings do not fit the machine.
    Recorder(TraceSettings settings, const Config& config, std::unique_ptr<traces::Sink> sink);

    /// Writes nothing: all that cores do is for `sharing` to see.
    Recorder(const Config& config, LineSharing& sharing);
    LineSharing* sharing() const { return sharing_; } // or null

    /// A run begins; once. Throws ConfigError where there is no such structure or phase.
    void begin(const Labels& labels, const std::vector<std::string>& structures,
               std::vector<traces::Description::Region> regions);
    TraceTap& tap(std::size_t tile) { return taps_[tile]; }
    /// From this cycle on the run counts, and so does the trace.
    void start(std::uint64_t cycle);
    /// A window of time begins, from `begin` to `until`.
    void window(std::uint64_t until, std::uint64_t begin);
    /// Takes what the tiles, or one of them, have noted by now: in the order in which that happened.
    void collect();
    void collect(std::size_t tile);
    /// The workers have returned by cycle `until`, memory is served as far as `begin`.
    void end(std::uint64_t until, std::uint64_t begin);
    /// After that, a level of caches has written back what it had, and all of it is served.
    void settled();
    /// The run has ended well: ends the file, which gets its name. Throws traces::Error.
    void finish();

    std::uint64_t references() const { return writer_->references(); }
    std::uint64_t bytes() const { return writer_->bytes(); }

private:
    struct Names { // of a tile's sites: ours, by its numbers
        std::vector<std::uint32_t> number{0};
    };
    /// Whether tiles by themselves make what is recorded.
    bool is_of_tiles() const { return filter_.level <= config_.tile_levels(); }
    std::vector<std::string> stream_names() const;
    std::string filters_text() const;
    void learn_sites(std::size_t tile);
    void pass_idle_window();

    TraceSettings settings_;
    const Config config_;
    LineSharing* sharing_ = nullptr;
    std::unique_ptr<traces::Sink> sink_;
    TraceTap::Filter filter_;
    std::size_t phases_ = 1;
    std::deque<TraceTap> taps_;          // by tile
    std::vector<Names> names_;           // likewise
    std::optional<traces::Turn> window_; // at hand, of which nothing is noted yet
    std::optional<traces::Turn> end_;    // when that is over
    std::uint64_t origin_ = 0;           // the cycle from which on the run counts
    std::map<std::string, std::uint32_t> sites_;
    std::optional<traces::BackgroundWriter> writer_;
};

} // namespace sim
