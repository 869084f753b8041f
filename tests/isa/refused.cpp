// What the types of the vocabulary refuse. refused.py compiles this file without its cases, which must succeed,
// and with them, which must fail inside each of them. Those marked [simulated] are refused by that target only,
// which every kernel is compiled for.
#include "isa/isa.h"

#include <type_traits>

namespace refused::ISA_TARGET {

using namespace isa::ISA_TARGET;

struct node {
    float split;
    std::int32_t count;
    isa::shared<std::int32_t> state;
    isa::ref<node> next;
};

inline std::int32_t table[4] = {1, 2, 3, 4};

void kernel(pointer<node> p, pointer<const float> data, vfloat a, vmask m, sfloat x, sint n, sbool b);
void kernel(pointer<node> p, pointer<const float> data, vfloat a, vmask m, sfloat x, sint n, sbool b) {
    if (branch(b & (x < load(data))))
        n = load(field(p, &node::count));
    a = select(m, a, vfloat(x));
    n = n + load_acquire(field(p, &node::state));
    p = load(field(p, &node::next));
}

#ifdef CASES
#define REFUSED                                                                                                        \
    void refused(std::integral_constant<int, __LINE__>, pointer<node> p, pointer<const float> data, vfloat a, vmask m, \
                 sfloat x, sint n, sbool b)

REFUSED { // a comparison becomes a bool
    bool decided = x < 1.0F;
}

REFUSED { // if on a condition without branch()
    if (b)
        n = 1;
}

REFUSED { // a loop on a condition without branch()
    for (sint i = 0; i < n; ++i)
        x = x + x;
}

REFUSED { // while on a mask
    while (any(m))
        m = clear_first(m);
}

REFUSED { // ?: on a condition
    x = b ? x : sfloat(1.0F);
}

REFUSED { // && of conditions
    n = select(b && (x < 1.0F), n, sint(0));
}

REFUSED { // || of conditions
    n = select(b || (x < 1.0F), n, sint(0));
}

REFUSED { // && of masks
    m = m && m;
}

REFUSED { // sint to int
    int plain = n;
}

REFUSED { // an array indexed by a sint
    n = table[n];
}

REFUSED { // sfloat to float
    float plain = x;
}

REFUSED { // switch on a sint
    switch (n) {
    default:
        break;
    }
}

REFUSED { // a handle dereferenced
    node plain = *p;
}

REFUSED { // a member through a handle
    n = p->count;
}

REFUSED { // a handle indexed
    node plain = p[0];
}

REFUSED { // a handle to a pointer
    node* plain = p;
}

REFUSED { // a handle as a condition
    if (p)
        n = 1;
}

REFUSED { // a shared word loaded
    n = load(field(p, &node::state));
}

REFUSED { // a shared word stored
    store(field(p, &node::state), n);
}

REFUSED { // a shared word read as a number
    isa::shared<std::int32_t> word;
    n = word;
}

REFUSED { // an atomic on a word that is not shared
    n = fetch_add(field(p, &node::count), sint(1));
}

REFUSED { // a whole record loaded
    auto plain = load(p);
}

REFUSED { // a store through a handle to const
    store(data, x);
}

REFUSED { // sfloat from an int
    x = 1;
}

REFUSED { // sfloat from a double
    x = 1.0;
}

REFUSED { // sint from a float
    n = 1.0F;
}

REFUSED { // sfloat from a sint without to_float()
    x = n;
}

REFUSED { // vfloat from an int
    a = 1;
}

REFUSED { // vmask from an int
    m = 1;
}

REFUSED { // sbool from an int
    b = 1;
}

REFUSED { // math of C on a vocabulary value
    x = __builtin_sinf(x);
}

#ifdef ISA_TARGET_SIMULATED

REFUSED { // [simulated] the payload of a value
    n = sint(n.v);
}

REFUSED { // [simulated] the payload by its private name
    auto plain = n.value_;
}

REFUSED { // [simulated] the host's pointer
    auto plain = p.host();
}

REFUSED { // [simulated] a branch that the machine does not see
    if ((x < 1.0F).v)
        n = 1;
}

#endif
#endif

} // namespace refused::ISA_TARGET
