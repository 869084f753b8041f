// A table: the first row names the columns (time, stream, kind, address, size, site, structure, phase, work,
// part, detail), of which a file to be read needs address alone, in any order. Addresses are hexadecimal, the
// rest decimal, or names: of sites, structures, phases and work.
#include "traces/formats/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>

namespace traces {
namespace {

/// After the times.
constexpr std::array<std::string_view, 10> columns = {"stream",    "kind",  "address", "size", "site",
                                                      "structure", "phase", "work",    "part", "detail"};
constexpr std::array<std::string_view, parts> part_names = {"operation", "access", "piece", "aside"};
constexpr std::string_view byte_order_mark = "\xef\xbb\xbf"; // of UTF-8, which some programs begin files with
constexpr std::array<std::string_view, 5> units = {"cycles", "clocks", "instructions", "seconds", "order"};
enum Column : std::size_t {
    stream,
    kind,
    address,
    size,
    site,
    structure,
    phase,
    work,
    part,
    detail,
    time,
    unread
};

/// A line's end in a name, which no name of ours has, becomes a space.
std::string quoted(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    if (text.find_first_of(",\"") == std::string::npos)
        return text;
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"')
            out += '"';
        out += c;
    }
    return out + '"';
}

class CsvInput final : public TextInput {
public:
    explicit CsvInput(std::unique_ptr<Source> source) : TextInput(std::move(source)) {}
    std::string note() const override {
        return unread_.empty() ? "" : fmt::format("{}: columns that are not read: {}", name(), unread_);
    }

private:
    void parse(std::string_view line) override {
        if (order_.empty() && line.starts_with(byte_order_mark))
            line.remove_prefix(byte_order_mark.size());
        if (line.empty())
            return;
        split(line);
        if (order_.empty()) {
            learn_columns();
            return;
        }
        if (fields_.size() != order_.size())
            refuse(fmt::format("has {} fields instead of {}", fields_.size(), order_.size()),
                   "give each column one");
        Reference r;
        r.time = count();
        for (std::size_t i = 0; i < order_.size(); ++i)
            read(r, order_[i], fields_[i]);
        add(r);
    }
    void split(std::string_view line) {
        fields_.clear();
        for (bool more = true; more;) {
            std::string field;
            if (line.starts_with('"')) {
                std::size_t i = 1;
                for (; i < line.size(); ++i) {
                    if (line[i] == '"' && (i + 1 == line.size() || line[i + 1] != '"'))
                        break;
                    i += line[i] == '"' ? 1 : 0;
                    field += line[i];
                }
                if (i >= line.size())
                    refuse("has a quotation without an end", "end it by a \"");
                line.remove_prefix(i + 1);
                if (!line.empty() && line.front() != ',')
                    refuse("goes on behind a quotation", "put a comma there, or write \" as \"\"");
            } else {
                const std::size_t end = std::min(line.find(','), line.size());
                field = line.substr(0, end);
                line.remove_prefix(end);
            }
            fields_.push_back(std::move(field));
            more = line.starts_with(',');
            line.remove_prefix(more ? 1 : line.size());
        }
    }
    void learn_columns() {
        for (const std::string& name : fields_) {
            const auto* const found = std::find(columns.begin(), columns.end(), name);
            auto n = std::min(static_cast<std::size_t>(found - columns.begin()), std::size_t{time});
            if (std::find(units.begin(), units.end(), name) != units.end())
                description_.time = name;
            else if (n == time)
                n = unread;
            if (n != unread && std::find(order_.begin(), order_.end(), n) != order_.end())
                refuse(fmt::format("names the column {} twice", n == time ? "of times" : name),
                       "name it once");
            if (n == unread)
                unread_ += (unread_.empty() ? "" : ", ") + name;
            order_.push_back(n);
        }
        if (std::find(order_.begin(), order_.end(), address) == order_.end())
            refuse("names no column address", "begin the file with the names of its columns");
    }
    void read(Reference& r, std::size_t column, const std::string& field) {
        switch (column) {
        case time:
            r.time = number(field, 10, "time");
            break;
        case stream:
            r.stream = static_cast<std::uint32_t>(number(field, 10, "stream", 0xFFFFFFFF));
            break;
        case address:
            r.address = number(field, 16, "address");
            break;
        case size:
            r.what.size = static_cast<std::uint32_t>(number(field, 10, "size", 0xFFFFFFFF));
            break;
        case site:
            r.what.site = site_number(field);
            break;
        case structure:
            r.what.structure = structures_.number(field, *this);
            break;
        case phase:
            r.what.phase = phases_.number(field, *this);
            break;
        case work:
            r.what.work = works_.number(field, *this);
            break;
        case kind: {
            const auto* const found = std::find(kind_names.begin(), kind_names.end(), field);
            if (found == kind_names.end())
                refuse("has a kind that there is not",
                       fmt::format("kinds are {}", fmt::join(kind_names, ", ")));
            r.what.kind = static_cast<Kind>(found - kind_names.begin());
            break;
        }
        case part: {
            const auto* const found = std::find(part_names.begin(), part_names.end(), field);
            if (found == part_names.end())
                refuse("has a part that there is not",
                       fmt::format("parts are {}", fmt::join(part_names, ", ")));
            r.what.part = static_cast<Part>(found - part_names.begin());
            break;
        }
        case detail:
            r.what.detail = static_cast<std::uint32_t>(number(field, 10, "detail", 0xFFFFFFFF));
            break;
        default:
            break;
        }
    }
    std::uint64_t site_number(const std::string& name) {
        if (name.empty())
            return 0;
        const auto [found, fresh] = sites_.try_emplace(name, description_.sites.size() + 1);
        if (fresh)
            description_.sites.push_back(name);
        return found->second;
    }

