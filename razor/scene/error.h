// A mistake in what the user gave us: one clear line, exit code 2.
#pragma once

#include <stdexcept>
#include <string>

namespace razor {

/// what() is one line: file (and line or key), cause, mend. Programs print "razor: <what>" and exit with 2.
class UserError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

} // namespace razor
