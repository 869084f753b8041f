// Which caches an analysis is of: --sizes, --ways, --share.
#pragma once

#include "analysis/traces/coherent_caches.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace traces {

class CacheOptions {
public:
    /// How many threads use a cache, and its size, if nothing else is asked for; empty: a size must be given.
    explicit CacheOptions(const char* share, const char* sizes = "") : sizes_text_(sizes), share_(share) {}
    void add_to(CLI::App& app);
    /// Checks all options, for lines of so many bytes. Throws Error.
    void prepare(std::uint64_t line_bytes);

    /// Bytes of each cache, ascending, and its shape.
    const std::vector<std::uint64_t>& sizes() const { return sizes_; }
    const std::vector<analysis::CacheShape>& shapes() const { return shapes_; }
    /// Of a thread: caches in order of their first use.
    std::uint32_t cache_of(std::uint32_t stream) {
        const std::uint32_t key = threads_ == 0 ? 0 : stream / threads_;
        if (key != last_key_ || numbers_.empty()) {
            last_key_ = key;
            last_ = numbers_.try_emplace(key, static_cast<std::uint32_t>(numbers_.size())).first->second;
        }
        return last_;
    }
    /// "caches of 8 ways, one for each 2 threads".
    std::string text() const;

private:
    std::string sizes_text_, ways_text_ = "8", share_;
    std::vector<std::uint64_t> sizes_;
    std::vector<analysis::CacheShape> shapes_;
    std::uint64_t ways_ = 0;    // 0: all
    std::uint32_t threads_ = 0; // of a cache; 0: all
    std::map<std::uint32_t, std::uint32_t> numbers_;
    std::uint32_t last_key_ = 0, last_ = 0;
};

} // namespace traces
