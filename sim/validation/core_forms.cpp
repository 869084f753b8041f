#include "sim/validation/core_forms.h"

#include "sim/machine/machine.h"

#include <fmt/format.h>

#include <algorithm>

namespace sim {
namespace {

using namespace isa::timing;

constexpr int n = 1000;

cycle u(integer x) {
    return static_cast<cycle>(x);
}
integer pieces_of(integer lanes) {
    return std::max<integer>(1, ISA_WIDTH / lanes);
}

class Forms {
public:
    void add(const std::string& name, const Config& c, integer cycles, integer instructions,
             const std::function<void()>& kernel) {
        all_.push_back({name, u(cycles), u(instructions), [c, kernel] {
                            isa::address_space space{std::uint64_t{1} << 26};
                            space.add("data", -1, std::uint64_t{1} << 20, true);
                            return Machine(c).run(space, 1, {{"work"}}, [&](int) { kernel(); });
                        }});
    }
    std::vector<CoreForm> take() { return std::move(all_); }

private:
    std::vector<CoreForm> all_;
};

void add_scalars(Forms& forms) {
    constexpr auto add = static_cast<std::size_t>(operation::add);
    for (integer latency : {1, 4, 7}) {
        Config c = plain_core();
        c.latency[add] = latency;
        forms.add(fmt::format("dependent chain, latency {}", latency), c, n * latency, n, [] {
            stamp s;
            for (int i = 0; i < n; ++i)
                s = scalar_op(operation::add, s);
        });
    }
    for (integer issue : {1, 2, 3, 4}) {
        Config c = plain_core();
        c.core.issue_width = issue;
        forms.add(fmt::format("independent operations, issue width {}", issue), c,
                  (n + issue - 1) / issue - 1 + c.latency[add], n, [] {
                      for (int i = 0; i < n; ++i)
                          scalar_op(operation::add, stamp{});
                  });
    }
    constexpr auto divide = static_cast<std::size_t>(operation::divide);
    const Config c = plain_core();
    forms.add("a unit that is not pipelined", c, (n - 1) * c.interval[divide] + c.latency[divide], n, [] {
        for (int i = 0; i < n; ++i)
            scalar_op(operation::divide, stamp{});
    });
}

void add_vectors(Forms& forms) {
    constexpr auto add = static_cast<std::size_t>(operation::add);
    constexpr auto multiply = static_cast<std::size_t>(operation::multiply);
    for (integer lanes : {1, 2, 4, 8, 64}) {
        Config c = plain_core();
        c.core.lanes = lanes;
        const integer pieces = pieces_of(lanes);
        forms.add(fmt::format("independent vectors, {} lanes", lanes), c,
                  n * pieces - 1 + c.latency[multiply], n * pieces, [] {
                      for (int i = 0; i < n; ++i)
                          vector_op(operation::multiply, stamp{});
                  });
        // A consumer follows its producer piece by piece: the longer of latency and pieces counts.
        forms.add(fmt::format("chain of vectors, {} lanes", lanes), c,
                  (n - 1) * std::max(c.latency[add], pieces) + pieces - 1 + c.latency[add], n * pieces, [] {
                      stamp s;
                      for (int i = 0; i < n; ++i)
                          s = vector_op(operation::add, s);
                  });
    }
}

// A result far away, used at once, then independent work: a window lets that work pass. The operation that
// waits is number 1; number 1 + window waits for it.
void add_windows(Forms& forms) {
    for (integer window : {1, 2, 8, 64}) {
        Config c = plain_core();
        c.core.window = window;
        c.latency[static_cast<std::size_t>(operation::add)] = 100;
        const integer after = std::max<integer>(0, 51 - window);
        forms.add(fmt::format("work behind a wait, window {}", window), c,
                  window > 50 ? 101 : 100 + after + 1, 52, [] {
                      const stamp slow = scalar_op(operation::add, stamp{});
                      scalar_op(operation::integer, slow);
                      for (int i = 0; i < 50; ++i)
                          scalar_op(operation::integer, stamp{});
                  });
    }
}

} // namespace

Config plain_core() {
    Config c;
    c.chip.cores = c.chip.threads = 1;
    c.core.lanes = 64;
    c.l1.port_bytes = 1024;
    c.core.predictor = "perfect";
    c.memory.tREFI = 0;
    return c;
}

std::vector<CoreForm> core_forms() {
    Forms forms;
    add_scalars(forms);
    add_vectors(forms);
    add_windows(forms);
    return forms.take();
}

} // namespace sim
