// What a tile's last cache has asked for, or written, that the directory does not know of yet
// (coherence.plain). Its tags are ahead of the directory by that: a line that is asked for stays where
// others' requests, which come first, would drop it.
#pragma once

#include <cstdint>
#include <unordered_map>

namespace sim {

class UnderWay {
public:
    /// The line, or (it is there) the right to write it.
    void asks(std::uint64_t line, bool right, std::uint64_t sequence) {
        Line& l = lines_[line];
        ++(right ? l.rights : l.lines);
        l.latest = sequence;
    }
    void writes(std::uint64_t line) { ++lines_[line].written; }
    /// The directory knows of one that was asked for.
    void asked(std::uint64_t line, bool right) {
        Line& l = lines_.at(line);
        --(right ? l.rights : l.lines);
        forget(line, l);
    }
    /// ... that was written; returns whether it has been asked for since.
    bool written(std::uint64_t line, std::uint64_t sequence) {
        Line& l = lines_.at(line);
        const bool again = l.latest > sequence;
        --l.written;
        forget(line, l);
        return again;
    }
    bool asks_line(std::uint64_t line) const {
        const auto found = lines_.find(line);
        return found != lines_.end() && found->second.lines != 0;
    }
    bool asks(std::uint64_t line) const {
        const auto found = lines_.find(line);
        return found != lines_.end() && found->second.lines + found->second.rights != 0;
    }

private:
    struct Line {
        std::uint32_t lines = 0, rights = 0, written = 0;
        std::uint64_t latest = 0; // that asked
    };
    void forget(std::uint64_t line, const Line& l) {
        if (l.lines + l.rights + l.written == 0)
            lines_.erase(line);
    }
    std::unordered_map<std::uint64_t, Line> lines_; // by address
};

} // namespace sim
