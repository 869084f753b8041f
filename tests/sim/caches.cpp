// Caches against a simulator of their own (cache_oracle.h), on streams of references: exact integers. A
// stream of 10 million, of which RAZOR_CACHE_REFERENCES says how many are taken, and a recorded trace.
#include "sim/memory/cache.h"
#include "tests/sim/cache_oracle.h"
#include "tests/sim/machines.h"
#include "tests/sim/references.h"

#include <cstdlib>
#include <filesystem>

namespace sim::test {
namespace {

/// Answers at once, and keeps what was asked.
class InstantMemory final : public Below {
public:
    std::vector<OracleRequest> asked;
    Answer read(const Access& a) override {
        asked.push_back({a.address, a.bytes, false});
        return {a.at, Cause::memory};
    }
    Answer write(const Access& a) override {
        asked.push_back({a.address, a.bytes, true});
        return {a.at, Cause::memory};
    }
};

/// Two caches above a memory, without a machine around them.
class Hierarchy {
public:
    explicit Hierarchy(const Config& c)
        : line_shift_(static_cast<unsigned>(std::countr_zero(u(c.l1.line_bytes)))), space_(1 << 20),
          lines_(space_, line_shift_), attribution_(lines_, 0, 1),
          l2(c, 1, true, now_, site_, memory, tickets_, attribution_),
          l1(c, 0, false, now_, site_, l2, tickets_, attribution_) {}

    void access(const Reference& r) {
        for (std::uint64_t line = r.address >> line_shift_; line <= (r.address + r.bytes - 1) >> line_shift_;
             ++line) {
            now_ += 1000;
            ASSERT_FALSE(l1.access(line, r.write, 1, now_, 0).refused);
        }
    }

