/**
 * How a shape lends its sea to the BSDF on it, across two plugins.
 */
#pragma once

#include <mitsuba/core/properties.h>

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

} // namespace prob_water
