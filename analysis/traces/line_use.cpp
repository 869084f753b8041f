#include "analysis/traces/line_use.h"

#include <algorithm>
#include <bit>
#include <map>
#include <utility>

namespace analysis {

LineUse::LineUse(std::uint64_t line_bytes)
    : part_shift_(static_cast<unsigned>(std::max(0, std::countr_zero(line_bytes) - 6))) {}

/// A bit for each part that is touched.
std::uint64_t LineUse::parts(const Touch& touch) const {
    const std::uint64_t low = touch.low >> part_shift_, high = touch.high >> part_shift_;
    return (~std::uint64_t{0} << low) & (~std::uint64_t{0} >> (63 - high));
}

void LineUse::touch(const Touch& touch) {
    const auto fresh = static_cast<std::uint32_t>(known_.size());
    std::uint32_t& number = numbers_[touch.line];
    if (number == LineMap::none) {
        number = fresh;
        known_.push_back({touch.line, 0, touch.group, LineMap::none});
        groups_ = std::max(groups_, std::size_t{touch.group} + 1);
    }
    Known& known = known_[number];
    ++known.touches;
    std::uint32_t user = known.users;
    while (user != LineMap::none && users_[user].stream != touch.stream)
        user = users_[user].next;
    if (user == LineMap::none) {
        user = static_cast<std::uint32_t>(users_.size());
        users_.push_back({touch.stream, known.users});
        known.users = user;
    }
    const std::uint64_t mask = parts(touch);
    users_[user].touched |= mask;
    users_[user].written |= touch.writes ? mask : 0;
}

std::vector<LineUse::Group> LineUse::groups() const {
    std::vector<Group> out(groups_);
    for (const Known& known : known_) {
        Group& g = out[known.group];
        ++g.lines;
        g.touches += known.touches;
        std::uint64_t touched = 0, threads = 0;
        bool written = false, clash = false;
        for (std::uint32_t u = known.users; u != LineMap::none; u = users_[u].next) {
            touched |= users_[u].touched;
            written = written || users_[u].written != 0;
            ++threads;
            for (std::uint32_t v = known.users; v != LineMap::none; v = users_[v].next)
                clash = clash || (v != u && (users_[u].written & users_[v].touched) != 0);
        }
        g.bytes += static_cast<std::uint64_t>(std::popcount(touched)) << part_shift_;
        g.copies += threads;
        if (threads > 1) {
            ++g.shared;
            g.written += written ? 1 : 0;
            g.falsely += written && !clash ? 1 : 0;
            g.false_touches += written && !clash ? known.touches : 0;
        }
    }
    return out;
}

std::vector<LineUse::Shared> LineUse::shared() const {
    std::map<std::pair<std::uint32_t, std::uint64_t>, Shared> out;
    for (const Known& known : known_) {
        std::uint64_t threads = 0;
        bool written = false;
        for (std::uint32_t u = known.users; u != LineMap::none; u = users_[u].next, ++threads)
            written = written || users_[u].written != 0;
        Shared& s = out[{known.group, threads}];
        s.group = known.group;
        s.threads = threads;
        ++s.lines;
        s.touches += known.touches;
        s.written += written ? 1 : 0;
    }
    std::vector<Shared> rows;
    for (const auto& [key, row] : out)
        rows.push_back(row);
    return rows;
}

std::vector<LineUse::Footprint> LineUse::footprints() const {
    std::map<std::uint32_t, Footprint> out;
    for (const Known& known : known_)
        for (std::uint32_t u = known.users; u != LineMap::none; u = users_[u].next) {
            const User& user = users_[u];
            Footprint& f = out[user.stream];
            f.stream = user.stream;
            ++f.lines;
            f.alone += users_[known.users].next == LineMap::none ? 1 : 0;
            f.bytes += static_cast<std::uint64_t>(std::popcount(user.touched)) << part_shift_;
            f.written += user.written != 0 ? 1 : 0;
        }
    std::vector<Footprint> rows;
    for (const auto& [stream, row] : out)
        rows.push_back(row);
    return rows;
}

std::vector<LineUse::Line> LineUse::hottest(std::size_t count) const {
    std::vector<Line> out;
    for (const Known& known : known_) {
        std::uint64_t threads = 0;
        for (std::uint32_t u = known.users; u != LineMap::none; u = users_[u].next)
            ++threads;
        out.push_back({known.line, known.touches, known.group, threads});
    }
    const auto before = [](const Line& a, const Line& b) {
        return a.touches != b.touches ? a.touches > b.touches : a.line < b.line;
    };
    const auto middle = out.begin() + static_cast<std::ptrdiff_t>(std::min(count, out.size()));
    std::partial_sort(out.begin(), middle, out.end(), before);
    out.erase(middle, out.end());
    return out;
}

} // namespace analysis
