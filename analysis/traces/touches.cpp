#include "analysis/traces/touches.h"

#include <fmt/format.h>

#include <algorithm>

namespace analysis {

using traces::Class;
using traces::Kind;

std::uint32_t Touches::group_of(std::uint64_t key) {
    const auto [found, fresh] = groups_.try_emplace(key, static_cast<std::uint32_t>(keys_.size()));
    if (fresh)
        keys_.push_back(key);
    return found->second;
}

std::vector<Touches::Counted> Touches::classify(const traces::Block& block) {
    std::vector<Counted> out(block.table.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        const Class& c = block.table[i];
        out[i].counts = kinds_[static_cast<std::size_t>(c.kind)];
        if (!out[i].counts)
            continue;
        out[i].writes = c.kind == Kind::write || c.kind == Kind::modify || c.kind == Kind::write_back ||
                        c.kind == Kind::write_through;
        out[i].more = std::max(c.size, 1U) - 1;
        if (by_ != By::thread)
            out[i].group = group_of(by_ == By::structure ? c.structure
                                    : by_ == By::phase   ? c.phase
                                    : by_ == By::work    ? c.work
                                    : by_ == By::kind    ? static_cast<std::uint64_t>(c.kind)
                                    : by_ == By::site    ? c.site
                                                         : 0);
    }
    return out;
}

std::string Touches::name(std::size_t group, const traces::Description& d) const {
    const std::uint64_t key = keys_[group];
    const auto in = [key](const std::vector<std::string>& names, const char* what) {
        return key < names.size() ? names[key] : fmt::format("{} {}", what, key);
    };
    switch (by_) {
    case By::structure:
        return in(d.structures, "structure");
    case By::phase:
        return in(d.phases, "phase");
    case By::work:
        return in(d.work, "work");
    case By::thread:
        return in(d.streams, "thread");
    case By::kind:
        return traces::kind_names[key];
    case By::site:
        return key == 0                                     ? "unknown"
               : !d.site_addresses && key <= d.sites.size() ? d.sites[key - 1]
                                                            : fmt::format("0x{:x}", key);
    case By::all:
        break;
    }
    return "all";
}

} // namespace analysis
