#include "traces/convert.h"

#include "traces/in_order.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace traces {

bool Conversion::step() {
    const bool more = input_.next(block_);
    output_.describe(input_.description());
    if (!more)
        return false;
    for (const Turn& turn : block_.order)
        windows_ |= turn.what != Turn::What::references;
    if (!holds_.order)
        block_.order.clear();
    each_in_order(
        block_,
        [&](const Segment& s, std::size_t i) {
            convert({block_.times[i], block_.addresses[i], s.stream, block_.what(i), block_.tile(i)});
        },
        [&](const Turn& turn) { output_.mark(turn); });
    return true;
}

/// What a target without the kind gets in its place: of a line or word that is written, a write; of a
/// modification, a read and a write; of what is no access, nothing. Where nothing is written, every access is
/// read.
void Conversion::convert(Reference r) {
    ++read_;
    streams_ |= r.stream != 0;
    size_ |= r.what.size != 0;
    sites_ |= r.what.site != 0;
    names_ |= r.what.structure != 0 || r.what.phase != 0 || r.what.work != 0;
    parts_ |= r.what.part != Part::operation || r.what.detail != 0;
    tiles_ |= r.tile != 0;
    if (r.address == 0 && !holds_.zero) {
        ++zeros_;
        return;
    }
    const auto put = [&](Kind kind) {
        r.what.kind = kind;
        output_.write(r);
        ++written_;
    };
    const Kind kind = r.what.kind;
    const auto number = static_cast<std::size_t>(kind);
    const bool written = kind == Kind::write || kind == Kind::write_back || kind == Kind::write_through;
    if (holds_.holds(kind)) {
        put(kind);
    } else if (written || kind == Kind::modify) {
        ++replaced_[number];
        if (!written || !holds_.holds(Kind::write))
            put(Kind::read);
        if (holds_.holds(Kind::write))
            put(Kind::write);
    } else {
        ++left_out_[number];
    }
}

std::string Conversion::lost() const {
    std::vector<std::string> fields, parts;
    const auto field = [&](bool met, bool held, const char* name) {
        if (met && !held)
            fields.emplace_back(name);
    };
    const Description& about = input_.description();
    field(about.time != "order", holds_.time, "times");
    field(streams_, holds_.streams, "threads");
    field(size_, holds_.size, "sizes");
    field(sites_, holds_.sites, "sites");
    field(names_, holds_.names, "structures, phases and work");
    field(parts_, holds_.parts, "operations and details");
    field(windows_, holds_.order, "the order of streams and its windows");
    field(tiles_, holds_.tiles, "screen tiles");
    bool named = false; // a thread, otherwise than by its number
    for (std::size_t s = 0; s < about.streams.size(); ++s)
        named |= about.streams[s] != fmt::format("thread {}", s);
    field(named, holds_.description, "thread names");
    field(!about.level.empty(), holds_.description || about.level == holds_.level, "level");
    field(about.line_bytes != 0, holds_.description, "line size");
    field(about.sample < 1, holds_.description, "sampled fraction");
    field(!about.filters.empty(), holds_.description, "filters");
    field(!about.program.empty() && about.program != "unknown", holds_.description, "program");
    field(!about.configuration.empty(), holds_.description, "configuration");
    field(!about.regions.empty(), holds_.description, "regions");
    if (!fields.empty())
        parts.push_back(fmt::format("{} are lost", fmt::join(fields, ", ")));
    if (zeros_ != 0)
        parts.push_back(fmt::format("{} references to address 0 are left out", zeros_));
    if (!holds_.unit.empty() && about.time != holds_.unit && about.time != "order")
        parts.push_back(fmt::format("times are {}, which pass for {}{}", about.time, holds_.unit,
                                    holds_.unit == "clocks" ? " of memory" : ""));
    for (std::size_t k = 0; k < kind_names.size(); ++k) {
        if (replaced_[k] != 0)
            parts.push_back(fmt::format("{} {} references are {}", replaced_[k], kind_names[k],
                                        !holds_.holds(Kind::write)             ? "reads"
                                        : static_cast<Kind>(k) == Kind::modify ? "a read and a write each"
                                                                               : "writes"));
        if (left_out_[k] != 0)
            parts.push_back(fmt::format("{} {} references are left out", left_out_[k], kind_names[k]));
    }
    return fmt::format("{}", fmt::join(parts, "; "));
}

} // namespace traces
