#include "sim/trace/recorder.h"

#include "sim/config/error.h"
#include "sim/machine/windows.h"
#include "sim/trace/line_sharing.h"
#include "traces/site_name.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <utility>

namespace sim {
namespace {

/// Streams of many threads take some references each until what is written of them repeats itself.
constexpr std::size_t block_references = std::size_t{1} << 18;

unsigned level_of(const std::string& name, const Config& config) {
    const unsigned levels = config.cache_levels();
    if (name == "core")
        return TraceLevel::core;
    if (name == "dram")
        return TraceLevel::memory;
    for (unsigned level = 1; level <= levels; ++level)
        if (name == fmt::format("l{}", level))
            return level;
    throw ConfigError(
        fmt::format("--trace-level {}: there is no such level; this machine has core, l1 to l{}, "
                    "dram",
                    name, levels));
}

/// Which of `names` are wanted: all if none is named.
std::vector<bool> chosen(const char* option, const std::vector<std::string>& wanted,
                         const std::vector<std::string>& names) {
    std::vector<bool> out(names.size(), wanted.empty());
    for (const std::string& name : wanted) {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end())
            throw ConfigError(fmt::format("{} {}: there is no such name; this run has {}", option, name,
                                          fmt::join(names, ", ")));
        out[static_cast<std::size_t>(found - names.begin())] = true;
    }
    return out;
}

} // namespace

Recorder::Recorder(TraceSettings settings, const Config& config, std::unique_ptr<traces::Sink> sink)
    : settings_(std::move(settings)), config_(config), sink_(std::move(sink)) {
    filter_.level = level_of(settings_.level, config_);
    const auto check = [](const char* option, const TraceSettings::Span& span, integer count) {
        if (!span.all() && span.last >= wide(count))
            throw ConfigError(fmt::format("{} {}..{}: the machine has {}, numbered from 0", option,
                                          span.first, span.last, count));
    };
    check("--trace-tiles", settings_.tiles, config_.chip.tiles);
    check("--trace-cores", settings_.cores, config_.chip.tiles * config_.chip.cores);
    if (!settings_.cores.all() && filter_.level > 1)
        throw ConfigError("--trace-cores: only what cores and L1s do is known by core; use --trace-tiles");
}

Recorder::Recorder(const Config& config, LineSharing& sharing) : config_(config), sharing_(&sharing) {}

/// By number: threads, caches, or the tiles that ask memory.
std::vector<std::string> Recorder::stream_names() const {
    const std::size_t tiles = wide(config_.chip.tiles), cores = wide(config_.chip.cores);
    std::vector<std::string> out;
    if (filter_.level == TraceLevel::core) {
        for (std::size_t core = 0; core < tiles * cores; ++core)
            for (integer thread = 0; thread < config_.chip.threads; ++thread)
                out.push_back(fmt::format("tile {} core {} thread {}", core / cores, core, thread));
    } else if (filter_.level == 1) {
        for (std::size_t core = 0; core < tiles * cores; ++core)
            out.push_back(fmt::format("tile {} L1 of core {}", core / cores, core));
    } else if (filter_.level == TraceLevel::memory || filter_.level > config_.tile_levels()) {
        for (std::size_t tile = 0; tile < tiles; ++tile)
            out.push_back(fmt::format("for tile {}", tile));
    } else {
        const std::size_t in_tile = cores / wide(config_.cores_sharing(filter_.level - 1));
        for (std::size_t cache = 0; cache < tiles * in_tile; ++cache)
            out.push_back(fmt::format("tile {} L{} {}", cache / in_tile, filter_.level, cache));
    }
    return out;
}

std::string Recorder::filters_text() const {
    std::vector<std::string> out;
    if (!settings_.structures.empty())
        out.push_back(fmt::format("structures {}", fmt::join(settings_.structures, ", ")));
    if (!settings_.phases.empty())
        out.push_back(fmt::format("phases {}", fmt::join(settings_.phases, ", ")));
    if (!settings_.tiles.all())
        out.push_back(fmt::format("tiles {}..{}", settings_.tiles.first, settings_.tiles.last));
    if (!settings_.cores.all())
        out.push_back(fmt::format("cores {}..{}", settings_.cores.first, settings_.cores.last));
    if (settings_.begin != 0 || settings_.end != ~std::uint64_t{0})
        out.push_back(fmt::format("cycles {}:{}", settings_.begin, settings_.end));
    return fmt::format("{}", fmt::join(out, "; "));
}

