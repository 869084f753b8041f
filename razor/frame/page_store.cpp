#include "razor/frame/page_store.h"

#include <algorithm>
#include <chrono>
#include <cstring>

namespace razor {
namespace {

constexpr std::uint64_t most_lines = std::uint64_t{1} << 30; // 64 GiB; line 0 is nobody's

} // namespace

PageStore::PageStore(const std::vector<Mesh>& meshes, const std::vector<Topology>& topologies,
                     std::uint64_t bytes)
    : topologies_(topologies),
      lines_(bytes == 0 ? most_lines : std::min(most_lines, bytes / line_bytes + 1)) {
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        const Topology& t = topologies[m];
        makers_.push_back(t.classes.empty() ? nullptr : std::make_unique<PageMaker>(meshes[m], t));
        for (std::size_t i = 0; i < t.classes.size(); ++i) {
            classes_.push_back({static_cast<int>(m), static_cast<int>(i), entries_, makers_.back().get()});
            entries_ += static_cast<std::size_t>(class_entries(t.classes[i], t.max_exponent));
        }
    }
}

PageStore::~PageStore() = default;

void PageStore::lay_out(PageEntry* entries, Line* lines, ClassRecord* records) {
    records_ = records;
    for (std::size_t i = 0; i < classes_.size(); ++i) {
        const Class& c = classes_[i];
        const Topology& t = topologies_[static_cast<std::size_t>(c.mesh)];
        records[i] = class_record(t.classes[static_cast<std::size_t>(c.local)], t.max_exponent);
        records[i].entries.set(entries + c.first_entry);
        records[i].lines.set(lines);
    }
}

std::int32_t PageStore::allocate(std::size_t floats) {
    constexpr std::size_t line_floats = line_bytes / sizeof(float);
    const std::size_t lines = (floats + line_floats - 1) / line_floats;
    const std::size_t first = next_line_.fetch_add(lines);
    if (first + lines > lines_)
        isa::throw_trapped(trap_pages_full);
    return static_cast<std::int32_t>(first);
}

void PageStore::make_page(std::int32_t space, std::int32_t kind, std::int32_t index) {
    const ClassRecord& record = records_[space];
    auto& entry = record.entries.get()[record.first[kind] + index].line.word;
    std::size_t lock = (static_cast<std::size_t>(space) * 7919 + static_cast<std::size_t>(kind) * 131 +
                        static_cast<std::size_t>(index)) %
                       locks_.size();
    std::lock_guard guard(locks_[lock]);
    if (std::atomic_ref(entry).load(std::memory_order_acquire) != 0)
        return;
    auto begin = std::chrono::steady_clock::now();
    const Class& c = classes_[static_cast<std::size_t>(space)];
    PageKey key = page_key(c.local, static_cast<PageKind>(kind), index, record.corner_count);
    const bool displaced = topologies_[static_cast<std::size_t>(c.mesh)].displaced;
    std::vector<float> weights(page_floats(key, record.control_count, displaced));
    c.maker->make(key, weights.data());
    const std::int32_t line = allocate(weights.size());
    std::memcpy(record.lines.get() + line, weights.data(), weights.size() * sizeof(float));
    made_bytes_ += static_cast<std::int64_t>(weights.size() * sizeof(float));
    nanoseconds_ += std::chrono::nanoseconds(std::chrono::steady_clock::now() - begin).count();
    std::atomic_ref(entry).store(line, std::memory_order_release);
}

} // namespace razor
