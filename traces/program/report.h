// What a page about a trace says: all analyses of one pass, and what they look like.
#pragma once

#include "analysis/plots/page.h"
#include "analysis/traces/address_time.h"
#include "analysis/traces/line_residency.h"
#include "analysis/traces/line_use.h"
#include "analysis/traces/lru_curve.h"
#include "analysis/traces/miss_causes.h"
#include "analysis/traces/strides.h"
#include "analysis/traces/tile_counts.h"
#include "analysis/traces/windows.h"
#include "traces/description.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace traces {

/// Keeps what all of its analyses keep: some hundred bytes for each line and thread that touches it.
class Report {
public:
    /// Of references in [first_time, last_time]; caches of one shape for what misses and what lines are used
    /// for. `tiles`: of the picture to draw over, if there is one.
    Report(analysis::CacheShape shape, std::uint64_t first_time, std::uint64_t last_time,
           std::uint32_t tiles);

    void touch(const analysis::Touch& touch, std::uint32_t cache) {
        curve_.touch(touch.line, touch.group);
        windows_.touch(touch);
        causes_.touch(touch, cache);
        residency_.touch(touch, cache);
        lines_.touch(touch);
        if (tiles_)
            tiles_->touch(touch, cache);
    }
    void access(const analysis::Access& access) {
        strides_.add(access);
        addresses_.add(access);
    }

    /// What groups and caches are called.
    struct Names {
        std::vector<std::string> groups;
        std::string by, caches;
    };
    /// After the last touch: adds the charts and tables. `description`: the trace's.
    void write(analysis::Page& page, const Names& names, const Description& description);
    /// Adds what tiles asked for, over the picture.
    void write_tiles(analysis::Page& page, const std::string& file, const Names& names,
                     const Picture& picture) const;
    const std::vector<analysis::MissCauses::Group>& causes() const { return causes_.groups(); }

private:
    void write_curve(analysis::Page& page, const Names& names) const;
    void write_reuse(analysis::Page& page, const Names& names) const;
    void write_time(analysis::Page& page, const Description& description) const;
    void write_causes(analysis::Page& page, const Names& names) const;
    void write_use(analysis::Page& page, const Names& names) const;
    void write_strides(analysis::Page& page, const Names& names) const;
    void write_lines(analysis::Page& page, const Names& names) const;

    analysis::CacheShape shape_;
    std::vector<std::size_t> order_; // groups, those with the most touches first
    analysis::LruCurve curve_;       // of powers of two of lines
    analysis::Windows windows_;
    analysis::MissCauses causes_;
    analysis::LineResidency residency_;
    analysis::LineUse lines_;
    analysis::Strides strides_;
    analysis::AddressTime addresses_;
    std::optional<analysis::TileCounts> tiles_;
};

} // namespace traces
