#include "razor/scene/models/gltf/accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace razor::gltf {
namespace {

enum Component { int8 = 5120, uint8 = 5121, int16 = 5122, uint16 = 5123, uint32 = 5125, float32 = 5126 };

constexpr std::size_t max_count = std::numeric_limits<int>::max();

std::size_t bytes_of(int component) {
    switch (component) {
    case int8:
    case uint8:
        return 1;
    case int16:
    case uint16:
        return 2;
    case uint32:
    case float32:
        return 4;
    default:
        return 0;
    }
}

template <class Stored> double load(const unsigned char* bytes, bool normalized) {
    Stored value{};
    std::memcpy(&value, bytes, sizeof value);
    const auto number = static_cast<double>(value);
    if (!normalized || std::is_floating_point_v<Stored>)
        return number;
    return std::max(number / static_cast<double>(std::numeric_limits<Stored>::max()), -1.0);
}

double number_at(const unsigned char* bytes, int component, bool normalized) {
    switch (component) {
    case int8:
        return load<std::int8_t>(bytes, normalized);
    case uint8:
        return load<std::uint8_t>(bytes, normalized);
    case int16:
        return load<std::int16_t>(bytes, normalized);
    case uint16:
        return load<std::uint16_t>(bytes, normalized);
    case uint32:
        return load<std::uint32_t>(bytes, normalized);
    default:
        return load<float>(bytes, normalized);
    }
}

/// Elements in a buffer, all of them inside.
/// That a sparse accessor may begin with, which has no data that would say how many there are.
constexpr std::size_t most_zeros = std::size_t{1} << 24U;

struct Elements {
    const unsigned char* begin = nullptr;
    std::size_t stride = 0;
};

Elements find_elements(const Document& document, int view_number, std::size_t offset, std::size_t count,
                       std::size_t size, std::string_view what) {
    const BufferView& view = entry(document, document.views, view_number, "buffer view", what);
    const auto& buffer = entry(document, document.buffers, view.buffer, "buffer", what);
    const std::size_t stride = view.stride == 0 ? size : view.stride;
    const bool view_inside = view.offset <= buffer.size() && view.length <= buffer.size() - view.offset;
    // Neither factor reaches 2^32: no overflow.
    if (stride > max_count || !view_inside || offset > view.length || size > view.length - offset ||
        (count - 1) * stride > view.length - offset - size)
        document.fail(fmt::format("{} reach beyond the end of their buffer; export it anew", what));
    return {buffer.data() + view.offset + offset, stride};
}

const Accessor& checked(const Document& document, int number, int width, std::string_view what) {
    const Accessor& accessor = entry(document, document.accessors, number, "accessor", what);
    if (accessor.width != width)
        document.fail(
            fmt::format("{} have {} components, not {}; export it anew", what, accessor.width, width));
    if (accessor.count == 0 || accessor.count > max_count)
        document.fail(fmt::format("{} are {} in number; export it anew", what, accessor.count));
    if (bytes_of(accessor.component) == 0)
        document.fail(
            fmt::format("{} are stored as type {}; export them as floats", what, accessor.component));
    return accessor;
}

void read_sparse(const Document& document, const Accessor& accessor, std::string_view what,
                 std::vector<double>& numbers) {
    const SparsePart& part = *accessor.sparse;
    if (part.count == 0)
        return;
    const auto width = static_cast<std::size_t>(accessor.width);
    const std::size_t size = bytes_of(accessor.component), index_size = bytes_of(part.index_component);
    if (part.count < 0 || part.index_offset < 0 || part.value_offset < 0 || index_size == 0 ||
        (part.index_component != uint8 && part.index_component != uint16 && part.index_component != uint32))
        document.fail(fmt::format("{} have a sparse part that makes no sense; export it anew", what));
    const auto count = static_cast<std::size_t>(part.count);
    const Elements indices = find_elements(
        document, part.index_view, static_cast<std::size_t>(part.index_offset), count, index_size, what);
    const Elements values = find_elements(
        document, part.value_view, static_cast<std::size_t>(part.value_offset), count, size * width, what);
    for (std::size_t i = 0; i < count; ++i) {
        const double index = number_at(indices.begin + i * indices.stride, part.index_component, false);
        if (index >= static_cast<double>(accessor.count))
            document.fail(fmt::format("{} have a sparse part beyond their end; export it anew", what));
        for (std::size_t c = 0; c < width; ++c)
            numbers[static_cast<std::size_t>(index) * width + c] = number_at(
                values.begin + i * values.stride + c * size, accessor.component, accessor.normalized);
    }
}

} // namespace

std::size_t count_of(const Document& document, int number, std::string_view what) {
    const Accessor& accessor = entry(document, document.accessors, number, "accessor", what);
    return checked(document, number, accessor.width, what).count;
}

std::vector<double> read_numbers(const Document& document, int number, int width, std::size_t count,
                                 std::string_view what) {
    const Accessor& accessor = checked(document, number, width, what);
    if (count != 0 && accessor.count != count)
        document.fail(fmt::format("{} are {}, not {}; export it anew", what, accessor.count, count));
    const auto components = static_cast<std::size_t>(width);
    const std::size_t size = bytes_of(accessor.component);
    std::vector<double> numbers;
    if (accessor.view != none) {
        const Elements elements =
            find_elements(document, accessor.view, accessor.offset, accessor.count, size * components, what);
        numbers.reserve(accessor.count * components);
        for (std::size_t i = 0; i < accessor.count; ++i)
            for (std::size_t c = 0; c < components; ++c)
                numbers.push_back(number_at(elements.begin + i * elements.stride + c * size,
                                            accessor.component, accessor.normalized));
    } else if (count != 0 || (accessor.sparse && accessor.count <= most_zeros)) { // glTF 2.0, 3.6.2.3
        numbers.resize(accessor.count * components);
    } else {
        document.fail(fmt::format("{} have no data; export it anew, without compression", what));
    }
    if (accessor.sparse)
        read_sparse(document, accessor, what, numbers);
    if (!std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }))
        document.fail(fmt::format("{} are not all finite numbers; mend the model", what));
    return numbers;
}

std::vector<std::uint32_t> read_indices(const Document& document, int number, std::string_view what) {
    const Accessor& accessor = entry(document, document.accessors, number, "accessor", what);
    if (accessor.component != uint8 && accessor.component != uint16 && accessor.component != uint32)
        document.fail(fmt::format("{} are no unsigned integers; export it anew", what));
    if (accessor.normalized)
        document.fail(fmt::format("{} are normalized; export it anew", what));
    const std::vector<double> numbers = read_numbers(document, number, 1, 0, what);
    std::vector<std::uint32_t> indices(numbers.size());
    std::transform(numbers.begin(), numbers.end(), indices.begin(),
                   [](double x) { return static_cast<std::uint32_t>(x); });
    return indices;
}

} // namespace razor::gltf
