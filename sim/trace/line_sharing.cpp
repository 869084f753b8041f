#include "sim/trace/line_sharing.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <stdexcept>

namespace sim {
namespace {

/// Bits `low` to `high`, both in.
std::uint64_t bits(std::uint64_t low, std::uint64_t high) {
    return (~std::uint64_t{0} >> (63 - high)) & ~std::uint64_t{0} << low;
}

void equal(const char* law, const std::string& structure, std::uint64_t left, std::uint64_t right) {
    if (left != right)
        throw std::logic_error(fmt::format("a law of the machine is broken: {} ({}): {} is not {}", law,
                                           structure, left, right));
}

void at_most(const char* law, const std::string& structure, std::uint64_t left, std::uint64_t right) {
    if (left > right)
        throw std::logic_error(fmt::format("a law of the machine is broken: {} ({}): {} exceeds {}", law,
                                           structure, left, right));
}

} // namespace

void LineSharing::begin(const Config& config, std::size_t structures) {
    const auto wide = [](integer x) { return static_cast<std::uint64_t>(x); };
    line_shift_ = static_cast<unsigned>(std::countr_zero(wide(config.l1.line_bytes)));
    part_shift_ = line_shift_ > 6 ? line_shift_ - 6 : 0;
    threads_ = static_cast<std::uint32_t>(config.chip.threads);
    cores_ = wide(config.all_cores());
    structure_count_ = structures;
    for (unsigned level = 0; level < config.tile_levels(); ++level)
        sharing_.push_back(level == 0 ? 1 : wide(config.cores_sharing(level)));
    held_.assign(sharing_.size(), std::vector<std::vector<std::uint64_t>>(structures));
    transfers_.resize(structures);
    invalidations_.resize(structures);
}

void LineSharing::note(const TraceTap::Noted& n) {
    using traces::Kind;
    const bool modifies = n.kind == Kind::modify, writes = modifies || n.kind == Kind::write;
    if (!writes && n.kind != Kind::read)
        return;
    const std::uint64_t last = n.address + std::max<std::uint32_t>(n.size, 1) - 1;
    for (std::uint64_t line = n.address >> line_shift_; line <= last >> line_shift_; ++line) {
        const std::uint64_t begin = line << line_shift_, end = begin + line_bytes() - 1;
        access(line,
               bits((std::max(n.address, begin) - begin) >> part_shift_,
                    (std::min(last, end) - begin) >> part_shift_),
               n.structure, n.stream / threads_, modifies || !writes, writes);
    }
}

LineSharing::User& LineSharing::user_of(Line& line, std::uint32_t core) {
    for (std::uint32_t u = line.users; u != none; u = users_[u].next)
        if (users_[u].core == core)
            return users_[u];
    users_.push_back({core, line.users});
    line.users = static_cast<std::uint32_t>(users_.size() - 1);
    return users_.back();
}

void LineSharing::access(std::uint64_t number, std::uint64_t parts, std::uint32_t structure,
                         std::uint32_t core, bool reads, bool writes) {
    const auto [found, made] = index_.try_emplace(number, static_cast<std::uint32_t>(lines_.size()));
    if (made)
        lines_.push_back({number, structure});
    Line& line = lines_[found->second];
    User& user = user_of(line, core);
    if (reads) {
        const std::uint64_t fresh = parts & ~user.read;
        line.read_by_several |= line.read & fresh;
        line.read |= fresh;
        user.read |= fresh;
    }
    if (!user.latest && line.writer != none && line.writer != core)
        ++transfers_[line.structure];
    user.latest = true;
    if (!writes)
        return;
    line.writer = core;
    line.written = true;
    for (std::uint32_t u = line.users; u != none; u = users_[u].next)
        if (users_[u].core != core && users_[u].latest) {
            users_[u].latest = false;
            ++invalidations_[line.structure];
        }
}

std::vector<LineSharing::Structure> LineSharing::structures() const {
    std::vector<Structure> out(structure_count_);
    for (const Line& line : lines_) {
        Structure& s = out[line.structure];
        std::size_t cores = 0;
        for (std::uint32_t u = line.users; u != none; u = users_[u].next)
            ++cores;
        ++s.lines;
        add(s.by_cores, cores, 1);
        add(s.written_by, cores, line.written ? 1 : 0);
        s.bytes_read += static_cast<std::uint64_t>(std::popcount(line.read)) << part_shift_;
        s.bytes_read_by_several += static_cast<std::uint64_t>(std::popcount(line.read_by_several))
                                   << part_shift_;
    }
    for (std::size_t s = 0; s < out.size(); ++s) {
        out[s].transfers = transfers_[s];
        out[s].invalidations = invalidations_[s];
    }
    return out;
}

std::vector<LineSharing::Footprint> LineSharing::footprints() const {
    std::vector<Footprint> out(cores_);
    for (const Line& line : lines_) {
        const bool alone = users_[line.users].next == none;
        for (std::uint32_t u = line.users; u != none; u = users_[u].next) {
            ++out[users_[u].core].lines;
            out[users_[u].core].alone += alone ? 1 : 0;
        }
    }
    return out;
}

void LineSharing::check(const Report& r) const {
    const std::vector<Structure> all = structures();
    std::uint64_t copies = 0, alone = 0;
    for (std::size_t s = 0; s < all.size(); ++s) {
        std::uint64_t lines = 0;
        for (std::size_t k = 0; k < all[s].by_cores.size(); ++k) {
            lines += all[s].by_cores[k];
            copies += (k + 1) * all[s].by_cores[k];
        }
        alone += all[s].by_cores.empty() ? 0 : all[s].by_cores[0];
        equal("lines by number of cores = lines", r.structures[s], lines, all[s].lines);
        if (s + 1 == all.size()) // spilled registers are not told by line
            continue;
        std::uint64_t touched = 0, written = 0;
        for (const TouchedLines& t : r.touched)
            touched += t.structure == s ? t.lines : 0;
        for (const std::uint64_t n : all[s].written_by)
            written += n;
        // Shared words are modified at the L2, where no line is touched.
        at_most("lines touched <= lines that cores share or not", r.structures[s], touched, lines);
        at_most("all others <= lines written", r.structures[s], lines - touched, written);
    }
    std::uint64_t of_cores = 0, own = 0;
    for (const Footprint& f : footprints()) {
        of_cores += f.lines;
        own += f.alone;
    }
    equal("lines x cores of each = sum of the cores' footprints", "all", copies, of_cores);
    equal("lines of one core = sum of those that cores have alone", "all", alone, own);
}

} // namespace sim
