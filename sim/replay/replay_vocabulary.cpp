// What classes of references do, and what they count under.
#include "sim/replay/replay.h"

#include "sim/trace/passing.h"
#include "traces/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace sim {
namespace {

using What = ReplayAction::What;

/// What a core asked for in vain.
What what_of(Passing::Asks asks) {
    return asks == Passing::read     ? What::read
           : asks == Passing::write  ? What::write
           : asks == Passing::change ? What::change
                                     : What::nothing;
}

What what_of(const traces::Class& c, const ReplayOptions& options) {
    const bool aside = c.part == traces::Part::aside;
    switch (c.kind) {
    case traces::Kind::read:
        return What::read;
    case traces::Kind::write:
        return What::write;
    case traces::Kind::modify:
        return aside ? What::change : What::read;
    case traces::Kind::fetch:
        return options.fetches ? What::read : What::nothing;
    case traces::Kind::prefetch:
        return What::prefetch;
    case traces::Kind::write_through:
        return aside ? What::release : What::nothing;
    case traces::Kind::flush:
        return What::discard;
    case traces::Kind::invalidate:
        return What::invalidate;
    case traces::Kind::invalidate_all:
        return What::invalidate_all;
    case traces::Kind::refused:
        return c.detail == 0 ? What::nothing : what_of(Passing(c.detail).asks());
    default:
        return What::nothing;
    }
}

/// Memory reads and writes, whatever for.
What what_at_memory(traces::Kind kind) {
    switch (kind) {
    case traces::Kind::read:
    case traces::Kind::modify:
    case traces::Kind::fetch:
    case traces::Kind::prefetch:
    case traces::Kind::write:
    case traces::Kind::write_back:
    case traces::Kind::write_through:
        return What::pass;
    default:
        return What::nothing;
    }
}

} // namespace

/// Tables of a trace without regions may grow while it is read.
ReplayVocabulary::ReplayVocabulary(const traces::Description& about, const ReplayOptions& options)
    : options_(options), level_(about.level == "core" ? "" : about.level),
      by_work_(!about.regions.empty() && about.phases.size() * about.work.size() <= max_columns),
      phases_(by_work_ ? about.phases.size() : max_columns) {
    labels_.phases = about.phases;
    labels_.kinds = by_work_ ? about.work : std::vector<std::string>{"all"};
    if (labels_.phases.size() > max_columns)
        throw traces::Error(
            fmt::format("the trace has {} phases, of which at most {} can be told apart; leave "
                        "some out",
                        labels_.phases.size(), max_columns));
    labels_.phases.resize(phases_);
}

void ReplayVocabulary::learn(const std::vector<traces::Class>& table,
                             std::vector<ReplayAction>& actions) const {
    actions.clear();
    for (const traces::Class& c : table) {
        if (c.phase >= phases_ || c.structure >= most_replayed_structures ||
            (by_work_ && c.work >= labels_.kinds.size()))
            throw traces::Error(
                fmt::format("the trace has more than {} phases or {} structures, which cannot be "
                            "told apart; leave some out",
                            max_columns, most_replayed_structures));
        ReplayAction a;
        a.what = level_.empty()     ? what_of(c, options_)
                 : level_ == "dram" ? what_at_memory(c.kind)
                 : c.detail != 0    ? What::pass
                                    : What::nothing;
        a.kind = c.kind;
        a.detail = c.detail;
        if (!level_.empty() && level_ != "dram" && c.kind == traces::Kind::read && c.detail == 0)
            throw traces::Error(
                fmt::format("the trace does not say how its references pass level {}: an earlier "
                            "version recorded it; record it again",
                            level_));
        a.part = c.part;
        a.refused = c.kind == traces::Kind::refused;
        a.modifies = c.kind == traces::Kind::modify && a.what == What::read;
        a.size = std::max(c.size, 1U);
        a.structure = c.structure;
        a.column = c.phase + (by_work_ ? c.work * phases_ : 0);
        a.site = c.site;
        actions.push_back(a);
    }
}

void ReplayVocabulary::name(const traces::Description& about, Report& report) const {
    std::copy_n(about.phases.begin(), std::min(about.phases.size(), phases_), report.labels.phases.begin());
    std::copy_n(about.structures.begin(), std::min(about.structures.size(), report.structures.size()),
                report.structures.begin());
}

} // namespace sim
