// Kernels of the tests, compiled for the target `simulated`.
#pragma once

#include "isa/memory_types.h"
#include "isa/services.h"

#include <cstdint>

namespace sim::test {

using word = isa::shared<std::int32_t>;

/// Works for about `cycles`, then takes a number.
std::int32_t take_ticket(word* counter, int cycles);
void count_up(word* counter, int times);
/// Writes 1 after about `cycles`.
void release_after(word* w, int cycles);
/// Waits until the word is not 0.
std::int32_t await(word* w);
void publish_numbers(std::int32_t* data, word* ready, int count);
std::int32_t sum_when_published(std::int32_t* data, word* ready, int count);
/// Traps with a guard on its stack that writes 7 to the word.
void trap_while_holding(word* w, int code);
/// Waits until the word `awaited` is not 0, with such a guard of `held`.
void await_while_holding(word* held, word* awaited);
void ask_for_page(isa::page_service& service, int times, int index);
/// A little of everything: vectors, gathers, branches, a shared counter.
void mixed_work(std::int32_t* data, word* counter, int worker, int rounds);
/// Vector arithmetic alone, for speed.
void arithmetic(std::int32_t* data, int rounds);

} // namespace sim::test
