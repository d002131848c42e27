/**
 * The empirical model as a Dr.Jit expression, `surface = "empirical"`: the twin of the Rust core's empirical_lobe.rs
 * over the same fine grid. Directions are drawn by the Lobe beside it.
 */
#pragma once

#include "lobe.h"
#include <mitsuba/core/fwd.h>

namespace prob_water {

template <typename Float_> struct Tabled {
    using Float = Float_;
    using Mask = drjit::mask_t<Float>;
    using UInt32 = drjit::uint32_array_t<Float>;
    using Vector3f = mitsuba::Vector<Float, 3>;
    using Buffer = mitsuba::DynamicBuffer<Float>;
    /// What the ends of an interval of the azimuth hold, of one quantity and of two.
    using Ends = drjit::Array<Float, 2>;
    using TwoEnds = drjit::Array<Float, 4>;

    /// Over tan(theta_i/2), the stand-in of the azimuth and tan(theta_r/2); 0 for another surface.
    uint32_t incidences = 0, azimuths = 0, thetas = 0;
    bool whitecaps = false, slopes = false;
    /// The largest tan(theta_i/2), and steps over it.
    Float cos_wind, sin_wind, last, inv_step;
    Buffer in_plane, widths;

    Tabled(const FineGrid &g, const Coefficients &c)
        : incidences(g.steps[0]), azimuths(g.steps[1]), thetas(g.steps[2]), whitecaps(g.whitecaps), slopes(g.slopes) {
        if (!incidences)
            return;
        auto data = [](double x) { return drjit::opaque<Float>((float) x); };
        cos_wind = data(c.cos_wind);
        sin_wind = data(c.sin_wind);
        last = data(g.incidence);
        inv_step = data(incidences / g.incidence);
        in_plane = drjit::load<Buffer>(g.in_plane.data(), g.in_plane.size());
        widths = drjit::load<Buffer>(g.widths.data(), g.widths.size());
    }

    DRJIT_STRUCT(Tabled, cos_wind, sin_wind, last, inv_step, in_plane, widths)

    /// f cos(theta_o) of some of its parts; the facets' closed form with `slopes` is that of the geometry.
    template <typename Geometry>
    Float eval(const Lobe<Float> &lobe, const Geometry &g, const Vector3f &i, const Vector3f &o, Parts parts) const {
        namespace dr = drjit;
        constexpr float Small = Lobe<Float>::Small;
        Mask lit = i.z() > 0.f && o.z() > 0.f;
        // Away from the source; with the wind where the source is overhead.
        Float flat2 = dr::fmadd(i.x(), i.x(), i.y() * i.y());
        Mask overhead = flat2 < 1e-12f;
        Float x = dr::select(overhead, cos_wind, -i.x()), y = dr::select(overhead, sin_wind, -i.y()),
              inv = dr::select(overhead, 1.f, dr::rsqrt(larger(flat2, 1e-12f))),
              tan_i = smaller(flat2 * inv * dr::rcp(1.f + larger(i.z(), 0.f)), last),
              // The wind's azimuth from there, to either side.
              cos = dr::fmadd(cos_wind, x, sin_wind * y), sin = dr::fmsub(sin_wind, x, cos_wind * y),
              around = dr::fnmadd(cos, dr::rcp(larger(dr::abs(cos) + dr::abs(sin), Lobe<Float>::Tiny)), 1.f),
              forward = dr::fmadd(o.x(), x, o.y() * y) * inv, o_z = larger(o.z(), 0.f),
              tan_r = forward * dr::rcp(larger(dr::sqrt(dr::fmadd(forward, forward, o_z * o_z)) + o_z, Small));

        auto [a, s] = split(tan_i * inv_step, incidences);
        auto [b, t] = split(.5f * azimuths * around, azimuths);
        auto [k, r] = split(dr::fmadd(.5f * thetas, tan_r, .5f * thetas), thetas);
        UInt32 cell = a * azimuths + b, row = cell * (thetas + 1) + k;
        // Between two angles theta_i, and two theta_r.
        auto across = [&](auto near, const auto &far) { return dr::fmadd(decltype(near)(s), far - near, near); };
        auto along = [&](auto packet, const UInt32 &row) {
            using Packet = decltype(packet);
            Packet low = dr::gather<Packet>(in_plane, row), high = dr::gather<Packet>(in_plane, row + 1u);
            return dr::fmadd(Packet(r), high - low, low);
        };
        UInt32 next = row + azimuths * (thetas + 1);
        auto plane = [&](auto packet) { return across(along(packet, row), along(packet, next)); };
        auto between = [&](const Float &from, const Float &to) { return Float(dr::fmadd(t, to - from, from)); };
        Float level, foam;
        if (whitecaps) {
            TwoEnds ends = plane(TwoEnds());
            level = between(ends[0], ends[1]);
            foam = between(ends[2], ends[3]);
        } else {
            Ends ends = plane(Ends());
            level = between(ends[0], ends[1]);
        }

        Float f = 0.f;
        if (parts.facets && slopes) {
            f = smaller(lobe.facets(g), Lobe<Float>::Largest) * dr::exp(level);
        } else if (parts.facets) {
            TwoEnds w = across(dr::gather<TwoEnds>(widths, cell), dr::gather<TwoEnds>(widths, cell + azimuths));
            // Eqs. 87-89 by half angles; both components that make phi are 1 + tan^2 times as long.
            Float tan2 = tan_i * tan_i, one = 1.f + tan2, aside = dr::fmsub(o.y(), x, o.x() * y) * inv * one,
                  specular = dr::abs(dr::fmadd(2.f * tan_i, forward, (1.f - tan2) * o_z)), abs = dr::abs(aside),
                  most = larger(larger(abs, specular), Small),
                  phi = Lobe<Float>::template angle<Float>(aside, specular, abs, most, dr::rcp(most)),
                  off = dr::select(sin < 0.f, -phi, phi) - between(w[2], w[3]), lower = smaller(tan_i, tan_r),
                  narrow = between(w[0], w[1]) * dr::fnmadd(tan_i, lower, 1.f),
                  x2 = off * off * one * dr::fmadd(lower, lower, 1.f) * dr::rcp(narrow * narrow),
                  rho = lobe.template reflectance<Float>(smaller(.5f * dr::norm(i + o), 1.f));
            f = rho * dr::exp(level - x2);
        }
        if (parts.whitecaps && whitecaps)
            f = dr::fmadd(lobe.whitecap_brdf, foam, f);
        return dr::select(lit, f * o_z, 0.f);
    }

private:
    /// A place on an axis of so many steps: the step and how far along it.
    static std::pair<UInt32, Float> split(const Float &x, uint32_t steps) {
        UInt32 k = drjit::minimum(UInt32(x), steps - 1);
        return { k, x - Float(k) };
    }
};

} // namespace prob_water
