// What a renderer calls and looks at while it makes one picture.
#pragma once

#include "razor/native/pass_figures.h"

#include <atomic>
#include <exception>
#include <functional>

namespace razor {

struct RenderCalls {
    /// Now and then, with the fraction that is done, from the thread that asked for the picture.
    std::function<void(double fraction)> progress{};
    /// Set to true from anywhere, a signal handler too, to stop early: Cancelled is thrown, and the next
    /// picture may be asked for.
    const std::atomic<bool>* cancel = nullptr;
    Passed passed{}; // of what is rendered in passes
};

class Cancelled : public std::exception {
public:
    const char* what() const noexcept override { return "rendering was cancelled"; }
};

} // namespace razor
