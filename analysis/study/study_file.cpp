#include "analysis/study/study_file.h"

#include "analysis/study/constraint.h"
#include "analysis/study/error.h"
#include "analysis/study/toml_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

namespace analysis {
namespace {

constexpr std::size_t largest_file = std::size_t{1} << 22; // bytes
constexpr const char* give_one = "give a study file, such as those of configs/studies";

/// Values for each of some settings, each combination of which is meant.
using Lists = std::vector<std::pair<std::string, std::vector<Value>>>;

/// All of which a point must have.
struct Condition {
    std::string key;
    std::vector<Value> values; // one of these; or, where there are none,
    std::optional<double> least, most;

    bool holds(const Settings& settings) const;
};

bool Condition::holds(const Settings& settings) const {
    const auto found = settings.find(key);
    if (found == settings.end())
        return false;
    if (!values.empty())
        return std::find(values.begin(), values.end(), found->second) != values.end();
    const std::optional<double> number = number_of(found->second);
    return number && (!least || *number >= *least) && (!most || *number <= *most);
}

/// Tables of [[exclude]] by where they stand, and whether they leave out a point in either size.
using Excludes = std::map<std::pair<std::uint32_t, std::uint32_t>, bool>;

class Reader {
public:
    Reader(std::string_view file, const Vocabulary& vocabulary, Excludes& excludes)
        : file_(file), vocabulary_(vocabulary), excludes_(excludes) {}

    Study read(const toml::table& root) {
        TomlSection top(root, "", file_);
        study_.file = file_;
        if (top.needed_text("kind") != vocabulary_.kind)
            top.fail(
                "kind",
                fmt::format(
                    "this program measures studies of kind \"{}\"; use the program that "
                    "measures others (razor study: image, razor-sim study: machine, razor-sim sweep: sweep)",
                    vocabulary_.kind));
        study_.title = top.text("title").value_or(std::filesystem::path(file_).stem().string());
        study_.seeds = top.whole("seeds", 1, 1, 1000);
        study_.repeats = top.whole("repeats", 1, 0, 1000);
        if (const toml::table* const settings = top.table("settings"))
            study_.common = single_settings(*settings, "settings");
        if (const toml::table* const reference = top.table("reference"))
            read_reference(*reference);
        const toml::table* const knobs = top.table("knobs");
        const std::vector<const toml::table*> points = top.tables("points");
        const std::vector<const toml::table*> exclude = top.tables("exclude");
        const std::vector<std::string> where = top.texts("where");
        has_reference_ = root.contains("reference");
        const std::vector<const toml::table*> plots = top.tables("plot");
        for (const toml::table* const plot : plots)
            read_plot(*plot);
        const std::vector<const toml::table*> curves = top.tables("curve");
        for (const toml::table* const curve : curves)
            read_curve(*curve);
        read_rank(top);
        const std::vector<const toml::table*> rivals = top.tables("rival");
        top.table("full");
        top.finish();
        for (const toml::table* const one : exclude) {
            bool& used = excludes_[{one->source().begin.line, one->source().begin.column}];
            exclude_.push_back({conditions(*one), &used});
        }
        read_constraints(where, top);
        if (knobs != nullptr)
            add_points(*knobs, "knobs");
        for (const toml::table* const one : points)
            add_points(*one, "points");
        if (study_.points.empty() && given_ != 0 && !where_.empty())
            top.fail("where", "all points are left out; mend where or [[exclude]]");
        if (study_.points.empty())
            fail_at(file_, given_ == 0 ? root.source() : exclude.front()->source(),
                    given_ == 0 ? "there are no points; list values of some settings under [knobs]"
                                : "all points are left out; mend [[exclude]]");
        for (const toml::table* const rival : rivals)
            read_rival(*rival);
        for (std::size_t i = 0; i < study_.plots.size(); ++i)
            check_lines(study_.plots[i], *plots[i]);
        for (std::size_t i = 0; i < study_.curves.size(); ++i)
            check_curve(study_.curves[i], *curves[i]);
        return std::move(study_);
    }

private:
    void read_rank(TomlSection& top) {
        study_.rank = top.texts("rank");
        if (study_.rank.empty() && top.all().contains("rank"))
            top.fail("rank", "rank names no figures; name some, or leave it out");
        std::set<std::string> known;
        for (const std::string& figure : study_.rank) {
            if (const std::string wrong = wrong_figure(figure); !wrong.empty())
                top.fail("rank", wrong);
            if (!known.insert(figure).second)
                top.fail("rank", fmt::format("rank names {} twice; leave one out", figure));
        }
    }

