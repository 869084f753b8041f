// What must hold of a point's numbers, as an expression: `core.lanes * chip.threads <= 64 and l2.ways >= 4`.
//
//     condition  = clause { "or" clause };  clause = negation { "and" negation };  negation = [ "not" ] test
//     test       = sum ("<" | "<=" | ">" | ">=" | "==" | "!=") sum | "(" condition ")"
//     sum        = product { ("+" | "-") product };  product = factor { ("*" | "/" | "%") factor }
//     factor     = [ "-" ] ( NUMBER [ "KiB" | "MiB" | "GiB" ] | KEY | "(" sum ")" )
//
// Numbers are doubles; `%` is what std::fmod leaves. At most 4,096 characters.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace analysis {

class Constraint {
public:
    /// What a key stands for. Throws StudyError where that is no number.
    using Lookup = std::function<double(std::string_view key)>;

    /// Throws StudyError: cause, place in the text, mend.
    explicit Constraint(std::string_view text);
    /// Throws what `lookup` does, and StudyError where something is divided by zero.
    bool holds(const Lookup& lookup) const;
    const std::vector<std::string>& keys() const { return keys_; }
    const std::string& text() const { return text_; }

private:
    std::string text_;
    std::vector<std::string> keys_; // each once
    std::shared_ptr<const std::function<double(const Lookup&)>> value_;
};

} // namespace analysis
