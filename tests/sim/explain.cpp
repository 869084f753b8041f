// Every figure of a report is explained, and nothing is explained that no report has.
#include "sim/machine/explain.h"
#include "sim/machine/intervals.h"
#include "tests/sim/kernels.h"
#include "tests/sim/machines.h"

#include <nlohmann/json.hpp>

#include <set>
#include <sstream>

namespace sim::test {
namespace {

void collect(const nlohmann::json& node, const std::string& path, std::set<std::string>& out) {
    if (node.is_object())
        for (const auto& [name, value] : node.items())
            collect(value, path.empty() ? name : path + "." + name, out);
    else if (node.is_array())
        for (const nlohmann::json& value : node)
            collect(value, path + "[]", out);
    else
        out.insert(path);
}

/// The figures of a machine that has everything there is to report, with an L2 a tile or a core; or whose
/// caches see each other's requests on buses.
void add_figures(std::set<std::string>& out, const char* share, bool snoops = false) {
    Config c;
    c.l2.share = share;
    for (CacheConfig* level : {&c.l3, &c.l4, &c.l5}) {
        level->size_bytes = 65536;
        level->share = level == &c.l5 && !snoops ? "chip" : "tile";
    }
    c.coherence.plain = snoops ? "snoop" : "directory";
    c.coherence.directory_entries = 64;
    c.l5.inclusion = snoops ? "inclusive" : "none";
    for (CacheConfig* level : {&c.l2, &c.l3, &c.l4})
        level->inclusion = "inclusive";
    c.chip.tiles = 2;
    c.network.topology = snoops ? "bus" : "mesh";
    c.tlb.entries = 8;
    c.core.issue_width = 2;
    c.core.pairing = "any | any";
    c.core.shared_classes = "divide";
    Memory memory;
    OwnerCosts costs({});
    const Report r =
        Machine(c).run(memory.space, 4, {{"work", "more"}, {"none", "some"}},
                       [&](int w) {
                           set_phase(w % 2);
                           note_level(memory.more, 64, 1);
                           mixed_work(reinterpret_cast<std::int32_t*>(memory.more),
                                      reinterpret_cast<isa::shared<std::int32_t>*>(memory.data), w, 3);
                       },
                       1, {.interval = 500, .owners = &costs});
    const std::string series = print_intervals(r);
    std::istringstream columns(series.substr(0, series.find('\n')));
    for (std::string name; std::getline(columns, name, ',');)
        out.insert("intervals[]." + name);
    collect(nlohmann::json::parse(print_json(r)), "", out);
}

TEST(Explain, EveryFigureOnceAndNothingElse) {
    std::set<std::string> all;
    add_figures(all, "tile");
    add_figures(all, "core");
    add_figures(all, "tile", true);
    EXPECT_GT(all.size(), 300U);
    std::set<const Explanation*> used;
    for (const std::string& path : all) {
        int found = 0;
        for (const Explanation& e : explanations())
            if (explains(e, path)) {
                ++found;
                used.insert(&e);
            }
        EXPECT_EQ(found, 1) << path;
    }
    for (const Explanation& e : explanations()) {
        EXPECT_TRUE(used.count(&e) == 1) << e.path << " is in no report";
        EXPECT_FALSE(e.meaning.empty()) << e.path;
    }
}

TEST(Explain, FindsByAnyPartOfAPath) {
    ASSERT_EQ(find_explanations("core.mispredicts").size(), 1U);
    EXPECT_EQ(find_explanations("core.mispredicts")[0]->path, "core.mispredicts");
    EXPECT_EQ(find_explanations("l1.hits").size(), 1U);
    EXPECT_EQ(find_explanations("l1_by_core.hits").size(), 1U);
    EXPECT_GE(find_explanations("busy").size(), 4U);
    EXPECT_TRUE(find_explanations("mispredict").empty()) << "whole names only";
    EXPECT_TRUE(find_explanations("hits.l1").empty());
}

} // namespace
} // namespace sim::test
