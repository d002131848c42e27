/**
 * The vocabulary's words in a scene's properties.
 */
#pragma once

#include <mitsuba/core/properties.h>
#include <string>

namespace prob_water {

/// Sets every word of a vocabulary that the scene gives among the options of a core, and calls `object` with the name of one that
/// is neither a number nor a flag nor text.
template <typename Vocabulary, typename Options, typename Object>
void set_words(const mitsuba::Properties &props, const Vocabulary &vocabulary, Options &options, Object object) {
    using Type = mitsuba::Properties::Type;
    for (const auto &entry : vocabulary) {
        std::string name(entry);
        if (!props.has_property(name))
            continue;
        switch (props.type(name)) {
            case Type::Bool: options.set_flag(name, props.get<bool>(name)); break;
            case Type::Integer: options.set_number(name, (double) props.get<int64_t>(name)); break;
            case Type::Float: options.set_number(name, props.get<double>(name)); break;
            case Type::String: options.set_text(name, std::string(props.get<std::string_view>(name))); break;
            default: object(name);
        }
    }
}

} // namespace prob_water
