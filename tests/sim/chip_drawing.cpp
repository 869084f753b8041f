// Drawings of chips: what is counted in them is what the machine has, and it stands where it belongs.
#include "sim/reports/chip_drawing.h"
#include "sim/network/topology.h"
#include "sim/reports/chip_plan.h"
#include "tests/sim/machines.h"

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>

#include <filesystem>
#include <map>
#include <set>
#include <sstream>

namespace sim::test {
namespace {

/// Shipped machines, and others of all networks, up to 1,024 cores.
std::vector<std::pair<std::string, Config>> chips() {
    std::vector<std::pair<std::string, Config>> out;
    const std::string folder = RAZOR_SOURCE_DIR "/configs/machines/";
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        out.emplace_back(entry.path().stem().string(), read_machine(entry.path().string()));
    const std::vector<std::vector<std::string>> changes = {
        {"chip.tiles=1", "chip.cores=1"},
        {"chip.tiles=1024", "chip.cores=1", "network.topology=mesh"},
        {"chip.tiles=1", "chip.cores=1024"},
        {"chip.tiles=128", "network.topology=ring", "memory.channels=64"},
        {"chip.tiles=7", "network.topology=ring", "l3.size_bytes=8MiB", "l3.share=chip"},
        {"chip.tiles=2", "network.topology=ring"},
        {"chip.tiles=1", "network.topology=mesh"},
        {"chip.tiles=13", "network.topology=mesh", "network.columns=13"},
        {"chip.tiles=12", "network.topology=crossbar", "l3.size_bytes=8MiB", "l3.share=32"},
        {"network.topology=bus", "network.buses=4", "memory.channels=32"},
        {"l2.share=2", "l3.size_bytes=1MiB", "l3.share=4", "l4.size_bytes=4MiB", "l4.share=tile"},
    };
    for (const std::vector<std::string>& change : changes)
        out.emplace_back(change.front() + " " + change.back(),
                         read_machine(folder + "copernicus.toml", change));
    return out;
}

/// Titles of all elements of a kind ("rect", "polyline") that have one. Throws where it is no XML.
std::multiset<std::string> titles(const std::string& svg, const std::string& element) {
    std::istringstream in(svg);
    boost::property_tree::ptree tree;
    boost::property_tree::read_xml(in, tree);
    std::multiset<std::string> out;
    for (const auto& [name, child] : tree.get_child("svg"))
        if (name == element)
            if (const auto title = child.get_optional<std::string>("title"))
                out.insert(*title);
    return out;
}

bool holds(const ChipPart& outer, const ChipPart& inner) {
    return inner.x >= outer.x && inner.y >= outer.y && inner.x + inner.width <= outer.x + outer.width &&
           inner.y + inner.height <= outer.y + outer.height;
}
bool overlap(const ChipPart& a, const ChipPart& b) {
    constexpr double least = 1e-6;
    return a.x + a.width > b.x + least && b.x + b.width > a.x + least && a.y + a.height > b.y + least &&
           b.y + b.height > a.y + least;
}

TEST(ChipDrawing, HasWhatTheMachineHas) {
    for (const auto& [name, c] : chips()) {
        SCOPED_TRACE(name);
        const Topology topology(c);
        std::map<std::pair<ChipPart::Kind, unsigned>, std::size_t> count;
        const ChipPlan plan = plan_chip(c);
        for (const ChipPart& part : plan.parts)
            ++count[{part.kind, part.level}];
        EXPECT_EQ((count[{ChipPart::tile, 0}]), u(c.chip.tiles));
        EXPECT_EQ((count[{ChipPart::core, 0}]), u(c.all_cores()));
        EXPECT_EQ((count[{ChipPart::cache, 0}]), u(c.all_cores()));
        for (unsigned level = 1; level < most_levels; ++level) {
            const bool there = level < c.cache_levels(), beyond = there && c.beyond_tiles(level);
            EXPECT_EQ((count[{ChipPart::cache, level}]),
                      there && !beyond ? u(c.all_cores() / c.cores_sharing(level)) : 0);
            EXPECT_EQ((count[{ChipPart::bank, level}]),
                      beyond ? u(c.all_cores() / c.cores_sharing(level) * c.cache(level).banks) : 0);
        }
        EXPECT_EQ((count[{ChipPart::channel, 0}]), u(c.memory.channels));
        const bool routed = c.network.topology == "ring" || c.network.topology == "mesh";
        EXPECT_EQ((count[{ChipPart::router, 0}]), routed ? u(c.chip.tiles) : 0);
        // Every link that reports name, once.
        std::multiset<std::string> links, wanted;
        for (const ChipLink& link : plan.links)
            links.insert("link " + link.name);
        for (std::size_t link = 0; !c.network.ideal() && link < topology.links(); ++link)
            wanted.insert("link " + topology.link_name(link));
        EXPECT_EQ(links, wanted);
        EXPECT_EQ(plan.ways.size(), c.network.ideal() ? topology.units() : 0);
        // And in the file, which is XML.
        const std::string svg = draw_chip(c, "<" + name + "> & \"co\"").file();
        EXPECT_EQ(titles(svg, "polyline"), wanted);
        const std::multiset<std::string> boxes = titles(svg, "rect");
        EXPECT_EQ(boxes.size(), plan.parts.size());
        for (const ChipPart& part : plan.parts)
            EXPECT_TRUE(boxes.contains(part.name)) << part.name;
    }
}

TEST(ChipDrawing, PartsStandWhereTheyBelong) {
    for (const auto& [name, c] : chips()) {
        SCOPED_TRACE(name);
        const ChipPlan plan = plan_chip(c);
        std::vector<const ChipPart*> tiles, within, others;
        std::map<std::string, const ChipPart*> by_name;
        for (const ChipPart& part : plan.parts) {
            EXPECT_TRUE(holds({ChipPart::tile, 0, "", 0, 0, plan.width, plan.height}, part)) << part.name;
            by_name[part.name] = &part;
            const bool inner = part.kind == ChipPart::core || part.kind == ChipPart::cache;
            (part.kind == ChipPart::tile ? tiles : inner ? within : others).push_back(&part);
        }
        std::map<const ChipPart*, std::vector<const ChipPart*>> inside;
        for (const ChipPart* part : within) {
            const auto outer = std::find_if(tiles.begin(), tiles.end(),
                                            [&](const ChipPart* tile) { return holds(*tile, *part); });
            ASSERT_NE(outer, tiles.end()) << part->name << " is in no tile";
            inside[*outer].push_back(part);
        }
        for (const auto& [tile, parts] : inside) {
            for (std::size_t a = 0; a < parts.size() && parts.size() < 100; ++a)
                for (std::size_t b = 0; b < a; ++b)
                    EXPECT_FALSE(overlap(*parts[a], *parts[b])) << parts[a]->name << ", " << parts[b]->name;
            for (const ChipPart* other : others)
                EXPECT_FALSE(overlap(*tile, *other)) << tile->name << ", " << other->name;
        }
        for (std::size_t a = 0; a < tiles.size(); ++a)
            for (std::size_t b = 0; b < a; ++b)
                EXPECT_FALSE(overlap(*tiles[a], *tiles[b])) << tiles[a]->name << ", " << tiles[b]->name;
        // Links between routers end at those that they are named by, and pass through no tile.
        for (const ChipLink& link : plan.links) {
            if (link.name.starts_with("router ")) {
                const std::size_t to = link.name.find(" to ");
                const auto at = [](const ChipPart& part, std::pair<double, double> point) {
                    return point.first >= part.x && point.first <= part.x + part.width &&
                           point.second >= part.y && point.second <= part.y + part.height;
                };
                EXPECT_TRUE(at(*by_name.at(link.name.substr(0, to)), link.points.front())) << link.name;
                EXPECT_TRUE(at(*by_name.at("router " + link.name.substr(to + 4)), link.points.back()))
                    << link.name;
            }
            for (std::size_t i = 0; i + 1 < link.points.size(); ++i) {
                const auto [x1, y1] = link.points[i];
                const auto [x2, y2] = link.points[i + 1];
                EXPECT_TRUE(x1 == x2 || y1 == y2) << link.name << " is not right-angled";
                const ChipPart line{ChipPart::tile,
                                    0,
                                    "",
                                    std::min(x1, x2) - 0.1,
                                    std::min(y1, y2) - 0.1,
                                    std::abs(x2 - x1) + 0.2,
                                    std::abs(y2 - y1) + 0.2,
                                    ""};
                for (const ChipPart* tile : tiles) {
                    const ChipPart core{ChipPart::tile,    0, "", tile->x + 6, tile->y + 6, tile->width - 12,
                                        tile->height - 12, ""};
                    EXPECT_FALSE(overlap(core, line)) << link.name << " crosses " << tile->name;
                }
            }
        }
    }
}

} // namespace
} // namespace sim::test
