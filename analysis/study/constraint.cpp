#include "analysis/study/constraint.h"

#include "analysis/study/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace analysis {
namespace {

using Lookup = Constraint::Lookup;

using Value = std::function<double(const Lookup&)>;

/// A part of an expression: a number, or whether something holds (0 or 1). Those that hold it share it.
struct Part {
    bool truth = false;
    std::shared_ptr<const Value> value;
};

/// So that neither parsing nor evaluating takes more stack than there surely is.
constexpr std::size_t most_characters = 4096;

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

Part part(bool truth, Value value) {
    return {truth, std::make_shared<const Value>(std::move(value))};
}
template <class Apply> Part applied(bool truth, const Part& a, Apply apply) {
    return part(truth, [x = a.value, apply](const Lookup& lookup) {
        return static_cast<double>(apply((*x)(lookup)));
    });
}
template <class Apply> Part joined(bool truth, const Part& a, const Part& b, Apply apply) {
    return part(truth, [x = a.value, y = b.value, apply](const Lookup& lookup) {
        return static_cast<double>(apply((*x)(lookup), (*y)(lookup)));
    });
}

/// By recursive descent, a function a rule of the header's grammar.
class Parser {
public:
    Parser(std::string_view text, std::vector<std::string>& keys) : text_(text), keys_(keys) {}

    Part parse() {
        if (text_.size() > most_characters)
            throw StudyError(
                fmt::format("\"{}...\" has {} characters, and {} are read; write it in several conditions",
                            text_.substr(0, 40), text_.size(), most_characters));
        Part out = condition();
        skip();
        if (at_ < text_.size())
            fail("something more stands here; join conditions by `and` or `or`");
        if (!out.truth)
            fail("this is a number; compare it with another, such as `<= 64`", 0);
        return out;
    }

private:
    [[noreturn]] void fail(std::string_view what, std::size_t at = std::string_view::npos) const {
        throw StudyError(fmt::format("\"{}\", character {}: {}", text_,
                                     (at == std::string_view::npos ? at_ : at) + 1, what));
    }
    void skip() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t'))
            ++at_;
    }
    bool take(std::string_view symbol) {
        skip();
        const bool word = is_letter(symbol.front());
        const std::size_t end = at_ + symbol.size();
        if (text_.substr(at_, symbol.size()) != symbol ||
            (word && end < text_.size() &&
             (is_letter(text_[end]) || is_digit(text_[end]) || text_[end] == '.')))
            return false;
        at_ = end;
        return true;
    }
    /// Expressions nest as deep as a stack surely bears.
    struct Nested {
        explicit Nested(Parser& parser) : parser(parser) {
            if (++parser.depth_ > 100)
                parser.fail("parentheses nest too deeply; write it in several conditions");
        }
        ~Nested() { --parser.depth_; }
        Nested(const Nested&) = delete;
        Nested& operator=(const Nested&) = delete;
        Parser& parser;
    };

