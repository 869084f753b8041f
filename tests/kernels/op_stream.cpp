// Renders a small scene by the simulated kernels and prints what they do: to show that it does not depend on
// the compiler. Without arguments: a hash of every 4096 events. With two numbers: these events in words.
#include "tests/kernels/cages.h"
#include "tests/kernels/recording_port.h"

#include "razor/frame/frame.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace razor::test {
namespace {

constexpr const char* names[] = {
    "vector_op",    "cross_op",       "cross_to_scalar", "scalar_op", "branch",
    "load",         "load_broadcast", "load_vector",     "gather",    "store",
    "store_vector", "scatter",        "prefetch",        "discard",   "before_atomic",
    "after_atomic", "wait_while",     "request_page",    "phase"};

class Printer final : public Listener {
public:
    Printer(isa::address_space& memory, long first, long last)
        : memory_(memory), first_(first), last_(last) {}

    void event(Event kind, isa::timing::site where, std::uint32_t detail,
               std::span<const std::uint32_t> operands, std::uint32_t) override {
        if (++events_ % 4096 == 0 && last_ == 0)
            hash();
        // Sites count by file name and line: where the source lies is nobody's business.
        const char* slash = where.file == nullptr ? nullptr : std::strrchr(where.file, '/');
        const char* file = where.file == nullptr ? "" : slash != nullptr ? slash + 1 : where.file;
        add(static_cast<std::uint64_t>(kind));
        add(detail);
        add(where.line);
        for (const char* c = file; *c != 0; ++c)
            add(static_cast<unsigned char>(*c));
        for (std::uint32_t o : operands)
            add(o);
        if (!printing())
            return;
        std::printf("%ld %s %u %s:%u (", events_, names[static_cast<int>(kind)], detail, file, where.line);
        for (std::uint32_t o : operands)
            std::printf(" %u", o);
        std::printf(" )\n");
    }
    void read(const void* p, std::uint32_t bytes) override { touch("read", p, bytes); }
    void write(const void* p, std::uint32_t bytes) override { touch("write", p, bytes); }
    void hash() const { std::printf("%ld %016llx\n", events_, static_cast<unsigned long long>(hash_)); }

private:
    bool printing() const { return events_ >= first_ && events_ < last_; }
    void add(std::uint64_t x) { hash_ = (hash_ ^ x) * 0x9e3779b97f4a7c15ULL + (hash_ >> 29); }
    void touch(const char* what, const void* p, std::uint32_t bytes) {
        std::uint64_t offset = memory_.offset(p);
        add(offset);
        add(bytes);
        if (printing())
            std::printf("  %s %llx +%u\n", what, static_cast<unsigned long long>(offset), bytes);
    }
    isa::address_space& memory_;
    long first_, last_, events_ = 0;
    std::uint64_t hash_ = 0;
};

} // namespace
} // namespace razor::test

int main(int count, char** arguments) {
    using namespace razor::test;
    long first = count > 2 ? std::atol(arguments[1]) : 0;
    long last = count > 2 ? std::atol(arguments[2]) : 0;
    for (const char* name : {"default", "urchin_stretched", "torus_bilinear"}) {
        razor::Scene scene = named_scene(name)->scene;
        scene.settings.width = scene.settings.height = 16;
        razor::Frame frame(scene, {});
        Printer printer(frame.memory(), first, last);
        std::printf("%s\n", name);
        listen(&printer);
        frame.render(razor::simulated::kernels, 0);
        listen(nullptr);
        printer.hash();
    }
    return 0;
}
