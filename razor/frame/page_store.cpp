#include "razor/frame/page_store.h"

#include <chrono>
#include <cstring>

namespace razor {

PageStore::PageStore(const std::vector<Mesh>& meshes, const std::vector<Topology>& topologies)
    : topologies_(topologies) {
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        const Topology& t = topologies[m];
        makers_.push_back(t.classes.empty() ? nullptr : std::make_unique<PageMaker>(meshes[m], t));
        for (std::size_t i = 0; i < t.classes.size(); ++i) {
            classes_.push_back({static_cast<int>(m), static_cast<int>(i), lines_, makers_.back().get()});
            lines_ += class_lines(t.classes[i], t.max_exponent);
        }
    }
}

PageStore::~PageStore() = default;

void PageStore::lay_out(Line* pages, ClassRecord* records) {
    records_ = records;
    for (std::size_t i = 0; i < classes_.size(); ++i) {
        const Class& c = classes_[i];
        const Topology& t = topologies_[static_cast<std::size_t>(c.mesh)];
        records[i] = class_record(t.classes[static_cast<std::size_t>(c.local)], t.max_exponent);
        records[i].pages.set(pages + c.first_line);
    }
}

void PageStore::make_page(std::int32_t space, std::int32_t kind, std::int32_t index) {
    const ClassRecord& record = records_[space];
    Line* page =
        record.pages.get() + record.first[kind] + static_cast<std::int64_t>(index) * record.stride[kind];
    auto& present = reinterpret_cast<PageHeader*>(page)->present.word;
    std::size_t lock = (static_cast<std::size_t>(space) * 7919 + static_cast<std::size_t>(kind) * 131 +
                        static_cast<std::size_t>(index)) %
                       locks_.size();
    std::lock_guard guard(locks_[lock]);
    if (std::atomic_ref(present).load(std::memory_order_acquire) != 0)
        return;
    auto begin = std::chrono::steady_clock::now();
    const Class& c = classes_[static_cast<std::size_t>(space)];
    PageKey key = page_key(c.local, static_cast<PageKind>(kind), index, record.corner_count, record.strips);
    std::vector<float> weights(page_floats(key, record.control_count));
    c.maker->make(key, weights.data());
    std::memcpy(page + 1, weights.data(), weights.size() * sizeof(float));
    made_bytes_ += static_cast<std::int64_t>(weights.size() * sizeof(float)) + line_bytes;
    nanoseconds_ += std::chrono::nanoseconds(std::chrono::steady_clock::now() - begin).count();
    std::atomic_ref(present).store(1, std::memory_order_release);
}

} // namespace razor