    void check_lines(const PlotRequest& plot, const toml::table& table) const {
        for (const std::string& line : plot.lines)
            if (std::find(study_.knobs.begin(), study_.knobs.end(), line) == study_.knobs.end())
                TomlSection(table, "plot", file_)
                    .fail("lines", fmt::format("a plot has lines by {}, in which no points differ; there are "
                                               "{}",
                                               line, fmt::join(study_.knobs, ", ")));
    }

    /// Why a plot cannot show it, or nothing.
    std::string wrong_figure(const std::string& name) const {
        const std::vector<std::string>&known = vocabulary_.figures, &beside = vocabulary_.of_references;
        if (!has_reference_ && std::find(beside.begin(), beside.end(), name) != beside.end())
            return fmt::format("{} is measured beside a reference, and there is none; write [reference]",
                               name);
        return std::find(known.begin(), known.end(), name) != known.end()
                   ? ""
                   : fmt::format("there is no figure {}; there are {}", name, fmt::join(known, ", "));
    }

    void read_curve(const toml::table& table) {
        TomlSection section(table, "curve", file_);
        CurveRequest curve{section.needed_text("x"), section.needed_text("y")};
        section.finish();
        if (const std::string wrong = wrong_figure(curve.y); !wrong.empty())
            section.fail("y", wrong);
        study_.curves.push_back(std::move(curve));
    }

    void check_curve(const CurveRequest& curve, const toml::table& table) const {
        const TomlSection section(table, "curve", file_);
        if (std::find(study_.knobs.begin(), study_.knobs.end(), curve.x) == study_.knobs.end())
            section.fail("x", fmt::format("in {} no points differ; they do in {}", curve.x,
                                          fmt::join(study_.knobs, ", ")));
        for (const Settings& point : study_.points)
            if (const auto found = point.find(curve.x);
                found != point.end() && !number_of(found->second).has_value())
                section.fail("x",
                             fmt::format("{} = {} is no number; draw curves over numbers, or leave it to "
                                         "the bars of sensitivity",
                                         curve.x, toml_text(found->second)));
    }

    std::string wrong_file(const std::string& key, const Value& value) const {
        const std::filesystem::path file = std::filesystem::path(file_).parent_path() / plain_text(value);
        std::error_code ignored;
        return std::filesystem::exists(file, ignored)
                   ? ""
                   : fmt::format(
                         "{} = {}: there is no file {}; mend its name, which is from the study's folder", key,
                         toml_text(value), file.string());
    }

    Value checked(const std::string& key, const toml::node& node) const {
        Value value;
        if (node.is_boolean())
            value = node.as_boolean()->get();
        else if (node.is_integer())
            value = node.as_integer()->get();
        else if (node.is_floating_point())
            value = node.as_floating_point()->get();
        else if (node.is_string())
            value = node.as_string()->get();
        else
            fail_at(file_, node.source(),
                    fmt::format("{} is no single value; write a number, true or false, or a text in quotes",
                                key));
        std::string wrong = vocabulary_.wrong(key, value);
        if (wrong.empty() &&
            std::find(vocabulary_.files.begin(), vocabulary_.files.end(), key) != vocabulary_.files.end())
            wrong = wrong_file(key, value);
        if (!wrong.empty())
            fail_at(file_, node.source(), wrong);
        return value;
    }

