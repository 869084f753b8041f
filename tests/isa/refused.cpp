// What the types of the vocabulary refuse. refused.py compiles this file once as it stands, which must
// succeed, and once with each case, which must fail inside that case. A case marked [simulated] is refused by
// that target only, which every kernel is compiled for.
#include "isa/isa.h"

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
#if CASE == 1 // a comparison becomes a bool
    bool decided = x < 1.0F;
#elif CASE == 2  // if on a condition without branch()
    if (b)
        n = 1;
#elif CASE == 3  // a loop on a condition without branch()
    for (sint i = 0; i < n; ++i)
        x = x + x;
#elif CASE == 4  // while on a mask
    while (any(m))
        m = clear_first(m);
#elif CASE == 5  // ?: on a condition
    x = b ? x : sfloat(1.0F);
#elif CASE == 6  // && of conditions
    n = select(b && (x < 1.0F), n, sint(0));
#elif CASE == 7  // || of conditions
    n = select(b || (x < 1.0F), n, sint(0));
#elif CASE == 8  // && of masks
    m = m && m;
#elif CASE == 9  // sint to int
    int plain = n;
#elif CASE == 10 // an array indexed by a sint
    n = table[n];
#elif CASE == 11 // sfloat to float
    float plain = x;
#elif CASE == 12 // switch on a sint
    switch (n) {
    default:
        break;
    }
#elif CASE == 13 // a handle dereferenced
    node plain = *p;
#elif CASE == 14 // a member through a handle
    n = p->count;
#elif CASE == 15 // a handle indexed
    node plain = p[0];
#elif CASE == 16 // a handle to a pointer
    node* plain = p;
#elif CASE == 17 // a handle as a condition
    if (p)
        n = 1;
#elif CASE == 18 // a shared word loaded
    n = load(field(p, &node::state));
#elif CASE == 19 // a shared word stored
    store(field(p, &node::state), n);
#elif CASE == 20 // a shared word read as a number
    isa::shared<std::int32_t> word;
    n = word;
#elif CASE == 21 // an atomic on a word that is not shared
    n = fetch_add(field(p, &node::count), sint(1));
#elif CASE == 22 // a whole record loaded
    auto plain = load(p);
#elif CASE == 23 // a store through a handle to const
    store(data, x);
#elif CASE == 24 // sfloat from an int
    x = 1;
#elif CASE == 25 // sfloat from a double
    x = 1.0;
#elif CASE == 26 // sint from a float
    n = 1.0F;
#elif CASE == 27 // sfloat from a sint without to_float()
    x = n;
#elif CASE == 28 // vfloat from an int
    a = 1;
#elif CASE == 29 // vmask from an int
    m = 1;
#elif CASE == 30 // sbool from an int
    b = 1;
#elif CASE == 31 // math of C on a vocabulary value
    x = __builtin_sinf(x);
#elif CASE == 32 // [simulated] the payload of a value
    n = sint(n.v);
#elif CASE == 33 // [simulated] the payload by its private name
    auto plain = n.value_;
#elif CASE == 34 // [simulated] the host's pointer
    auto plain = p.host();
#elif CASE == 35 // [simulated] a branch that the machine does not see
    if ((x < 1.0F).v)
        n = 1;
#elif CASE != 0
#error "no such case"
#endif
}

} // namespace refused::ISA_TARGET
