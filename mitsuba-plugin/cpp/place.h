/**
 * What changes from place to place, as Dr.Jit expressions: facets for a footprint, the twin of the Rust core's
 * facet_table.rs, and one drawn sea, that of instance_lobe.rs.
 */
#pragma once

#include "lobe.h"
#include <drjit/while_loop.h>
#include <mitsuba/core/fwd.h>

namespace prob_water {

/// The facets of any footprint.
template <typename Float_> struct FacetTable {
    using Float = Float_;
    using Buffer = mitsuba::DynamicBuffer<Float>;
    using UInt32 = drjit::uint32_array_t<Float>;
    /// sigma_u, sigma_c, steep_gain, bound, the proposal's two, and what fills a packet.
    using Row = drjit::Array<Float, 8>;

    /// 0 where the footprint is the same everywhere.
    uint32_t rows = 0;
    bool bounded = false;
    float first = 0.f, inv_step = 0.f;
    Float scale;
    Buffer cells;

    explicit FacetTable(const FacetRows &t) : rows((uint32_t) t.cells.size() / 8), bounded(t.bounded) {
        if (rows == 0)
            return;
        first = (float) t.first;
        inv_step = (float) (1. / t.step);
        scale = drjit::opaque<Float>((float) t.scale);
        cells = drjit::load<Buffer>(t.cells.data(), t.cells.size());
    }

    DRJIT_STRUCT(FacetTable, scale, cells)

    /// Gives the lobe another footprint, in m.
    void set(Lobe<Float> &lobe, const Float &footprint) const {
        namespace dr = drjit;
        Float place = smaller(larger((dr::log(larger(footprint, 1e-30f)) - first) * inv_step, 0.f), (float) (rows - 1));
        UInt32 node = dr::minimum(UInt32(place), rows - 2);
        Row a = dr::gather<Row>(cells, node), b = dr::gather<Row>(cells, node + 1u);
        Row row = dr::fmadd(Row(place - Float(node)), b - a, a);
        lobe.sigma_u = row[0];
        lobe.sigma_c = row[1];
        lobe.inv_width_u = float(Lobe<Float>::InvWidth) * dr::rcp(row[0]);
        lobe.inv_width_c = float(Lobe<Float>::InvWidth) * dr::rcp(row[1]);
        lobe.inv_width_u_lo = lobe.inv_width_c_lo = 0.f;
        lobe.scale = scale * dr::rcp(row[0] * row[1]);
        lobe.steep_gain = row[2];
        lobe.bound = row[3];
        lobe.bounded = bounded;
        lobe.proposal_u = row[4];
        lobe.proposal_c = row[5];
        lobe.inv_proposal_u = dr::rcp(row[4]);
        lobe.inv_proposal_c = dr::rcp(row[5]);
        lobe.proposal_norm = 8.f * dr::Pi<float> * row[4] * row[5];
    }
};

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
    std::pair<Vector3f, Float> at(const Wide &x, const Wide &y, const Float *footprint) const {
        namespace dr = drjit;
        Float reach = footprint ? dr::log2(*footprint) : Float(0.f);
        auto [j, slope_x, slope_y, acceleration] = dr::while_loop(
            dr::make_tuple(UInt32(0), Float(0.f), Float(0.f), Float(0.f)),
            [&](const UInt32 &j, auto &...) { return j < count; },
            [&](UInt32 &j, Float &slope_x, Float &slope_y, Float &acceleration) {
                Wave w = dr::gather<Wave>(waves, j);
                Wide turns = dr::fmadd(w[0], x, dr::fmadd(w[1], y, w[2]));
                auto [sin, cos] = Lobe<Float>::turn_sincos(Float(turns - dr::floor(turns)));
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