    /// visit(key, node) of all values, those of inner tables by "table.key".
    template <class Visit> void each(const toml::table& table, const std::string& before, Visit visit) const {
        for (const auto& [key, node] : table) {
            const std::string name =
                before.empty() ? std::string(key.str()) : fmt::format("{}.{}", before, key.str());
            if (const toml::table* const inner = node.as_table(); inner != nullptr && !inner->is_inline())
                each(*inner, name, visit);
            else
                visit(name, node);
        }
    }

    /// ... and where it stands.
    Value placed(const std::string& key, const toml::node& node) {
        Value value = checked(key, node);
        const toml::source_position at = node.source().begin;
        study_.places.insert_or_assign({key, value}, FilePlace{at.line, at.column});
        return value;
    }

    Settings single_settings(const toml::table& table, std::string_view section) {
        Settings out;
        each(table, "", [&](const std::string& key, const toml::node& node) {
            if (node.is_array())
                fail_at(file_, node.source(),
                        fmt::format("{}.{} is a list; write one value, or move it to [knobs]", section, key));
            out.emplace(key, placed(key, node));
        });
        return out;
    }

    void read_reference(const toml::table& table) {
        TomlSection section(table, "reference", file_);
        study_.reference_seeds = section.whole("seeds", 2, 1, 1000);
        each(table, "", [&](const std::string& key, const toml::node& node) {
            if (key != "seeds")
                study_.reference.emplace(key, placed(key, node));
        });
    }

    Lists lists(const toml::table& table) {
        Lists out;
        each(table, "", [&](const std::string& key, const toml::node& node) {
            std::vector<Value> values;
            if (const toml::array* const array = node.as_array())
                for (const toml::node& one : *array)
                    values.push_back(placed(key, one));
            else
                values.push_back(placed(key, node));
            if (values.empty())
                fail_at(file_, node.source(), fmt::format("{} has no values; list some", key));
            out.emplace_back(key, std::move(values));
        });
        // As the file has them, which TOML's tables forget.
        std::stable_sort(out.begin(), out.end(), [&](const auto& a, const auto& b) {
            return place_of(table, a.first) < place_of(table, b.first);
        });
        return out;
    }

    static std::pair<std::uint32_t, std::uint32_t> place_of(const toml::table& table, std::string_view name) {
        std::pair<std::uint32_t, std::uint32_t> place{~0U, ~0U};
        for (const auto& [key, node] : table)
            if (name == key.str() || (name.starts_with(key.str()) && name[key.str().size()] == '.'))
                place = {node.source().begin.line, node.source().begin.column};
        return place;
    }

    std::vector<Condition> conditions(const toml::table& table) const {
        std::vector<Condition> out;
        each(table, "", [&](const std::string& key, const toml::node& node) {
            Condition& condition = out.emplace_back();
            condition.key = key;
            if (const toml::table* const range = node.as_table()) {
                const auto bound = [&](std::string_view name) -> std::optional<double> {
                    const toml::node* const value = range->get(name);
                    if (value != nullptr && !value->is_number())
                        fail_at(file_, value->source(),
                                fmt::format("{}.{} is no number; write one", key, name));
                    return value == nullptr ? std::nullopt : value->value<double>();
                };
                condition.least = bound("least");
                condition.most = bound("most");
                if (range->size() != static_cast<std::size_t>(condition.least.has_value()) +
                                         static_cast<std::size_t>(condition.most.has_value()) ||
                    range->empty())
                    fail_at(file_, range->source(),
                            fmt::format("{} has other bounds than these; write {{ least = A, most = B }}, or "
                                        "one of them",
                                        key));
                return;
            }
            if (const toml::array* const array = node.as_array())
                for (const toml::node& one : *array)
                    condition.values.push_back(checked(key, one));
            else
                condition.values.push_back(checked(key, node));
        });
        return out;
    }

    void read_constraints(const std::vector<std::string>& texts, const TomlSection& top) {
        top_ = &top;
        for (const std::string& text : texts)
            try {
                where_.emplace_back(text);
            } catch (const StudyError& error) {
                top.fail("where", error.what());
            }
    }