    /// Names of a table of the description, to their numbers.
    class Names {
    public:
        explicit Names(std::vector<std::string>& table) : table_(table) {}
        std::uint16_t number(const std::string& name, const CsvInput& input) {
            if (numbers_.empty())
                table_.clear(); // of what is there without names
            const auto [found, fresh] = numbers_.try_emplace(name, table_.size());
            if (fresh) {
                if (table_.size() > 0xFFFF)
                    input.refuse("has the 65537th name of its column", "give fewer names");
                table_.push_back(name);
            }
            return static_cast<std::uint16_t>(found->second);
        }

    private:
        std::vector<std::string>& table_;
        std::map<std::string, std::size_t> numbers_;
    };

    Names structures_{description_.structures}, phases_{description_.phases}, works_{description_.work};
    std::vector<std::size_t> order_; // numbers in `columns`
    std::vector<std::string> fields_;
    std::string unread_;
    std::map<std::string, std::uint64_t> sites_;
};

class CsvOutput final : public BufferedOutput {
public:
    explicit CsvOutput(std::unique_ptr<Sink> sink) : BufferedOutput(std::move(sink)) {}
    void describe(const Description& d) override {
        if (!begun_)
            room() += fmt::format("{},{}\n", d.time, fmt::join(columns, ","));
        begun_ = true;
        addresses_ = d.site_addresses;
        for (const auto& [from, to] : {std::pair{&d.structures, &structures_},
                                       {&d.phases, &phases_},
                                       {&d.work, &work_},
                                       {&d.sites, &sites_}})
            for (std::size_t i = to->size(); i < from->size(); ++i)
                to->push_back(quoted((*from)[i]));
    }
    void write(const Reference& r) override {
        const Class& c = r.what;
        auto to = std::back_inserter(room());
        fmt::format_to(to, "{},{},{},0x{:x},{},", r.time, r.stream,
                       kind_names[static_cast<std::size_t>(c.kind)], r.address, c.size);
        if (c.site != 0 && addresses_)
            fmt::format_to(to, "0x{:x}", c.site);
        else if (c.site != 0)
            room() += sites_[c.site - 1];
        fmt::format_to(to, ",{},{},{},{},{}\n", structures_[c.structure], phases_[c.phase], work_[c.work],
                       part_names[static_cast<std::size_t>(c.part)], c.detail);
    }

private:
    bool begun_ = false, addresses_ = false;
    std::vector<std::string> structures_, phases_, work_, sites_; // quoted
};

} // namespace

std::unique_ptr<Input> read_csv(std::unique_ptr<Source> source) {
    return std::make_unique<CsvInput>(std::move(source));
}
std::unique_ptr<Output> write_csv(std::unique_ptr<Sink> sink) {
    return std::make_unique<CsvOutput>(std::move(sink));
}

} // namespace traces
