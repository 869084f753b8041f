#include "tests/sim/dram_checker.h"

#include <algorithm>
#include <tuple>

namespace sim::test {
namespace {

using Kind = DramCommand::Kind;

class Checker {
public:
    explicit Checker(const MemoryConfig& config) : c(config) {}

    void check(std::vector<DramCommand> log) {
        std::stable_sort(log.begin(), log.end(), [](const DramCommand& a, const DramCommand& b) {
            return std::tie(a.channel, a.at) < std::tie(b.channel, b.at);
        });
        const integer far = std::max({c.tRFC, c.tRC, c.tFAW, c.tCL, c.tCWL + c.tWR, c.tCWL + c.tWTR_L}) + 100;
        for (std::size_t j = 0; j < log.size(); ++j) {
            for (std::size_t i = j; i-- > 0;) {
                if (log[i].channel != log[j].channel || time(log[j]) - time(log[i]) > far)
                    break;
                pair(log[i], log[j]);
            }
            state(log[j]);
            activates(log, j);
            refreshes(log[j]);
        }
    }
    std::map<std::string, int> broken;

private:
    static integer time(const DramCommand& x) { return static_cast<integer>(x.at); }
    static bool column(const DramCommand& x) { return x.kind == Kind::read || x.kind == Kind::write; }
    static bool closes(const DramCommand& x) {
        return x.kind == Kind::precharge || x.kind == Kind::precharge_all;
    }
    integer data(const DramCommand& x) const { return time(x) + (x.kind == Kind::read ? c.tCL : c.tCWL); }

    void rule(const char* name, bool kept) {
        if (!kept)
            ++broken[name];
    }

    void pair(const DramCommand& a, const DramCommand& b) {
        integer gap = time(b) - time(a);
        if (!a.automatic && !b.automatic && (c.command_buses == 1 || column(a) == column(b)))
            rule("command bus", gap > 0);
        if (column(a) && column(b))
            buses(a, b);
        if (a.rank != b.rank)
            return;
        if (column(a) && column(b))
            columns(a, b, gap);
        if (a.kind == Kind::activate && b.kind == Kind::activate)
            rule(a.group == b.group ? "tRRD_L" : "tRRD_S", gap >= (a.group == b.group ? c.tRRD_L : c.tRRD_S));
        bool same = a.group == b.group && a.bank == b.bank;
        if (a.kind == Kind::refresh)
            rule("tRFC", gap >= c.tRFC);
        if (a.kind == Kind::refresh_bank && same)
            rule("tRFCpb", gap >= c.tRFCpb);
        if (a.kind == Kind::refresh_bank && !same &&
            (b.kind == Kind::activate || b.kind == Kind::refresh_bank))
            rule("tRREFD", gap >= c.tRREFD);
        if (a.kind == Kind::activate && b.kind == Kind::refresh_bank && !same)
            rule("tRRD before refresh", gap >= (a.group == b.group ? c.tRRD_L : c.tRRD_S));
        if (b.kind == Kind::refresh) {
            if (closes(a))
                rule("tRP", gap >= c.tRP);
            if (a.kind == Kind::activate)
                rule("tRC", gap >= c.tRC);
        }
        if (same || a.kind == Kind::precharge_all || b.kind == Kind::precharge_all)
            same_bank(a, b, gap);
    }

    void buses(const DramCommand& a, const DramCommand& b) {
        integer idle = data(b) - data(a) - c.burst_clocks();
        rule("data bus", idle >= 0);
        if (a.rank != b.rank)
            rule("tRTRS", idle >= c.tRTRS);
        if (a.kind == Kind::read && b.kind == Kind::write)
            rule("tRTW", idle >= c.tRTW);
    }

