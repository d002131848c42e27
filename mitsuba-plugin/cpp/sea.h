/**
 * How a shape lends its sea to the BSDF on it, across two plugins.
 */
#pragma once

#include <mitsuba/core/object.h>
#include <mitsuba/core/properties.h>
#include <set>
#include <vector>

namespace prob_water {

/// A BSDF that takes the sea from the shape that it lies on.
struct TakesSea {
    virtual ~TakesSea() = default;
    /// Takes over parameters of the vocabulary as the shape gives them, before anything is rendered. Throws where the
    /// BSDF was given one of them itself, or any other that describes the sea.
    virtual void take_sea(const mitsuba::Properties &sea) = 0;
    /// Tells it the time in s that the shape now shows.
    virtual void set_time(double time) = 0;
};

/// Those of a BSDF: itself, or nested in it at any depth.
inline std::vector<TakesSea *> takers(mitsuba::Object *bsdf) {
    struct Search final : mitsuba::TraversalCallback {
        std::set<mitsuba::Object *> seen;
        std::vector<TakesSea *> found;
        void put_value(std::string_view, void *, uint32_t, const std::type_info &) override { }
        void put_object(std::string_view, mitsuba::Object *object, uint32_t) override {
            if (!object || !seen.insert(object).second)
                return;
            if (auto *takes = dynamic_cast<TakesSea *>(object))
                found.push_back(takes);
            else
                object->traverse(this);
        }
    } search;
    search.put("bsdf", bsdf, mitsuba::ParamFlags::NonDifferentiable);
    return search.found;
}

} // namespace prob_water
