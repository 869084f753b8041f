// What work costs whom it is for: against the same counted by kind of work, which is counted in other places.
#include "sim/memory/owner_costs.h"
#include "tests/sim/machines.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>
#include <numeric>
#include <random>

namespace sim::test {
namespace {

constexpr std::uint64_t first_lanes(int n) {
    return (std::uint64_t{1} << n) - 1;
}
/// All lanes work for the same one.
std::vector<std::int32_t> all_for(std::int32_t owner) {
    return std::vector<std::int32_t>(width, owner);
}
/// Until its end, as kernels have it.
class For {
public:
    For(const std::vector<std::int32_t>& owners, std::uint64_t lanes)
        : before_(set_owners(owners.data(), lanes)) {}
    For(const For&) = delete;
    For& operator=(const For&) = delete;
    ~For() { restore_owners(before_); }

private:
    std::uint64_t before_;
};

using Amounts = std::map<std::int32_t, std::uint64_t>; // by owner
Amounts amounts(const OwnerCosts& costs, const OwnerFigure& figure, bool builds = false) {
    Amounts out;
    costs.share(figure, builds, [&](std::int32_t owner, std::uint64_t n) { out[owner] += n; });
    return out;
}
OwnerFigure figure(const char* name) {
    for (const OwnerFigure& f : owner_figures(most_levels))
        if (f.name == name)
            return f;
    throw std::invalid_argument(name);
}
std::uint64_t sum_of(const Amounts& a) {
    return std::accumulate(a.begin(), a.end(), std::uint64_t{0},
                           [](std::uint64_t n, const auto& one) { return n + one.second; });
}

constexpr int kinds = 5; // the first is nobody's
const Labels labels{{"work", "build"}, {"none", "a", "b", "c", "d"}};

/// What a column of the report has of a figure.
std::uint64_t of_column(const Report& r, const OwnerFigure& f, std::size_t column) {
    std::uint64_t n = 0;
    if (f.of_traffic != nullptr) {
        for (const TrafficRow& row : r.traffic)
            n += row.column == column ? row.traffic.*f.of_traffic : 0;
        return n;
    }
    if (f.name == "instructions")
        return r.work[column].instructions;
    for (const ThreadReport& t : r.threads)
        for (std::size_t i = 0; i < cause_count; ++i) {
            const auto why = static_cast<Cause>(i);
            const bool counts =
                f.name == "cycles" || (f.name == "waiting" ? why == Cause::synchronise : is_of_memory(why));
            n += counts ? t.stacks[column][i] : 0;
        }
    return n;
}

/// Reads, writes, computes and takes turns with others, now for one owner and kind, now for another.
void work(Memory& memory, int worker, int steps) {
    std::mt19937 random(static_cast<unsigned>(worker) + 7);
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    auto* words = reinterpret_cast<std::int32_t*>(memory.more);
    for (int i = 0; i < steps; ++i) {
        const int kind = below(kinds);
        set_kind(kind);
        set_phase(below(2));
        const For someone(all_for(kind - 1), kind == 0 ? 0 : first_lanes(1 + below(width - 1)));
        stamp s;
        for (int k = below(20); k > 0; --k) {
            std::byte* p = memory.data + below(4000) * 64;
            if (below(3) == 0)
                store(here, p, 4, stamp{}, s);
            else
                s = load(here, p, 4, s);
            s = scalar_op(operation::multiply, s, s);
            branch(here, s, below(4) != 0);
        }
        if (below(4) == 0) {
            std::int32_t* word = words + 16 * below(4);
            before_atomic(here, atomic::fetch_add, word, stamp{}, s);
            *word += 1;
            after_atomic(here, atomic::fetch_add, word, true);
        }
    }
    set_kind(0);
    set_phase(0);
}

TEST(Owners, CostWhatTheirKindsOfWorkCostOnEveryMachine) {
    for (const auto& entry : std::filesystem::directory_iterator(RAZOR_SOURCE_DIR "/configs/machines"))
        for (const std::string mode : {"fast", "reference"}) {
            SCOPED_TRACE(entry.path().filename().string() + ", " + mode);
            const Config c = read_machine(entry.path().string(), {"sim.mode=" + mode});
            const int workers = static_cast<int>(std::min<integer>(c.all_threads(), 24));
            std::string plain;
            for (const int host_threads : {0, 1, 2}) { // 0: nobody asks
                OwnerCosts costs({false, true});
                Memory memory;
                RunOptions options;
                options.owners = host_threads == 0 ? nullptr : &costs;
                Report r = Machine(c).run(
                    memory.space, workers, labels, [&](int w) { work(memory, w, 60); },
                    std::max(host_threads, 1), options);
                for (std::size_t i = 0; i < r.owners.size(); ++i) {
                    const OwnerFigure f = owner_figures(c.cache_levels())[i];
                    SCOPED_TRACE(f.name);
                    const std::size_t phases = r.labels.phases.size();
                    const Amounts all = amounts(costs, f), builds = amounts(costs, f, true);
                    for (std::size_t k = 1; k < kinds; ++k) {
                        const auto at = [&](const Amounts& a) {
                            const auto found = a.find(static_cast<std::int32_t>(k) - 1);
                            return found == a.end() ? 0 : found->second;
                        };
                        const std::uint64_t building = of_column(r, f, k * phases + 1);
                        EXPECT_EQ(at(all), of_column(r, f, k * phases) + building);
                        EXPECT_EQ(at(builds), building);
                    }
                    EXPECT_EQ(sum_of(all), r.owners[i].owners);
                    EXPECT_EQ(sum_of(builds), r.owners[i].builds);
                    if (f.name == "cycles" || f.name == "l1_misses") {
                        EXPECT_GT(r.owners[i].owners, 100U);
                    }
                }
                EXPECT_EQ(r.owners.empty(), host_threads == 0);
                r.owners.clear();
                const std::string report = print_json(r, false);
                if (plain.empty())
                    plain = report;
                EXPECT_TRUE(report == plain) << "recording changes the run";
            }
        }
}

/// One load that misses, and 10 operations on scalars.
void ten_operations(std::byte* p) {
    stamp s = load(here, p, 4, stamp{});
    for (int i = 0; i < 9; ++i)
        s = scalar_op(operation::add, s, s);
}

/// One thread's work, whose costs are shared.
template <class Work> Report run_shared(Memory& memory, OwnerCosts& costs, Work work) {
    RunOptions options;
    options.owners = &costs;
    return Machine(simple()).run(
        memory.space, 1, {{"work"}}, [&](int) { work(); }, 1, options);
}

TEST(Owners, ShareByActiveLanes) {
    Memory memory;
    OwnerCosts costs({});
    const Report r = run_shared(memory, costs, [&] {
        ten_operations(memory.data);
        std::vector<std::int32_t> owners(width, 9);
        owners[0] = owners[1] = 3;
        owners[2] = 4;
        const For three(owners, 0b111);
        for (int i = 1; i <= 3; ++i)
            ten_operations(memory.data + 64 * i); // 30: 20 for owner 3
        {
            const std::uint64_t before = narrow_owners(0b110);
            ten_operations(memory.data + 64 * 4);                // 5 each
            EXPECT_NE(narrow_owners(~std::uint64_t{7}), before); // of these there are none
            ten_operations(memory.data + 64 * 5);                // 5 each
            restore_owners(before);
        }
        {
            const For other(all_for(7), 0b10);
            ten_operations(memory.data + 64 * 6);
        }
        ten_operations(memory.data + 64 * 7); // 10 for three lanes
    });
    const Amounts instructions = amounts(costs, figure("instructions"));
    ASSERT_EQ(instructions.size(), 3U);
    EXPECT_EQ(instructions.at(7), 10U);
    EXPECT_EQ(sum_of(instructions), 70U);
    // 40 for three lanes, two of them owner 3's, who has one of the two lanes that share 20.
    EXPECT_NEAR(static_cast<double>(instructions.at(3)), 40 * 2 / 3.0 + 10, 1);
    EXPECT_NEAR(static_cast<double>(instructions.at(4)), 40 / 3.0 + 10, 1);
    const Amounts lines = amounts(costs, figure("dram_reads"));
    EXPECT_EQ(sum_of(lines), 7U);
    EXPECT_EQ(lines.at(7), 1U);
    EXPECT_EQ(costs.sum(figure("dram_reads")).nobody, 1U);
    EXPECT_EQ(r.owners.size(), owner_figures(r.config.cache_levels()).size());
}

TEST(Owners, RestIsSharedEvenlyToo) {
    OwnerCosts costs({});
    costs.begin(1, width, 1);
    std::vector<std::int32_t> owners(width);
    std::iota(owners.begin(), owners.end(), 0);
    constexpr std::uint64_t n = 3;
    for (std::size_t i = 0; i < 300; ++i) { // a line each, of another party
        const std::size_t party = costs.party(0, owners.data(), first_lanes(n));
        costs.count(0, party, &Traffic::memory_reads);
    }
    const Amounts lines = amounts(costs, figure("dram_reads"));
    ASSERT_EQ(lines.size(), n);
    for (const auto& [owner, amount] : lines)
        EXPECT_EQ(amount, 100U) << owner;
}

TEST(Owners, CountTheLastFrameAlone) {
    const auto lines_of = [](int frames, int parts) {
        Memory memory;
        OwnerCosts costs({});
        RunOptions options;
        options.owners = &costs;
        options.frames = frames;
        int begun = 0;
        const auto next = [&] { ++begun; };
        options.next_frame = [&](int) { next(); };
        if (parts == 2)
            options.next_part = next;
        const Report r = Machine(simple()).run(
            memory.space, 1, {{"work"}},
            [&](int) {
                const For someone(all_for(begun), 1);
                for (int i = 0; i <= begun; ++i)
                    ten_operations(memory.data + 65536 * begun + 64 * i);
            },
            1, options);
        EXPECT_EQ(r.owners.size(), owner_figures(r.config.cache_levels()).size());
        return amounts(costs, figure("dram_reads"));
    };
    EXPECT_EQ(lines_of(1, 1), (Amounts{{0, 1}}));
    EXPECT_EQ(lines_of(3, 1), (Amounts{{2, 3}}));
    EXPECT_EQ(lines_of(2, 2), (Amounts{{2, 3}}));
}

TEST(Owners, AreInTheReport) {
    Memory memory;
    OwnerCosts costs({});
    const Report r = run_shared(memory, costs, [&] {
        ten_operations(memory.data);
        const For someone(all_for(0), 1);
        ten_operations(memory.data + 64);
    });
    const nlohmann::json all = nlohmann::json::parse(print_json(r));
    const nlohmann::json& owners = all.at("owners");
    EXPECT_EQ(owners.at("instructions"),
              nlohmann::json::parse(R"({"owners": 10, "builds": 0, "nobody": 10})"));
    EXPECT_EQ(owners.at("l2_misses").at("owners"), 1);
    EXPECT_FALSE(owners.contains("l3_misses"));
}

} // namespace
} // namespace sim::test
