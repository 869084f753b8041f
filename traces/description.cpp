#include "traces/description.h"

#include "traces/error.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <bit>
#include <utility>

namespace traces {

using json = nlohmann::ordered_json;

namespace {

/// Numbers in it are of 16 bits.
bool bad_table(const std::vector<std::string>& names) {
    return names.empty() || names.size() > 65536;
}

} // namespace

std::string names_since(const TableSizes& before, const Description& d) {
    json out;
    const auto table = [&out](const char* name, std::size_t known, const std::vector<std::string>& names) {
        if (names.size() > known)
            out[name] = std::vector(names.begin() + static_cast<std::ptrdiff_t>(known), names.end());
    };
    table("structures", before.structures, d.structures);
    table("phases", before.phases, d.phases);
    table("work", before.work, d.work);
    return out.empty() ? "" : out.dump(-1, ' ', false, json::error_handler_t::replace);
}

void add_names(Description& d, const std::string& text, const std::string& place) {
    try {
        const json in = json::parse(text);
        for (const auto& [name, table] :
             {std::pair{"structures", &d.structures}, {"phases", &d.phases}, {"work", &d.work}})
            if (in.contains(name)) {
                const auto names = in.at(name).get<std::vector<std::string>>();
                table->insert(table->end(), names.begin(), names.end());
            }
    } catch (const json::exception& e) {
        throw Error(
            fmt::format("{}: a list of names is damaged ({}); record the trace again", place, e.what()));
    }
    if (bad_table(d.structures) || bad_table(d.phases) || bad_table(d.work))
        throw Error(fmt::format("{}: a table has too many names; record the trace again", place));
}

std::string to_json(const Description& d) {
    json regions = json::array();
    for (const Description::Region& r : d.regions)
        regions.push_back(json::array({r.begin, r.end, r.structure, r.lasts}));
    json out = {{"program", d.program},
                {"level", d.level},
                {"time", d.time},
                {"line_bytes", d.line_bytes},
                {"sites", d.site_addresses ? "addresses" : "names"},
                {"sample", d.sample},
                {"window", d.window},
                {"filters", d.filters},
                {"structures", d.structures},
                {"phases", d.phases},
                {"work", d.work},
                {"streams", d.streams},
                {"regions", std::move(regions)},
                {"configuration", d.configuration}};
    if (d.picture != Picture{})
        out["picture"] = {d.picture.width, d.picture.height, d.picture.side};
    return out.dump(1, ' ', false, json::error_handler_t::replace);
}

Description description_from_json(const std::string& text, const std::string& place) {
    Description d;
    try {
        const json in = json::parse(text);
        in.at("program").get_to(d.program);
        in.at("level").get_to(d.level);
        in.at("time").get_to(d.time);
        in.at("line_bytes").get_to(d.line_bytes);
        d.site_addresses = in.at("sites").get<std::string>() == "addresses";
        in.at("sample").get_to(d.sample);
        in.at("filters").get_to(d.filters);
        in.at("structures").get_to(d.structures);
        in.at("phases").get_to(d.phases);
        in.at("work").get_to(d.work);
        in.at("streams").get_to(d.streams);
        in.at("configuration").get_to(d.configuration);
        d.window = in.value("window", std::uint64_t{0}); // since version 2
        if (in.contains("regions"))                      // likewise
            for (const json& r : in.at("regions"))
                d.regions.push_back({r.at(0), r.at(1), r.at(2), r.at(3)});
        if (in.contains("picture")) { // since version 5
            const json& p = in.at("picture");
            d.picture = {p.at(0), p.at(1), p.at(2)};
        }
    } catch (const json::exception& e) {
        throw Error(fmt::format("{}: the description is not of this format ({}); record the trace again",
                                place, e.what()));
    }
    const Picture& p = d.picture;
    if (p != Picture{} && (p.width == 0 || p.height == 0 || p.side == 0 || p.width > most_side ||
                           p.height > most_side || p.side > most_side))
        throw Error(
            fmt::format("{}: the description's picture has impossible sides; record the trace again", place));
    std::uint64_t end = 0;
    for (const Description::Region& r : d.regions) {
        if (r.begin < end || r.end <= r.begin || r.structure >= d.structures.size())
            throw Error(
                fmt::format("{}: the description's regions are not in order, or of no structure; record "
                            "the trace again",
                            place));
        end = r.end;
    }
    if ((d.line_bytes != 0 && !std::has_single_bit(d.line_bytes)) || !(d.sample > 0 && d.sample <= 1) ||
        bad_table(d.structures) || bad_table(d.phases) || bad_table(d.work))
        throw Error(
            fmt::format("{}: the description has impossible values (a line that is no power of two, a "
                        "sample outside (0, 1], or a table of no or too many names); record the trace again",
                        place));
    return d;
}

} // namespace traces