    void columns(const DramCommand& a, const DramCommand& b, integer gap) {
        bool near = a.group == b.group;
        if (a.kind == b.kind)
            rule(near ? "tCCD_L" : "tCCD_S", gap >= (near ? c.tCCD_L : c.tCCD_S));
        if (a.kind == Kind::write && b.kind == Kind::read)
            rule(near ? "tWTR_L" : "tWTR_S",
                 time(b) >= data(a) + c.burst_clocks() + (near ? c.tWTR_L : c.tWTR_S));
    }

    void same_bank(const DramCommand& a, const DramCommand& b, integer gap) {
        if (a.kind == Kind::activate) {
            if (b.kind == Kind::activate)
                rule("tRC", gap >= c.tRC);
            if (column(b))
                rule("tRCD", gap >= c.tRCD);
            if (closes(b))
                rule("tRAS", gap >= c.tRAS);
            if (b.kind == Kind::refresh_bank)
                rule("tRC", gap >= c.tRC);
        }
        if (closes(a) && b.kind == Kind::refresh_bank)
            rule("tRP", gap >= c.tRP);
        if (closes(a) && b.kind == Kind::activate)
            rule("tRP", gap >= c.tRP);
        if (a.kind == Kind::read && closes(b))
            rule("tRTP", gap >= c.tRTP);
        if (a.kind == Kind::write && closes(b))
            rule("tWR", time(b) >= data(a) + c.burst_clocks() + c.tWR);
    }

    /// Which row each bank has open.
    void state(const DramCommand& x) {
        auto bank = std::tuple(x.channel, x.rank, x.group, x.bank);
        auto first = std::tuple(x.channel, x.rank, 0U, 0U), end = std::tuple(x.channel, x.rank + 1, 0U, 0U);
        switch (x.kind) {
        case Kind::activate:
            rule("state", open.emplace(bank, x.row).second);
            break;
        case Kind::precharge:
            rule("state", open.erase(bank) == 1);
            break;
        case Kind::precharge_all:
            open.erase(open.lower_bound(first), open.lower_bound(end));
            break;
        case Kind::refresh:
            rule("state", open.lower_bound(first) == open.lower_bound(end));
            break;
        case Kind::refresh_bank:
            rule("state", open.count(bank) == 0);
            break;
        case Kind::read:
        case Kind::write:
            rule("state", open.count(bank) == 1 && open.at(bank) == x.row);
            break;
        }
    }

    void activates(const std::vector<DramCommand>& log, std::size_t j) {
        const DramCommand& x = log[j];
        if (x.kind != Kind::activate)
            return;
        int others = 0;
        for (std::size_t i = j; i-- > 0 && log[i].channel == x.channel && time(x) - time(log[i]) < c.tFAW;)
            others += log[i].kind == Kind::activate && log[i].rank == x.rank ? 1 : 0;
        rule("tFAW", others < 4);
    }

    void refreshes(const DramCommand& x) {
        if (x.kind != Kind::refresh && x.kind != Kind::refresh_bank)
            return;
        integer turns = x.kind == Kind::refresh ? 1 : c.bank_groups * c.banks;
        integer number = refreshed[{x.channel, x.rank}]++;
        if (x.kind == Kind::refresh_bank)
            rule("refresh order", x.group * c.banks + x.bank == number % turns);
        integer due = c.tREFI + c.tREFI * (number * c.ranks + x.rank) / (turns * c.ranks);
        // One that is put off may meet other ranks' commands on the bus.
        integer latest = c.refresh_postponed == 0 ? due : due + c.refresh_postponed * c.tREFI + 2 * c.ranks;
        rule("refresh time", time(x) >= due && time(x) <= latest);
    }

    const MemoryConfig& c;
    std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>, std::uint64_t> open;
    std::map<std::pair<std::uint32_t, std::uint32_t>, integer> refreshed;
};

} // namespace

std::map<std::string, int> broken_rules(const MemoryConfig& c, std::vector<DramCommand> log) {
    Checker checker(c);
    checker.check(std::move(log));
    return checker.broken;
}

} // namespace sim::test
