#include "traces/program/cache_options.h"

#include "traces/error.h"
#include "traces/program/analysis_options.h"

#include <fmt/format.h>

#include <charconv>

namespace traces {
namespace {

/// `all`, which is 0, or a whole number up to `most`.
std::uint64_t all_or(std::string_view option, const std::string& text, std::uint64_t most) {
    if (text == "all")
        return 0;
    std::uint64_t out = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    if (error != std::errc() || end != text.data() + text.size() || out == 0 || out > most)
        throw Error(fmt::format("{} '{}': give a whole number from 1 to {}, or all", option, text, most));
    return out;
}

} // namespace

void CacheOptions::add_to(CLI::App& app) {
    app.add_option("--sizes", sizes_text_,
                   "of caches, as 32KiB, 8KiB..1MiB (doubling) or 32KiB,48KiB" +
                       (sizes_text_.empty() ? "" : "; without it, " + sizes_text_))
        ->type_name("SIZES")
        ->required(sizes_text_.empty());
    app.add_option("--ways", ways_text_, "of each set, LRU; all: fully associative; without it, 8")
        ->type_name("WAYS");
    app.add_option("--share", share_,
                   fmt::format("threads of a cache: 1: each its own, N: those of N successive numbers, or "
                               "all; writes drop the line from other caches; without it, {}",
                               share_))
        ->type_name("THREADS");
}

void CacheOptions::prepare(std::uint64_t line_bytes) {
    ways_ = all_or("--ways", ways_text_, 1U << 20U);
    threads_ = static_cast<std::uint32_t>(all_or("--share", share_, 1U << 20U));
    sizes_ = parse_sizes("--sizes", sizes_text_);
    for (const std::uint64_t lines : lines_of("--sizes", sizes_, line_bytes)) {
        const std::uint64_t ways = ways_ == 0 ? lines : ways_;
        if (lines % ways != 0)
            throw Error(fmt::format("--sizes {}: {} lines of {} bytes are no sets of {} ways; give other "
                                    "--ways, or multiples of {} bytes",
                                    lines * line_bytes, lines, line_bytes, ways, ways * line_bytes));
        shapes_.push_back({lines / ways, ways, line_bytes});
    }
}

std::string CacheOptions::text() const {
    return fmt::format("{} LRU caches, {}", ways_ == 0 ? "fully associative" : fmt::format("{}-way", ways_),
                       threads_ == 0   ? "one for all threads"
                       : threads_ == 1 ? "one for each thread"
                                       : fmt::format("one for each {} threads", threads_));
}

} // namespace traces
