#include "tests/sim/kernels.h"

#include "isa/isa.h"

namespace sim::test {

using namespace isa::simulated;

namespace {

struct access_for_tests {
    static std::int32_t number(const sint& a) { return isa::simulated::access::value(a).v; }
};

void spend(int cycles) {
    sfloat a(1.0F);
    for (int i = 0; i < cycles / 4; ++i)
        a = a + sfloat(1.0F);
    branch(a > 0.0F);
}

struct LetGo {
    pointer<word> w;
    ~LetGo() { store_release(w, 7); }
};

} // namespace

std::int32_t take_ticket(word* counter, int cycles) {
    spend(cycles);
    return access_for_tests::number(fetch_add(pointer<word>(counter), 1));
}

void count_up(word* counter, int times) {
    for (sint i = 0; branch(i < times); ++i)
        fetch_add(pointer<word>(counter), 1);
}

void release_after(word* w, int cycles) {
    spend(cycles);
    store_release(pointer<word>(w), 1);
}

std::int32_t await(word* w) {
    return access_for_tests::number(wait_while(pointer<word>(w), 0));
}

void publish_numbers(std::int32_t* data, word* ready, int count) {
    pointer<std::int32_t> p(data);
    for (sint i = 0; branch(i < count); ++i)
        store(p + i, i);
    store_release(pointer<word>(ready), 1);
}

std::int32_t sum_when_published(std::int32_t* data, word* ready, int count) {
    pointer<std::int32_t> p(data);
    wait_while(pointer<word>(ready), 0);
    sint sum = 0;
    for (sint i = 0; branch(i < count); ++i) {
        sint x = load(p + i);
        sum += x;
    }
    return access_for_tests::number(sum);
}

void trap_while_holding(word* w, int code) {
    LetGo guard{pointer<word>(w)};
    spend(100);
    trap(code);
}

void await_while_holding(word* held, word* awaited) {
    LetGo guard{pointer<word>(held)};
    wait_while(pointer<word>(awaited), 0);
}

void ask_for_page(isa::page_service& service, int times, int index) {
    spend(40);
    for (int i = 0; i < times; ++i)
        request_page(service, 1, 2, index);
    spend(40);
}

void mixed_work(std::int32_t* data, word* counter, int worker, int rounds) {
    pointer<std::int32_t> all(data);
    pointer<std::int32_t> own = all + (worker + 1) * 4096;
    for (sint i = 0; branch(i < rounds); ++i) {
        sint ticket = fetch_add(pointer<word>(counter), 1);
        vint index = (lane_index() * vint(37) + vint(ticket)) & vint(1023);
        vint seen = gather(all, index, index > vint(100));
        vfloat x = to_float(seen) + 1.5F;
        vfloat y = fma(x, x, sqrt(x)) / x;
        vmask some = y > vfloat(2.0F);
        if (branch(any(some)))
            y = y + x;
        vint out = to_int(min(y, vfloat(1000.0F)));
        scatter(own, index, out, some);
        pointer<std::int32_t> row = own + i * isa::width;
        store_vector(row, out);
    }
}

void arithmetic(std::int32_t* data, int rounds) {
    pointer<std::int32_t> p(data);
    vint index = load_vector(p);
    vfloat x = to_float(index);
    vfloat y = x + 1.0F;
    vfloat z = x + 2.0F;
    for (sint i = 0; branch(i < rounds); ++i) {
        vfloat a = fma(x, y, z);
        vfloat b = fma(y, z, x);
        vfloat c = a * b;
        vmask m = c > a;
        x = select(m, a, b);
        y = min(b, c);
        z = c + x;
    }
    store_vector(p, to_int(z));
}

} // namespace sim::test
