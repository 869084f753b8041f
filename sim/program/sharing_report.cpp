#include "sim/program/sharing_report.h"

#include "razor/program/arguments.h"
#include "razor/scene/error.h"

#include <fmt/format.h>

#include <numeric>

namespace sim {
namespace {

using json = nlohmann::ordered_json;

std::uint64_t sum_from(const std::vector<std::uint64_t>& by, std::size_t first, std::size_t end) {
    std::uint64_t out = 0;
    for (std::size_t i = first; i < std::min(end, by.size()); ++i)
        out += by[i];
    return out;
}

/// Of what one cache holds, two do, ...: how many lines, and in how many places.
struct Copies {
    std::uint64_t lines = 0, copies = 0;
};
Copies copies_of(const std::vector<std::uint64_t>& held) {
    Copies out;
    for (std::size_t k = 0; k < held.size(); ++k) {
        out.lines += held[k];
        out.copies += (k + 1) * held[k];
    }
    return out;
}

double mean(std::uint64_t sum, const LineSharing& sharing) {
    return sharing.looks() == 0 ? 0 : static_cast<double>(sum) / static_cast<double>(sharing.looks());
}

} // namespace

void SharingOptions::add_to(CLI::App& app) {
    app.add_flag(
        "--sharing", wanted_,
        "tell how many lines of each structure one core accesses, two do, ..., how many caches hold them at "
        "once, and what goes from core to core; the run takes longer");
    app.add_option("--sharing-interval", interval_,
                   "cycles after which --sharing looks at the caches again; without it, 100000")
        ->type_name("CYCLES");
}

std::optional<LineSharing> SharingOptions::begin() const {
    if (!wanted_ && !interval_.empty())
        throw razor::UserError("--sharing-interval is of no use without --sharing; give both");
    if (!wanted_)
        return std::nullopt;
    return std::optional<LineSharing>(
        std::in_place,
        static_cast<std::uint64_t>(
            interval_.empty() ? 100000 : razor::parse_whole("--sharing-interval", interval_, {1000, 1e9})));
}

std::string sharing_text(const LineSharing& sharing, const Report& r) {
    std::string out = fmt::format("\n{:<16} {:>10} {:>10} {:>10} {:>10} {:>10} {:>12} {:>12} {:>10} {:>12}   "
                                  "lines of {} bytes, by cores\n",
                                  "shared lines", "lines", "1 core", "2", "3 and 4", "more", "bytes read",
                                  "by several", "moved", "invalidated", sharing.line_bytes());
    const std::vector<LineSharing::Structure> all = sharing.structures();
    for (std::size_t i = 0; i < all.size(); ++i) {
        const LineSharing::Structure& s = all[i];
        if (s.lines != 0)
            out +=
                fmt::format("{:<16} {:>10} {:>10} {:>10} {:>10} {:>10} {:>12} {:>12} {:>10} {:>12}\n",
                            r.structures[i], s.lines, sum_from(s.by_cores, 0, 1), sum_from(s.by_cores, 1, 2),
                            sum_from(s.by_cores, 2, 4), sum_from(s.by_cores, 4, s.by_cores.size()),
                            s.bytes_read, s.bytes_read_by_several, s.transfers, s.invalidations);
    }
    out += fmt::format(
        "\n{:<16} {:>10} {:>10} {:>10} {:>10} {:>10}   at once, means of {} looks, every {} cycles\n",
        "held by caches", "lines", "different", "copies", "by 1", "by more", sharing.looks(),
        sharing.interval());
    for (unsigned level = 0; level < sharing.levels(); ++level)
        for (std::size_t i = 0; i < all.size(); ++i) {
            const auto& held = sharing.held(level, i);
            const Copies c = copies_of(held);
            if (c.lines != 0)
                out +=
                    fmt::format("L{} {:<13} {:>10.0f} {:>10.0f} {:>10.2f} {:>10.0f} {:>10.0f}\n", level + 1,
                                r.structures[i], mean(c.copies, sharing), mean(c.lines, sharing),
                                static_cast<double>(c.copies) / static_cast<double>(c.lines),
                                mean(held[0], sharing), mean(c.lines - held[0], sharing));
        }
    return out;
}

json sharing_json(const LineSharing& sharing, const Report& r) {
    json structures = json::array(), held = json::array(), cores = json::array();
    const std::vector<LineSharing::Structure> all = sharing.structures();
    for (std::size_t i = 0; i < all.size(); ++i) {
        const LineSharing::Structure& s = all[i];
        if (s.lines != 0)
            structures.push_back({{"structure", r.structures[i]},
                                  {"lines", s.lines},
                                  {"by_cores", s.by_cores},
                                  {"written_by_cores", s.written_by},
                                  {"bytes_read", s.bytes_read},
                                  {"bytes_read_by_several", s.bytes_read_by_several},
                                  {"transfers", s.transfers},
                                  {"invalidations", s.invalidations}});
    }
    const std::vector<LineSharing::Footprint> footprints = sharing.footprints();
    for (std::size_t core = 0; core < footprints.size(); ++core)
        cores.push_back(
            {{"core", core}, {"lines", footprints[core].lines}, {"alone", footprints[core].alone}});
    for (unsigned level = 0; level < sharing.levels(); ++level)
        for (std::size_t i = 0; i < all.size(); ++i) {
            const auto& by = sharing.held(level, i);
            const Copies c = copies_of(by);
            if (c.lines == 0)
                continue;
            json means = json::array();
            for (const std::uint64_t n : by)
                means.push_back(mean(n, sharing));
            held.push_back({{"level", fmt::format("l{}", level + 1)},
                            {"structure", r.structures[i]},
                            {"copies", mean(c.copies, sharing)},
                            {"lines", mean(c.lines, sharing)},
                            {"by_caches", means}});
        }
    return {{"line_bytes", sharing.line_bytes()},
            {"interval_cycles", sharing.interval()},
            {"looks", sharing.looks()},
            {"structures", structures},
            {"cores", cores},
            {"held", held}};
}

const std::vector<Explanation>& sharing_explanations() {
    static const std::vector<Explanation> all{
        {"sharing.line_bytes", "bytes", "of a line of an L1; all of sharing is absent without --sharing"},
        {"sharing.interval_cycles", "cycles", "after which the caches were looked at again, whole windows"},
        {"sharing.looks", "", "times that they were"},
        {"sharing.structures[].structure", "", "of data, as which its lines were first accessed"},
        {"sharing.structures[].lines", "", "different lines that cores accessed, prefetches left out"},
        {"sharing.structures[].by_cores[]", "", "of these, lines that one core accessed, that two did, ..."},
        {"sharing.structures[].written_by_cores[]", "", "likewise, of lines that any core wrote"},
        {"sharing.structures[].bytes_read", "bytes", "different bytes that any core read"},
        {"sharing.structures[].bytes_read_by_several", "bytes",
         "of these, bytes that two cores or more read"},
        {"sharing.structures[].transfers", "",
         "times that a core accessed a line that another one had written since it last did: what private "
         "caches of any "
         "size must move"},
        {"sharing.structures[].invalidations", "",
         "copies of a line that others had read or written since its last write, when it was written again: "
         "what private "
         "caches of any size must drop"},
        {"sharing.cores[].core", "", "number through all tiles"},
        {"sharing.cores[].lines", "", "different lines that it accessed"},
        {"sharing.cores[].alone", "", "of these, lines that no other core accessed"},
        {"sharing.held[].level", "", "of caches within tiles"},
        {"sharing.held[].structure", "", "of data"},
        {"sharing.held[].copies", "",
         "lines that all caches of the level held, each as often as it was there; mean of looks"},
        {"sharing.held[].lines", "", "different lines of these; mean of looks"},
        {"sharing.held[].by_caches[]", "", "lines that one cache held, that two did, ...; means of looks"}};
    return all;
}

} // namespace sim
