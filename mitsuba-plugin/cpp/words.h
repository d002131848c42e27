/**
 * The vocabulary's words in a scene's properties.
 */
#pragma once

#include <mitsuba/core/properties.h>
#include <string>

namespace prob_water {

/// Calls `word` with the name and the value, a double, a bool or a std::string, of every word that the scene gives, and
/// `object` with the name of one that is none of these.
template <typename Vocabulary, typename Word, typename Object>
void words(const mitsuba::Properties &props, const Vocabulary &vocabulary, Word word, Object object) {
    using Type = mitsuba::Properties::Type;
    for (const auto &entry : vocabulary) {
        std::string name(entry);
        if (!props.has_property(name))
            continue;
        switch (props.type(name)) {
            case Type::Bool:
                word(name, props.get<bool>(name));
                break;
            case Type::Integer:
                word(name, (double) props.get<int64_t>(name));
                break;
            case Type::Float:
                word(name, props.get<double>(name));
                break;
            case Type::String:
                word(name, std::string(props.get<std::string_view>(name)));
                break;
            default:
                object(name);
        }
    }
}

/// Sets a word among the options of a core that takes numbers, flags and text.
template <typename Options> auto set_word(Options &options) {
    return [&options](const std::string &name, const auto &value) {
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, double>)
            options.set_number(name, value);
        else if constexpr (std::is_same_v<Value, bool>)
            options.set_flag(name, value);
        else
            options.set_text(name, value);
    };
}

} // namespace prob_water
