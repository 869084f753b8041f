#include "traces/summary.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace traces {
namespace {

double each(std::uint64_t bytes, std::uint64_t references) {
    return static_cast<double>(bytes) / static_cast<double>(std::max<std::uint64_t>(1, references));
}

} // namespace

void Summary::add(const Block& block) {
    references_ += block.size();
    for (const Segment& s : block.segments)
        streams_[s.stream] += s.end - s.begin;
    for (const std::uint64_t t : block.times) {
        first_ = std::min(first_, t);
        last_ = std::max(last_, t);
    }
    for (std::size_t i = 0; i < block.tiles.size(); ++i) {
        for_tiles_ += block.tiles[i] != 0 ? 1 : 0;
        if (block.tiles[i] != 0 && (i == 0 || block.tiles[i] != block.tiles[i - 1]))
            tiles_.insert(block.tiles[i]);
    }
    std::vector<std::uint64_t> count(block.table.size(), 0);
    for (const std::uint32_t c : block.classes)
        ++count[c];
    for (std::size_t c = 0; c < count.size(); ++c) {
        const Class& what = block.table[c];
        structures_[what.structure] += count[c];
        phases_[what.phase] += count[c];
        work_[what.work] += count[c];
        kinds_[static_cast<std::uint64_t>(what.kind)] += count[c];
        bytes_ += count[c] * what.size;
    }
}

std::vector<Summary::Table> Summary::tables(const Description& d) const {
    const auto table = [](const char* name, const Counts& counts, auto name_of) {
        Table out{name, {}};
        for (const auto& [number, count] : counts)
            out.rows.push_back({name_of(number), count});
        return out;
    };
    const auto in = [](const std::vector<std::string>& names, const char* otherwise) {
        return [&names, otherwise](std::uint64_t n) {
            return n < names.size() ? names[n] : fmt::format("{} {}", otherwise, n);
        };
    };
    return {table("threads", streams_, in(d.streams, "thread")),
            table("structures", structures_, in(d.structures, "structure")),
            table("phases", phases_, in(d.phases, "phase")), table("work", work_, in(d.work, "work")),
            table("kinds", kinds_, [](std::uint64_t n) { return std::string(kind_names[n]); })};
}

std::string Summary::text(const Description& d, const File& file) const {
    std::string out = fmt::format("{}: {}, {} references", file.name, file.format, references_);
    if (file.bytes != 0)
        out += fmt::format(" in {} bytes, {:.2f} each", file.bytes, each(file.bytes, references_));
    out += file.note.empty() ? "\n" : fmt::format("\n{}\n", file.note);
    out += fmt::format("written by {}", d.program.empty() ? "unknown" : d.program);
    if (!d.level.empty())
        out += fmt::format(", seen at {}", d.level);
    if (d.line_bytes != 0)
        out += fmt::format(", lines of {} bytes", d.line_bytes);
    if (d.sample < 1)
        out += fmt::format(", of a sample of {:g} of all lines", d.sample);
    if (!d.filters.empty())
        out += fmt::format(", only {}", d.filters);
    if (references_ != 0)
        out += fmt::format("\ntimes {} to {} ({}), {} bytes referenced", first_, last_, d.time, bytes_);
    if (const Picture& p = d.picture; p.tiles() != 0)
        out += fmt::format(
            "\n{} references are for {} of {} screen tiles of {} x {} pixels, of a picture of {} x {}",
            for_tiles_, tiles_.size(), p.tiles(), p.side, p.side, p.width, p.height);
    out += '\n';
    for (const Table& t : tables(d)) {
        out += fmt::format("\n{:<40} {:>15} {:>7}\n", t.name, "references", "%");
        for (const Row& row : t.rows)
            out += fmt::format("{:<40} {:>15} {:>7.2f}\n", row.name, row.count,
                               100 * each(row.count, references_));
    }
    return out;
}

std::string Summary::json(const Description& d, const File& file) const {
    nlohmann::ordered_json out{{"file", file.name},
                               {"format", file.format},
                               {"program", d.program},
                               {"level", d.level},
                               {"time", d.time},
                               {"line_bytes", d.line_bytes},
                               {"sample", d.sample},
                               {"filters", d.filters},
                               {"references", references_},
                               {"referenced_bytes", bytes_},
                               {"complete", file.note.empty()},
                               {"note", file.note}};
    if (references_ != 0)
        out["times"] = {first_, last_};
    if (file.bytes != 0) {
        out["bytes"] = file.bytes;
        out["bytes_per_reference"] = each(file.bytes, references_);
    }
    if (const Picture& p = d.picture; p.tiles() != 0)
        out["screen_tiles"] = {
            {"width", p.width},   {"height", p.height},          {"side", p.side},
            {"tiles", p.tiles()}, {"referenced", tiles_.size()}, {"references", for_tiles_}};
    for (const Table& t : tables(d)) {
        nlohmann::ordered_json& rows = out[t.name] = nlohmann::ordered_json::array();
        for (const Row& row : t.rows)
            rows.push_back({{"name", row.name}, {"references", row.count}});
    }
    out["configuration"] = d.configuration;
    return out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

} // namespace traces
