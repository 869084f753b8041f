// What a glTF file's JSON says apart from shapes and motion: members of its objects, of the types they must
// be.
#pragma once

#include "razor/scene/models/gltf/document.h"
#include "razor/scene/ranges.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace razor::gltf {

using Json = nlohmann::json;

/// One object of the file, and what it is called in messages. Members that are not there have presets;
/// numbers beyond their range count as the nearest in it.
class Fields {
public:
    Fields(const Document& document, const Json* object, std::string what)
        : document_(&document), object_(object), what_(std::move(what)) {
        if (object != nullptr && !object->is_object())
            fail("is no object");
    }
    bool stated() const { return object_ != nullptr; }
    bool has(const char* key) const { return find(key) != nullptr; }
    const std::string& what() const { return what_; }
    /// The same object, called otherwise.
    Fields called(const std::string& what) const { return {*document_, object_, what}; }
    [[noreturn]] void fail(std::string_view mistake) const {
        document_->fail(fmt::format("{} {}; export it anew", what_, mistake));
    }
    Fields object(const char* key) const { return {*document_, find(key), fmt::format("{} {}", what_, key)}; }
    Fields extension(const char* name) const { return object("extensions").object(name); }
    /// Of a list; it must be there.
    Fields entry(const char* list, const char* kind, int number) const {
        const Json* const found = find(list);
        const std::size_t count = found != nullptr && found->is_array() ? found->size() : 0;
        if (number < 0 || static_cast<std::size_t>(number) >= count)
            fail_index(*document_, count, number, kind, what_);
        return {*document_, &(*found)[static_cast<std::size_t>(number)], fmt::format("{} {}", kind, number)};
    }
    float number(const char* key, float preset, Range range) const {
        return static_cast<float>(real(key, double{preset}, range));
    }
    double real(const char* key, double preset, Range range) const {
        const Json* const value = find(key);
        return value == nullptr ? preset : to_number(*value, key, range);
    }
    int index(const char* key) const {
        const Json* const value = find(key);
        if (value == nullptr)
            return none;
        if (!value->is_number_integer() || *value < 0 || *value > 1 << 30)
            fail(fmt::format("has {} {}, which is no index", key, shown(*value)));
        return value->get<int>();
    }
    /// So many numbers.
    template <class Vector> Vector vector(const char* key, Vector preset, Range range) const {
        const Json* const list = find(key);
        if (list == nullptr)
            return preset;
        if (!list->is_array() || list->size() != static_cast<std::size_t>(Vector::length()))
            fail(fmt::format("has {} {}, which is not of {} numbers", key, shown(*list), Vector::length()));
        for (int i = 0; i < Vector::length(); ++i)
            preset[i] = static_cast<typename Vector::value_type>(
                to_number((*list)[static_cast<std::size_t>(i)], key, range));
        return preset;
    }
    std::string text(const char* key, std::string_view preset) const {
        const Json* const value = find(key);
        if (value != nullptr && !value->is_string())
            fail(fmt::format("has {} {}, which is no text", key, shown(*value)));
        return value == nullptr ? std::string(preset) : value->get<std::string>();
    }
    bool flag(const char* key) const {
        const Json* const value = find(key);
        if (value != nullptr && !value->is_boolean())
            fail(fmt::format("has {} {}, which is neither true nor false", key, shown(*value)));
        return value != nullptr && value->get<bool>();
    }

private:
    const Json* find(const char* key) const {
        if (object_ == nullptr)
            return nullptr;
        const auto found = object_->find(key);
        return found == object_->end() ? nullptr : &*found;
    }
    double to_number(const Json& value, const char* key, Range range) const {
        if (!value.is_number() || !std::isfinite(value.get<double>()))
            fail(fmt::format("has {} {}, which is no number", key, shown(value)));
        const double stated = value.get<double>(), taken = std::clamp(stated, range.least, range.most);
        if (taken != stated)
            document_->note(fmt::format("{}: {} of {} is taken as {}, the nearest that there is", what_, key,
                                        stated, taken));
        return taken;
    }
    static std::string shown(const Json& value) {
        return printable(value.dump(-1, ' ', false, Json::error_handler_t::replace));
    }

    const Document* document_;
    const Json* object_;
    std::string what_;
};

} // namespace razor::gltf