    InstantMemory memory;

private:
    unsigned line_shift_;
    cycle now_ = 0;
    isa::address_space space_;
    Tickets tickets_;
    SiteAtHand site_;
    LineMap lines_;
    Attribution attribution_;

public:
    Cache l2, l1;
};

CacheOracle::Kind kind(const CacheConfig& c) {
    return {u(c.size_bytes),
            u(c.ways),
            u(c.line_bytes),
            c.replacement,
            c.write_policy == "through",
            c.write_miss == "around",
            c.prefetcher == "next" ? u(c.prefetch_degree) : 0};
}

void expect_equal(const CacheCounters& c, const CacheOracle& o) {
    EXPECT_EQ(c.reads + c.writes, o.accesses);
    EXPECT_EQ(c.hits, o.hits);
    EXPECT_EQ(c.misses, o.misses);
    EXPECT_EQ(c.fills, o.fills);
    EXPECT_EQ(c.write_backs, o.write_backs);
    EXPECT_EQ(c.written_through, o.written_through);
    EXPECT_EQ(c.written_around, o.written_around);
    EXPECT_EQ(c.hardware_prefetches, o.prefetches);
    EXPECT_EQ(c.prefetches_useful, o.used);
    EXPECT_EQ(c.compulsory, o.compulsory);
    EXPECT_EQ(c.capacity, o.capacity);
    EXPECT_EQ(c.conflict, o.conflict);
    EXPECT_EQ(c.coherence, 0U);
}

std::uint32_t u32(integer x) {
    return static_cast<std::uint32_t>(x);
}

void compare(const Config& c, const std::vector<Reference>& stream) {
    Hierarchy h(c);
    for (const Reference& r : stream)
        h.access(r);
    CacheOracle l1(kind(c.l1)), l2(kind(c.l2));
    const std::uint64_t line = u(c.l1.line_bytes);
    for (const Reference& r : stream)
        for (std::uint64_t a = r.address / line * line; a < r.address + r.bytes; a += line)
            l1.access(a, r.write, u32(c.l1.port_bytes));
    for (const OracleRequest& r : l1.out)
        l2.access(r.address, r.write, r.bytes);
    expect_equal(h.l1.counters(), l1);
    expect_equal(h.l2.counters(), l2);
    EXPECT_TRUE(h.memory.asked == l2.out);
}

Config machine(integer size, integer ways, integer line, integer l2_size, integer l2_ways, integer l2_line,
               const std::string& replacement) {
    Config c = simple();
    c.l1.size_bytes = size;
    c.l1.ways = ways;
    c.l1.line_bytes = line;
    c.l2.size_bytes = l2_size;
    c.l2.ways = l2_ways;
    c.l2.line_bytes = l2_line;
    c.l1.replacement = c.l2.replacement = replacement;
    c.l1.port_bytes = 8;
    c.l2.mshrs = c.l1.mshrs = 64; // so that no prefetch is dropped
    c.sim.miss_causes = "on";
    return c;
}

std::vector<Config> machines() {
    std::vector<Config> out;
    struct Writes {
        const char *l1_policy, *l1_miss, *l2_policy, *l2_miss;
        integer ahead;
    };
    for (const Writes& w : {Writes{"through", "around", "back", "allocate", 0},
                            {"through", "allocate", "through", "around", 1},
                            {"back", "around", "back", "around", 4},
                            {"back", "allocate", "back", "allocate", 2}}) {
        Config c = machine(8192, 4, 16, 98304, 12, 64, "lru"); // lines and ways as of Niagara
        c.l1.write_policy = w.l1_policy;
        c.l1.write_miss = w.l1_miss;
        c.l2.write_policy = w.l2_policy;
        c.l2.write_miss = w.l2_miss;
        c.l1.prefetcher = c.l2.prefetcher = w.ahead == 0 ? "none" : "next";
        c.l1.prefetch_degree = c.l2.prefetch_degree = std::max<integer>(1, w.ahead);
        out.push_back(c);
    }
    for (const char* replacement : {"lru", "plru", "srrip", "random"}) {
        out.push_back(machine(8192, 4, 64, 131072, 8, 64, replacement));
        out.push_back(machine(4096, 1, 16, 65536, 16, 64, replacement));
        out.push_back(machine(16384, 64, 32, 262144, 2, 128, replacement));
        if (std::string(replacement) != "plru")
            out.push_back(machine(12288, 3, 64, 98304, 12, 64, replacement));
    }
    return out;
}

// A write elsewhere explains the next miss alone, also in caches that lines leave when they are asked for.
TEST(MissCauses, CoherenceIsOfOneMiss) {
    for (const bool exclusive : {false, true}) {
        MissCauses causes(4);
        causes.use(7, true);
        EXPECT_EQ(causes.of(7), MissCause::conflict); // the other cache has it
        causes.invalidate(7, true);
        EXPECT_EQ(causes.of(7), MissCause::coherence);
        if (exclusive) {
            causes.leave(7);
            EXPECT_EQ(causes.of(7), MissCause::capacity);
        } else {
            causes.use(7, true);
            EXPECT_EQ(causes.of(7), MissCause::conflict);
        }
    }
}

TEST(CacheOracle, SyntheticStream) {
    const char* text = std::getenv("RAZOR_CACHE_REFERENCES");
    const std::vector<Reference> stream = synthetic(text != nullptr ? std::stoull(text) : 200000);
    for (const Config& c : machines()) {
        SCOPED_TRACE(c.l1.replacement + " " + std::to_string(c.l1.ways) + " " + c.l1.write_policy + " " +
                     c.l1.write_miss);
        compare(c, stream);
    }
}

TEST(CacheOracle, RecordedTrace) {
    const std::string file = recorded_trace;
    if (!std::filesystem::exists(file))
        GTEST_SKIP() << "no " << file;
    const std::vector<Reference> stream = read_trace(file);
    ASSERT_EQ(stream.size(), 31507U + 12338U);
    for (const Config& c : machines()) {
        SCOPED_TRACE(c.l1.replacement + " " + std::to_string(c.l1.ways) + " " + c.l1.write_policy + " " +
                     c.l1.write_miss);
        compare(c, stream);
    }
}

} // namespace
} // namespace sim::test
