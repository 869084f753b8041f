// Topology pages in frame memory: addresses fixed by their keys, made once each on request.
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
    PageStore(const std::vector<Mesh>& meshes, const std::vector<Topology>& topologies);
    ~PageStore();

    /// Bytes of virtual addresses that all pages span.
    std::uint64_t span_bytes() const { return static_cast<std::uint64_t>(lines_) * line_bytes; }
    std::size_t class_count() const { return classes_.size(); }
    /// Fills in the class records, whose pages begin at `pages`.
    void lay_out(Line* pages, ClassRecord* records);

    /// Any thread; see isa::page_service. `space` is a class, `kind` a PageKind.
    void make_page(std::int32_t space, std::int32_t kind, std::int32_t index) override;

    std::int64_t made_bytes() const { return made_bytes_.load(); }
    double seconds() const { return static_cast<double>(nanoseconds_.load()) * 1e-9; }

private:
    struct Class {
        int mesh, local;
        std::int64_t first_line;
        const PageMaker* maker;
    };
    const std::vector<Topology>& topologies_;
    std::vector<std::unique_ptr<PageMaker>> makers_; // null for bilinear meshes
    std::vector<Class> classes_;
    std::int64_t lines_ = 0;
    ClassRecord* records_ = nullptr;
    std::array<std::mutex, 64> locks_; // by key: one page is made once
    std::atomic<std::int64_t> made_bytes_{0}, nanoseconds_{0};
};

} // namespace razor
