// Noise: what an L1 asks of the level below it arrives 0 or 1 cycle later than it would (Alameldeen and Wood
// 2003), so that designs can be told from chance: runs that differ in nothing but the seed say how far two
// results must lie apart to mean anything. A function of (seed, L2, sequence above it), and so of
// the machine's own order alone.
#pragma once

#include "sim/config/config.h"
#include "sim/memory/below.h"

namespace sim {

class Jitter final : public Below {
public:
    /// Above the tile's `number`th L2.
    Jitter(const Config& config, std::uint32_t tile, std::uint32_t number, Below& below)
        : key_(mix(static_cast<std::uint64_t>(config.sim.jitter) << 32U | number << 16U | tile)),
          below_(below) {}

    /// A line that an L1 misses or prefetches.
    Answer read(const Access& a) override {
        Access later = a;
        later.at += mix(key_ + lines_) & 1U;
        const Answer answer = below_.read(later);
        if (!answer.refused) {
            ++lines_;
            cycles_ += later.at - a.at;
        }
        return answer;
    }
    Answer write(const Access& a) override { return below_.write(a); }
    Answer own(const Access& a) override { return below_.own(a); }
    bool is_asked(std::uint64_t address, const Cache& by) const override {
        return below_.is_asked(address, by);
    }

    std::uint64_t lines() const { return lines_; }
    /// That were added to them, all together.
    std::uint64_t cycles() const { return cycles_; }

private:
    /// All bits of the result depend on all bits of x (SplitMix64: Steele, Lea and Flood 2014).
    static std::uint64_t mix(std::uint64_t x) {
        x += 0x9e3779b97f4a7c15U;
        x = (x ^ x >> 30U) * 0xbf58476d1ce4e5b9U;
        x = (x ^ x >> 27U) * 0x94d049bb133111ebU;
        return x ^ x >> 31U;
    }

    std::uint64_t key_, lines_ = 0, cycles_ = 0;
    Below& below_;
};

} // namespace sim
