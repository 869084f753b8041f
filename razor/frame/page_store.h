// Topology pages in frame memory, made once each on request, one after the other as they are asked for.
#pragma once

#include "isa/address_space.h"
#include "isa/services.h"
#include "razor/frame/layout.h"
#include "razor/surface/pages.h"

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

namespace razor {

class PageStore final : public isa::page_service {
public:
    /// The meshes' classes follow each other. Keeps references to meshes and topologies.
    /// `bytes`: of all pages, at most; 0: as many as there are numbers for.
    PageStore(const std::vector<Mesh>& meshes, const std::vector<Topology>& topologies,
              std::uint64_t bytes = 0);
    ~PageStore();

    /// How many entries and lines lay_out() wants.
    std::size_t entry_count() const { return entries_; }
    std::size_t line_count() const { return classes_.empty() ? 0 : lines_; }
    std::size_t class_count() const { return classes_.size(); }
    /// Fills in the class records. Entries and lines are zero, and take memory where they are written only.
    void lay_out(PageEntry* entries, Line* lines, ClassRecord* records);

    /// Any thread; see isa::page_service. `space` is a class, `kind` a PageKind. Throws isa::trapped if there
    /// is no line left.
    void make_page(std::int32_t space, std::int32_t kind, std::int32_t index) override;

    std::int64_t made_bytes() const { return made_bytes_.load(); }
    double seconds() const { return static_cast<double>(nanoseconds_.load()) * 1e-9; }

private:
    struct Class {
        int mesh, local;
        std::size_t first_entry;
        const PageMaker* maker;
    };
    std::int32_t allocate(std::size_t floats);

    const std::vector<Topology>& topologies_;
    std::vector<std::unique_ptr<PageMaker>> makers_; // null for bilinear meshes
    std::vector<Class> classes_;
    std::size_t entries_ = 0;
    std::size_t lines_;
    ClassRecord* records_ = nullptr;
    std::array<std::mutex, 64> locks_; // by key: one page is made once
    std::atomic<std::size_t> next_line_{1};
    std::atomic<std::int64_t> made_bytes_{0}, nanoseconds_{0};
};

} // namespace razor
