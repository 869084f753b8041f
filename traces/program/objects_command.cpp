// razor-trace objects: LRU caches of objects of any size.
#include "analysis/traces/object_lru.h"
#include "traces/program/analyses.h"

#include <fmt/format.h>

namespace traces {
namespace {

using analysis::Access;
using analysis::Table;

class ObjectsCommand final : public AnalysisCommand {
public:
    ObjectsCommand()
        : AnalysisCommand("objects", "misses of LRU caches of objects of any size, by their bytes", nullptr) {
        options_.without_lines();
    }
    void run() override {
        options_.prepare();
        options_.refuse_sample();
        const std::vector<std::uint64_t> sizes = parse_sizes("--sizes", sizes_);
        std::vector<analysis::ObjectLru> caches(sizes.begin(), sizes.end());
        std::vector<std::uint64_t> misses(sizes.size(), 0);
        std::uint64_t references = 0;
        analysis::Touches touches = options_.touches();
        options_.each_block([&](const Block& block) {
            touches.each_access(block, [&](const Access& a) {
                ++references;
                for (std::size_t c = 0; c < caches.size(); ++c)
                    misses[c] += caches[c].touch(a.address, a.size) ? 0 : 1;
            });
        });
        Table table;
        table.columns = {"bytes", "references", "misses", "ratio"};
        for (std::size_t c = 0; c < sizes.size(); ++c)
            table.rows.push_back(
                {sizes[c], references, misses[c],
                 references == 0 ? 0 : static_cast<double>(misses[c]) / static_cast<double>(references)});
        options_.give("objects", table, fmt::format("{} requests; an address is an object", references));
    }

private:
    void add_options(CLI::App& app) override {
        app.add_option("--sizes", sizes_, "of caches, as 128MiB..1GiB (doubling) or 128MiB,200MiB")
            ->type_name("SIZES")
            ->required();
    }
    std::string sizes_;
};

} // namespace

std::unique_ptr<AnalysisCommand> objects_command() {
    return std::make_unique<ObjectsCommand>();
}

} // namespace traces