    double number_at(const Settings& point, std::string_view key) const {
        const auto found = point.find(std::string(key));
        if (found != point.end())
            if (const std::optional<double> number = number_of(found->second))
                return *number;
        if (found != point.end())
            throw StudyError(fmt::format("{} = {} is no number; leave such points out by [[exclude]]", key,
                                         toml_text(found->second)));
        if (!vocabulary_.preset)
            throw StudyError(
                fmt::format("the study does not say {}; write it into [settings] or [knobs]", key));
        return vocabulary_.preset(point, key, file_);
    }

    bool excluded(const Settings& point) const {
        bool left_out = false;
        for (const auto& [all, used] : exclude_)
            if (!all.empty() &&
                std::all_of(all.begin(), all.end(), [&](const Condition& one) { return one.holds(point); }))
                *used = left_out = true;
        for (const Constraint& one : where_)
            try {
                if (!one.holds([&](std::string_view key) { return number_at(point, key); }))
                    return true;
            } catch (const std::exception& error) {
                top_->fail("where", error.what());
            }
        return left_out;
    }

    /// visit(settings) of each combination, the last list's values in turn first.
    template <class Visit>
    void combine(const Lists& lists, std::size_t from, Settings& settings, Visit visit) const {
        if (from == lists.size())
            return visit(settings);
        for (const Value& value : lists[from].second) {
            settings.insert_or_assign(lists[from].first, value);
            combine(lists, from + 1, settings, visit);
        }
    }

    /// What combinations of a table's lists there are. Throws StudyError where there are too many.
    std::vector<Settings> combinations(const toml::table& table, const Lists& lists) const {
        double count = 1;
        for (const auto& [key, values] : lists)
            count *= static_cast<double>(values.size());
        if (count + static_cast<double>(given_) > static_cast<double>(most_points))
            fail_at(file_, table.source(),
                    fmt::format("there are more than {} points; list fewer values", most_points));
        std::vector<Settings> out;
        Settings settings;
        combine(lists, 0, settings, [&](const Settings& one) { out.push_back(one); });
        return out;
    }

    void add_points(const toml::table& table, std::string_view section) {
        const Lists values = lists(table);
        if (values.empty())
            fail_at(file_, table.source(),
                    fmt::format("[{}] is empty; list values of some settings", section));
        for (const auto& [key, unused] : values)
            if (std::find(study_.knobs.begin(), study_.knobs.end(), key) == study_.knobs.end())
                study_.knobs.push_back(key);
        for (const Settings& one : combinations(table, values)) {
            ++given_;
            Settings point = overlaid(study_.common, one);
            if (!excluded(point) && known_.insert(toml_text(point)).second)
                study_.points.push_back(std::move(point));
        }
    }

    void read_plot(const toml::table& table) {
        TomlSection section(table, "plot", file_);
        PlotRequest plot{section.needed_text("x"), section.needed_text("y"), section.texts("lines")};
        section.finish();
        for (const auto& [key, name] : {std::pair{"x", &plot.x}, std::pair{"y", &plot.y}})
            if (const std::string wrong = wrong_figure(*name); !wrong.empty())
                section.fail(key, wrong);
        study_.plots.push_back(std::move(plot));
    }

    void read_rival(const toml::table& table) {
        TomlSection section(table, "rival", file_);
        Rival rival;
        rival.name = section.needed_text("name");
        rival.command = section.texts("command");
        if (rival.command.empty())
            section.fail("command", "there is no rival.command; write command = [\"program\", \"{scene}\"]");
        if (const toml::table* const figures = section.table("figures"))
            for (const auto& [key, node] : *figures) {
                const bool known = std::find(vocabulary_.figures.begin(), vocabulary_.figures.end(),
                                             std::string(key.str())) != vocabulary_.figures.end();
                if (!known || !node.is_string() || !node.as_string()->get().starts_with('/'))
                    fail_at(
                        file_, node.source(),
                        fmt::format("rival.figures.{} is no JSON pointer of a figure; write for example {} "
                                    "= \"/runs/*/seconds\"",
                                    key.str(), vocabulary_.figures.front()));
                rival.figures.emplace_back(key.str(), node.as_string()->get());
            }
        Lists values;
        // A rival's own words, which no program checks.
        if (const toml::table* const knobs = section.table("knobs"))
            values =
                Reader(file_, {vocabulary_.kind, [](std::string_view, Value&) { return ""; }, {}}, excludes_)
                    .lists(*knobs);
        section.finish();
        rival.points = combinations(table, values);
        const auto same_name = [&](const Rival& other) { return other.name == rival.name; };
        if (std::any_of(study_.rivals.begin(), study_.rivals.end(), same_name))
            section.fail("name",
                         fmt::format("there are two rivals {}; give each a name of its own", rival.name));
        study_.rivals.push_back(std::move(rival));
    }

