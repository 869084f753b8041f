#include "razor/scene/instance_table.h"

#include "razor/scene/error.h"
#include "razor/scene/graph/flatten.h"
#include "razor/scene/models/model_file.h"
#include "razor/scene/models/obj_cursor.h"
#include "razor/scene/ranges.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <unordered_map>

namespace razor {
namespace {

class TableReader {
public:
    TableReader(std::string_view text, std::string_view file_name, const std::filesystem::path& folder)
        : cursor_(text, file_name), file_name_(file_name), folder_(folder) {}

    InstanceTable read() {
        while (!cursor_.at_end()) {
            const std::string_view word = cursor_.word();
            if (!word.empty()) {
                read_row(word);
            }
            cursor_.next_statement();
        }
        if (table_.rows.empty()) {
            throw UserError(fmt::format("{}: no instances; write at least one line `file x z turn`",
                                        printable(file_name_, 1000)));
        }
        return std::move(table_);
    }

private:
    void read_row(std::string_view file) {
        InstanceRow row;
        row.line = cursor_.line();
        row.file = file_index(file);
        std::vector<double> numbers;
        while (!cursor_.at_statement_end()) {
            numbers.push_back(checked(cursor_.number("a number of the instance"), coordinate_range));
            if (numbers.size() > 12) {
                break;
            }
        }
        row.transform = transform_of(numbers);
        if (is_degenerate(to_affine(row.transform).linear)) {
            cursor_.fail_at(row.line, "the matrix flattens what it places; make its columns independent");
        }
        if (static_cast<std::int64_t>(table_.rows.size()) >= most_instances) {
            cursor_.fail_at(row.line, fmt::format("more than {} instances; split the table", most_instances));
        }
        table_.rows.push_back(std::move(row));
    }

    Transform transform_of(const std::vector<double>& n) const {
        Transform t;
        switch (n.size()) {
        case 3:
            t.translate = {n[0], 0, n[1]};
            t.rotate.y = -checked(n[2], angle_range);
            return t;
        case 5:
            t.scale = glm::dvec3(checked(n[4], scale_range));
            [[fallthrough]];
        case 4:
            t.translate = {n[0], n[1], n[2]};
            t.rotate.y = -checked(n[3], angle_range);
            return t;
        case 12: {
            Affine& matrix = t.matrix.emplace();
            for (int row = 0; row < 3; ++row) {
                for (int column = 0; column < 3; ++column) {
                    matrix.linear[column][row] = n[static_cast<std::size_t>(4 * row + column)];
                }
                matrix.translation[row] = n[static_cast<std::size_t>(4 * row + 3)];
            }
            return t;
        }
        default:
            cursor_.fail(
                fmt::format("{} numbers after the file name; write `x z turn`, `x y z turn`, `x y z turn "
                            "scale` or the 12 numbers of a matrix",
                            n.size() > 12 ? "more than 12" : std::to_string(n.size())));
        }
    }

    double checked(double value, Range range) const {
        if (!(value >= range.least && value <= range.most)) {
            cursor_.fail(fmt::format("{} is out of range; write a number from {} to {}", value, range.least,
                                     range.most));
        }
        return value;
    }

    int file_index(std::string_view file) {
        const auto known = as_written_.find(std::string(file));
        if (known != as_written_.end()) {
            return known->second;
        }
        const std::filesystem::path path = std::filesystem::absolute(folder_ / file).lexically_normal();
        if (model_file(path) != ModelFile::still) {
            cursor_.fail(fmt::format("'{}' is neither an OBJ nor a PLY file; begin the line with one",
                                     printable(file)));
        }
        const auto next = static_cast<int>(table_.files.size());
        const auto [entry, is_new] = resolved_.try_emplace(path.string(), next);
        if (is_new) {
            table_.files.push_back(path.string());
        }
        as_written_.emplace(file, entry->second);
        return entry->second;
    }

    ObjCursor cursor_;
    std::string file_name_;
    std::filesystem::path folder_;
    InstanceTable table_;
    std::unordered_map<std::string, int> as_written_, resolved_; // files by name and by path
};

} // namespace

InstanceTable read_instance_table(const std::filesystem::path& path) {
    return parse_instance_table(read_text_file(path, "a table of instances"), path.string(),
                                path.parent_path());
}

InstanceTable parse_instance_table(std::string_view text, std::string_view file_name,
                                   const std::filesystem::path& folder) {
    return TableReader(text, file_name, folder).read();
}

} // namespace razor