    Part condition() {
        const Nested nested(*this);
        Part left = clause();
        for (std::size_t at = at_; take("or"); at = at_) {
            const Part right = clause();
            need(left, right, true, at);
            left = joined(true, left, right, [](double a, double b) { return a != 0 || b != 0; });
        }
        return left;
    }
    Part clause() {
        Part left = negation();
        for (std::size_t at = at_; take("and"); at = at_) {
            const Part right = negation();
            need(left, right, true, at);
            left = joined(true, left, right, [](double a, double b) { return a != 0 && b != 0; });
        }
        return left;
    }
    Part negation() {
        if (!take("not"))
            return test();
        const Nested nested(*this);
        const std::size_t at = at_;
        const Part inner = negation();
        need(inner, inner, true, at);
        return applied(true, inner, [](double a) { return a == 0; });
    }
    Part test() {
        const Part left = sum();
        using Compare = bool (*)(double, double);
        // The longer ones first.
        static constexpr std::array<std::pair<std::string_view, Compare>, 6> all = {
            {{"<=", [](double a, double b) { return a <= b; }},
             {">=", [](double a, double b) { return a >= b; }},
             {"==", [](double a, double b) { return a == b; }},
             {"!=", [](double a, double b) { return a != b; }},
             {"<", [](double a, double b) { return a < b; }},
             {">", [](double a, double b) { return a > b; }}}};
        for (const auto& [symbol, compare] : all) {
            const std::size_t at = at_;
            if (!take(symbol))
                continue;
            const Part right = sum();
            need(left, right, false, at);
            skip();
            if (at_ < text_.size() && std::string_view("<>=!").find(text_[at_]) != std::string_view::npos)
                fail("a second comparison; write `a <= b and b <= c`");
            return joined(true, left, right, compare);
        }
        if (take("="))
            fail("`=` alone; compare by `==`", at_ - 1);
        return left;
    }
    Part sum() {
        Part left = product();
        for (;;) {
            const std::size_t at = at_;
            const bool plus = take("+");
            if (!plus && !take("-"))
                return left;
            const Part right = product();
            need(left, right, false, at);
            left = plus ? joined(false, left, right, std::plus<double>())
                        : joined(false, left, right, std::minus<double>());
        }
    }
    Part product() {
        Part left = factor();
        for (;;) {
            const std::size_t at = at_;
            const bool times = take("*"), over = !times && take("/");
            if (!times && !over && !take("%"))
                return left;
            const Part right = factor();
            need(left, right, false, at);
            if (times)
                left = joined(false, left, right, std::multiplies<double>());
            else
                left = joined(false, left, right, [over, text = std::string(text_)](double a, double b) {
                    if (b == 0)
                        throw StudyError(fmt::format("\"{}\" divides by zero; multiply both sides", text));
                    return over ? a / b : std::fmod(a, b);
                });
        }
    }
    Part factor() {
        const Nested nested(*this);
        if (take("-")) {
            const std::size_t at = at_;
            const Part inner = factor();
            need(inner, inner, false, at);
            return applied(false, inner, [](double a) { return -a; });
        }
        if (take("(")) {
            Part inner = condition();
            if (!take(")"))
                fail("a parenthesis is open; close it by `)`");
            return inner;
        }
        skip();
        if (at_ < text_.size() && is_letter(text_[at_]))
            return key();
        return number();
    }
    Part key() {
        const std::size_t begin = at_;
        while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]) || text_[at_] == '.'))
            ++at_;
        std::string name(text_.substr(begin, at_ - begin));
        if (std::find(keys_.begin(), keys_.end(), name) == keys_.end())
            keys_.push_back(name);
        return part(false, [name = std::move(name)](const Lookup& lookup) { return lookup(name); });
    }
    Part number() {
        double value = 0;
        const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
        if (error != std::errc() || !std::isfinite(value))
            fail("a number or a setting is missing; write one, such as core.lanes");
        at_ = static_cast<std::size_t>(end - text_.data());
        for (const auto& [unit, bytes] :
             {std::pair{"KiB", 0x1p10}, std::pair{"MiB", 0x1p20}, std::pair{"GiB", 0x1p30}})
            if (take(unit)) {
                value *= bytes;
                break;
            }
        return part(false, [value](const Lookup&) { return value; });
    }

    /// Both sides must be of this kind.
    void need(const Part& a, const Part& b, bool truth, std::size_t at) const {
        if (a.truth != truth || b.truth != truth)
            fail(truth ? "this joins conditions, and a side is a number; compare it with another"
                       : "this takes numbers, and a side is a condition; take it out of the parentheses",
                 at);
    }

    std::string_view text_;
    std::vector<std::string>& keys_;
    std::size_t at_ = 0;
    int depth_ = 0;
};

} // namespace

Constraint::Constraint(std::string_view text) : text_(text) {
    value_ = Parser(text_, keys_).parse().value;
}

bool Constraint::holds(const Lookup& lookup) const {
    return (*value_)(lookup) != 0;
}

} // namespace analysis