void Recorder::begin(const Labels& labels, const std::vector<std::string>& structures,
                     std::vector<traces::Description::Region> regions) {
    traces::Description d;
    d.program = settings_.program;
    d.level = settings_.level;
    d.time = "cycles";
    const unsigned cache = filter_.level == TraceLevel::core     ? 0
                           : filter_.level == TraceLevel::memory ? config_.cache_levels() - 1
                                                                 : filter_.level - 1;
    d.line_bytes = wide(config_.cache(cache).line_bytes);
    d.sample = settings_.sample;
    d.filters = filters_text();
    d.configuration = settings_.configuration;
    d.structures = structures;
    d.phases = labels.phases;
    d.work = labels.kinds;
    d.streams = stream_names();
    d.regions = std::move(regions);
    d.window = window_cycles(config_);
    d.picture = settings_.picture;

    phases_ = labels.phases.size();
    filter_.begin = settings_.begin;
    filter_.end = settings_.end;
    filter_.sample = settings_.sample;
    filter_.line_shift = static_cast<unsigned>(std::countr_zero(d.line_bytes));
    filter_.structures = chosen("--trace-structure", settings_.structures, structures);
    const std::vector<bool> phases = chosen("--trace-phase", settings_.phases, labels.phases);
    for (std::size_t column = 0; column < labels.columns(); ++column)
        filter_.columns.push_back(phases[labels.phase(column)]);
    const std::size_t streams = d.streams.size(), cores = wide(config_.chip.tiles * config_.chip.cores);
    for (std::size_t stream = 0; stream < streams; ++stream) {
        const std::size_t core = filter_.level > 1 ? 0 : stream * cores / streams;
        filter_.streams.push_back(settings_.cores.all() ||
                                  (core >= settings_.cores.first && core <= settings_.cores.last));
    }
    for (std::size_t tile = 0; tile < wide(config_.chip.tiles); ++tile)
        taps_.emplace_back(filter_, is_of_tiles() || tile == 0 ? nullptr : &taps_.front());
    names_.resize(taps_.size());
    if (sharing_ != nullptr) {
        sharing_->begin(config_, structures.size());
        return;
    }
    writer_.emplace(std::move(sink_), d, block_references);
}

void Recorder::start(std::uint64_t cycle) {
    origin_ = cycle;
    if (sharing_ != nullptr)
        sharing_->start(cycle);
    for (std::size_t tile = 0; tile < taps_.size(); ++tile)
        if (tile >= settings_.tiles.first && tile <= settings_.tiles.last)
            taps_[tile].start(cycle);
}

/// Numbers what the tile has met since.
void Recorder::learn_sites(std::size_t tile) {
    std::vector<std::uint32_t>& number = names_[tile].number;
    const std::size_t known = number.size() - 1;
    const auto& all = taps_[tile].sites().all();
    if (all.size() == known)
        return;
    number.resize(all.size() + 1);
    std::vector<std::string> in_order(all.size() - known), fresh;
    for (const auto& [where, local] : all)
        if (local >= known)
            in_order[local - known] = traces::site_name(where.first, where.second);
    for (std::size_t i = 0; i < in_order.size(); ++i) {
        const auto next = static_cast<std::uint32_t>(sites_.size() + 1);
        const auto [found, made] = sites_.try_emplace(in_order[i], next);
        if (made)
            fresh.push_back(in_order[i]);
        number[known + 1 + i] = found->second;
    }
    writer_->add_sites(std::move(fresh));
}

/// Where tiles go on by themselves, what they do depends on all windows. (Caches pass on too little to tell
/// it.)
void Recorder::pass_idle_window() {
    if (window_ && writer_ && filter_.level == TraceLevel::core && config_.sim.mode == "reference")
        writer_->mark(*std::exchange(window_, std::nullopt));
}

void Recorder::window(std::uint64_t until, std::uint64_t begin) {
    pass_idle_window();
    if (until > origin_)
        window_ = {traces::Turn::What::window, 0, 0, until - origin_, std::max(begin, origin_) - origin_};
}

void Recorder::collect() {
    for (std::size_t tile = 0; tile < taps_.size(); ++tile)
        collect(tile);
}

void Recorder::collect(std::size_t tile) {
    std::vector<TraceTap::Noted>& noted = taps_[tile].noted();
    if (noted.empty())
        return;
    if (sharing_ != nullptr) {
        for (const TraceTap::Noted& n : noted)
            sharing_->note(n);
        noted.clear();
        return;
    }
    if (window_ && is_of_tiles()) // memory is in no window
        writer_->mark(*std::exchange(window_, std::nullopt));
    learn_sites(tile);
    const std::vector<std::uint32_t>& site = names_[tile].number;
    // Most are of the phase, work and pixel of the one before: divisions for each take longer than all else.
    std::uint16_t column = 0, phase = 0, work = 0;
    std::int32_t pixel = -1;
    std::uint32_t screen_tile = settings_.picture.tile_of(pixel);
    for (const TraceTap::Noted& n : noted) {
        if (n.column != column) {
            column = n.column;
            phase = static_cast<std::uint16_t>(column % phases_);
            work = static_cast<std::uint16_t>(column / phases_);
        }
        if (n.pixel != pixel) {
            pixel = n.pixel;
            screen_tile = settings_.picture.tile_of(pixel);
        }
        writer_->add({n.time,
                      n.address,
                      n.stream,
                      {site[n.site], n.size, n.structure, phase, work, n.kind, n.part, n.detail},
                      screen_tile});
    }
    noted.clear();
}

void Recorder::end(std::uint64_t until, std::uint64_t begin) {
    collect();
    if (sharing_ != nullptr)
        return;
    pass_idle_window();
    end_ = traces::Turn{traces::Turn::What::end, 0, 0, until - origin_, std::max(begin, origin_) - origin_};
    writer_->mark(*end_);
}

void Recorder::settled() {
    if (!end_ || filter_.level == TraceLevel::core || !is_of_tiles())
        return;
    collect();
    writer_->mark(*end_);
}

void Recorder::finish() {
    collect();
    writer_->finish();
}

} // namespace sim