    std::string file_;
    const Vocabulary& vocabulary_;
    Study study_;
    Excludes& excludes_;
    std::vector<std::pair<std::vector<Condition>, bool*>> exclude_; // and whether it leaves out any
    bool has_reference_ = false;
    std::vector<Constraint> where_;
    const TomlSection* top_ = nullptr; // the document, while it is read
    std::set<std::string> known_;      // points' texts
    std::size_t given_ = 0;
};

Study read_size(std::string_view text, std::string_view name, const Vocabulary& vocabulary, bool full,
                Excludes& excludes) {
    toml::table root = parse_toml(text, name);
    if (toml::table* const over = root.get_as<toml::table>("full"); over != nullptr && full) {
        toml::table taken = std::move(*over);
        root.erase("full");
        lay_over(root, taken);
    }
    return Reader(name, vocabulary, excludes).read(root);
}

} // namespace

std::string Study::place_of(const std::string& key, const Value& value) const {
    const auto found = places.find({key, value});
    return found == places.end() ? file
                                 : fmt::format("{}:{}:{}", file, found->second.line, found->second.column);
}

std::string Study::placed(const std::string& wrong, const Settings& settings) const {
    const auto in_a_word = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
    };
    std::size_t first = std::string::npos;
    std::string place;
    for (const auto& [key, value] : settings)
        for (std::size_t at = wrong.find(key); at < first; at = wrong.find(key, at + 1)) {
            const std::size_t end = at + key.size();
            if ((at > 0 && in_a_word(wrong[at - 1])) || (end < wrong.size() && in_a_word(wrong[end])))
                continue;
            first = at;
            place = place_of(key, value) + ": ";
        }
    return wrong.starts_with(file + ":") ? wrong : place + wrong;
}

Study parse_study(std::string_view text, std::string_view name, const Vocabulary& vocabulary, bool full) {
    if (full && !parse_toml(text, name).contains("full"))
        throw StudyError(fmt::format(
            "{}: has no [full], the size that --full asks for; leave --full out, or write one", name));
    Excludes excludes;
    // Its mistakes are said at once, not when its size is asked for.
    read_size(text, name, vocabulary, !full, excludes);
    Study study = read_size(text, name, vocabulary, full, excludes);
    for (const auto& [place, used] : excludes)
        if (!used)
            throw StudyError(fmt::format("{}:{}:{}: leaves out no point; mend what it says, or remove it",
                                         name, place.first, place.second));
    return study;
}

Study read_study(const std::string& file, const Vocabulary& vocabulary, bool full) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored))
        throw StudyError(fmt::format("{}: is a folder; {}", file, give_one));
    std::ifstream in(file, std::ios::binary);
    std::string text(largest_file + 1, '\0');
    if (!in || (!in.read(text.data(), static_cast<std::streamsize>(text.size())) && !in.eof()))
        throw StudyError(fmt::format("{}: cannot be read; {}", file, give_one));
    text.resize(static_cast<std::size_t>(in.gcount()));
    if (text.size() > largest_file)
        throw StudyError(
            fmt::format("{}: is larger than {} bytes, as no study is; {}", file, largest_file, give_one));
    return parse_study(text, file, vocabulary, full);
}

} // namespace analysis
