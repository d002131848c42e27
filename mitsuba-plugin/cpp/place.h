/**
 * What changes from place to place, as Dr.Jit expressions: one drawn sea, the core's
 * instance_lobe.rs.
 */
#pragma once

#include "replay.h"
#include <algorithm>
#include <drjit/while_loop.h>
#include <mitsuba/core/fwd.h>

namespace prob_water {

/// One drawn sea at one time.
template <typename Float_> struct Drawn {
    using Float = Float_;
    /// A place has digits to spare; not on GPUs, most of which are slow in double precision.
    using Wide = std::conditional_t<drjit::is_cuda_v<Float>, Float, drjit::float64_array_t<Float>>;
    using UInt32 = drjit::uint32_array_t<Float>;
    using Mask = drjit::mask_t<Float>;
    using Vector3f = mitsuba::Vector<Float, 3>;
    using Buffer = mitsuba::DynamicBuffer<Wide>;
    /// Turns per m along x and y, turns at the origin, amplitude, omega^2, log2(k/pi), and what fills a packet.
    using Wave = drjit::Array<Wide, 8>;

    /// 0 for another surface than an instance.
    uint32_t count = 0;
    bool is_drawn = false;
    /// Vertical acceleration, m/s^2, below which there is no whitecap, and the probability's fall per unit.
    Float no_whitecap, fall;
    Buffer waves;

    explicit Drawn(const DrawnWaves &w) : count((uint32_t) w.cells.size() / 8), is_drawn(w.drawn) {
        if (!is_drawn)
            return;
        no_whitecap = drjit::opaque<Float>((float) w.onset[1]);
        fall = drjit::opaque<Float>((float) (1. / std::max(w.onset[1] - w.onset[0], 1e-30)));
        std::vector<drjit::scalar_t<Wide>> cells(w.cells.begin(), w.cells.end());
        cells.resize(std::max<size_t>(cells.size(), 8));
        waves = drjit::load<Buffer>(cells.data(), cells.size());
    }

    DRJIT_STRUCT(Drawn, no_whitecap, fall, waves)

    /// The wave normal over a place in m, and the probability of a whitecap. With a footprint the waves too short for it
    /// are left out.
    std::pair<Vector3f, Float> at(const Wide &x, const Wide &y, const Float *footprint, const Replay<Float> &replay) const {
        namespace dr = drjit;
        Float reach = footprint ? dr::log2(*footprint) : Float(0.f);
        auto [j, slope_x, slope_y, acceleration] = dr::while_loop(
            dr::make_tuple(UInt32(0), Float(0.f), Float(0.f), Float(0.f)),
            [&](const UInt32 &j, auto &...) { return j < count; },
            [&](UInt32 &j, Float &slope_x, Float &slope_y, Float &acceleration) {
                Wave w = dr::gather<Wave>(waves, j);
                Wide turns = dr::fmadd(w[0], x, dr::fmadd(w[1], y, w[2]));
                auto [sin, cos] = replay.sincos_turns(Float(turns - dr::floor(turns)));
                Float a(w[3]);
                if (footprint)
                    a *= dr::sqrt(dr::clip(.5f - (Float(w[5]) + reach), 0.f, 1.f));
                Float steep = -dr::TwoPi<float> * a * sin;
                slope_x = dr::fmadd(steep, Float(w[0]), slope_x);
                slope_y = dr::fmadd(steep, Float(w[1]), slope_y);
                acceleration = dr::fnmadd(a * Float(w[4]), cos, acceleration);
                j += 1u;
            },
            "waves of prob_water");
        Vector3f n = dr::normalize(Vector3f(-slope_x, -slope_y, 1.f));
        return { n, dr::clip((no_whitecap - acceleration) * fall, 0.f, 1.f) };
    }
};

} // namespace prob_water
