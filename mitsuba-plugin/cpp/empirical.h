/**
 * The empirical model as a Dr.Jit expression, `surface = "empirical"`: the twin of the Rust core's empirical_lobe.rs
 * over the same fine grid. Directions are drawn by the Lobe beside it.
 */
#pragma once

#include "lobe.h"
#include <algorithm>
#include <mitsuba/core/fwd.h>
#include <vector>

namespace prob_water {

template <typename Float_> struct Tabled {
    using Float = Float_;
    using Mask = drjit::mask_t<Float>;
    using UInt32 = drjit::uint32_array_t<Float>;
    using Vector3f = mitsuba::Vector<Float, 3>;
    /// What the corners of cells hold, of one quantity and of two, in half precision, to which the core has rounded them.
    using Half = drjit::float16_array_t<Float>;
    using Buffer = mitsuba::DynamicBuffer<Half>;
    using Four = drjit::Array<Half, 4>;
    using Eight = drjit::Array<Half, 8>;

    /// Over tan(theta_i/2), the stand-in of the azimuth and tan(theta_r/2); 0 for another surface.
    uint32_t incidences = 0, azimuths = 0, thetas = 0;
    bool whitecaps = false, slopes = false;
    /// Steps on a side of the density of facets.
    uint32_t steps = 0;
    /// The largest tan(theta_i/2), and steps over it; shares of waves in slopes; standard deviations of tilt angles, and steps over those.
    Float cos_wind, sin_wind, last, inv_step, carried_u, carried_c, inv_sigma_u, inv_sigma_c, inv_step_u, inv_step_c;
    Buffer in_plane, widths, densities;

    Tabled(const FineGrid &g, const Coefficients &c)
        : incidences(g.steps[0]), azimuths(g.steps[1]), thetas(g.steps[2]), whitecaps(g.whitecaps), slopes(g.slopes),
          steps(g.density_steps) {
        if (!incidences)
            return;
        auto data = [](double x) { return drjit::opaque<Float>((float) x); };
        cos_wind = data(c.cos_wind);
        sin_wind = data(c.sin_wind);
        last = data(g.incidence);
        inv_step = data(incidences / g.incidence);
        carried_u = data(g.carried[0]);
        carried_c = data(g.carried[1]);
        inv_sigma_u = data(1. / g.sigmas[0]);
        inv_sigma_c = data(1. / g.sigmas[1]);
        inv_step_u = data(1. / g.density_step[0]);
        inv_step_c = data(1. / g.density_step[1]);
        auto halves = [](const auto &cells) {
            std::vector<drjit::half> halves(cells.begin(), cells.end());
            return drjit::load<Buffer>(halves.data(), halves.size());
        };
        in_plane = halves(g.in_plane);
        widths = halves(g.widths);
        densities = halves(g.densities);
    }

    DRJIT_STRUCT(Tabled, cos_wind, sin_wind, last, inv_step, carried_u, carried_c, inv_sigma_u, inv_sigma_c, inv_step_u,
                 inv_step_c, in_plane, widths, densities)

    /// f times a cosine of some of its parts, for light from i seen from o.
    Float eval(const Lobe<Float> &lobe, const Vector3f &i, const Vector3f &o, const Float &cosine, Parts parts) const {
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
        UInt32 cell = a * azimuths + b, corners = cell * thetas + k;
        // Between two angles theta_i, and of the four corners about the azimuth and theta_r.
        auto plane = [&](auto packet) {
            using Packet = decltype(packet);
            auto far = single(dr::gather<Packet>(in_plane, corners + azimuths * thetas));
            auto near = single(dr::gather<Packet>(in_plane, corners));
            return dr::fmadd(decltype(near)(s), far - near, near);
        };
        auto between = [&](const Float &from, const Float &to) { return Float(dr::fmadd(t, to - from, from)); };
        auto middle = [&](const auto &p, size_t n, const Float &r) {
            return dr::lerp(between(p[n], p[n + 1]), between(p[n + 2], p[n + 3]), r);
        };
        Float level, foam;
        if (whitecaps) {
            auto ends = plane(Eight());
            level = middle(ends, 0, r);
            foam = middle(ends, 4, r);
        } else {
            level = middle(plane(Four()), 0, r);
        }

        Float f = 0.f;
        if (parts.facets) {
            Float rho = lobe.reflectance(smaller(.5f * dr::norm(i + o), 1.f));
            if (slopes) {
                Vector3f h = i + o;
                Float lean = -dr::rcp(larger(h.z(), 1e-12f)), u = lean * dr::fmadd(h.x(), cos_wind, h.y() * sin_wind),
                      v = lean * dr::fmsub(h.y(), cos_wind, h.x() * sin_wind), m_u = u * carried_u, m_v = v * carried_c,
                      // The waves that carry these facets lean with them.
                      up = dr::fnmadd(m_u, dr::fmadd(o.x(), cos_wind, o.y() * sin_wind),
                                      dr::fnmadd(m_v, dr::fmsub(o.y(), cos_wind, o.x() * sin_wind), o_z)),
                      cos_n = larger(up * dr::rsqrt(dr::fmadd(m_u, m_u, dr::fmadd(m_v, m_v, 1.f))), Leaning),
                      cos_i = larger(i.z(), 0.f);
                f = rho * dr::exp(level + ln_density(u, v)) * visible(lobe, cos_i, lobe.sine(cos_i), cos_n, lobe.sine(cos_n));
            } else {
                auto w = single(dr::gather<Eight>(widths, cell));
                // Eqs. 87-89 by half angles; both components that make phi are 1 + tan^2 times as long.
                Float tan2 = tan_i * tan_i, one = 1.f + tan2, aside = dr::fmsub(o.y(), x, o.x() * y) * inv * one,
                      specular = dr::abs(dr::fmadd(2.f * tan_i, forward, (1.f - tan2) * o_z)),
                      phi = Lobe<Float>::template angle<false>({ aside, 0.f }, { larger(specular, Small), 0.f }).hi,
                      off = dr::select(sin < 0.f, -phi, phi) - middle(w, 4, s), lower = smaller(tan_i, tan_r),
                      narrow = middle(w, 0, s) * dr::fnmadd(tan_i, lower, 1.f),
                      x2 = off * off * one * dr::fmadd(lower, lower, 1.f) * dr::rcp(narrow * narrow);
                // In the plane: the half vector leans by half the difference of theta_r and theta_i.
                Float over_i = dr::rcp(one), over_r = dr::rcp(dr::fmadd(tan_r, tan_r, 1.f)),
                      lean = (tan_i - tan_r) * dr::rcp(dr::fmadd(tan_i, tan_r, 1.f)) * inv;
                f = rho * dr::exp(level + ln_density(lean * cos, -lean * sin) - x2) *
                    visible(lobe, (1.f - tan2) * over_i, 2.f * tan_i * over_i,
                            larger(dr::fnmadd(tan_r, tan_r, 1.f) * over_r, 0.f), 2.f * dr::abs(tan_r) * over_r);
            }
        }
        if (parts.whitecaps && whitecaps)
            f = dr::fmadd(lobe.whitecap_brdf * (1.f / Shares), foam, f);
        return dr::select(lit, f * cosine, 0.f);
    }

private:
    /// The logarithm of the facets' density along a half vector of a slope upwind and crosswind.
    Float ln_density(const Float &slope_u, const Float &slope_c) const {
        namespace dr = drjit;
        float middle = .5f * steps, end = (float) steps;
        Float tilt_u = slope_u * Lobe<Float>::atan_over(slope_u * slope_u) * inv_sigma_u,
              tilt_c = slope_c * Lobe<Float>::atan_over(slope_c * slope_c) * inv_sigma_c,
              u = dr::fmadd(tilt_u, inv_step_u, middle), c = dr::fmadd(tilt_c, inv_step_c, middle);
        Mask inside = u > 0.f && c > 0.f && u < end && c < end;
        auto [j, s] = split(dr::select(inside, u, 0.f), steps);
        auto [k, t] = split(dr::select(inside, c, 0.f), steps);
        auto p = single(dr::gather<Four>(densities, j * steps + k));
        Float ratio = dr::lerp(dr::lerp(p[0], p[1], t), dr::lerp(p[2], p[3], t), s),
              gauss = .5f * dr::fmadd(tilt_u, tilt_u, tilt_c * tilt_c);
        return dr::select(inside, ratio - gauss, Nothing);
    }

    template <typename Packet> static auto single(const Packet &packet) {
        return drjit::Array<Float, Packet::Size>(packet);
    }

    /// G/(cos theta_i cos theta_r) on level water.
    static Float visible(const Lobe<Float> &lobe, const Float &cos_i, const Float &sin_i, const Float &cos_o,
                         const Float &sin_o) {
        namespace dr = drjit;
        Float area = cos_i * cos_o;
        if (lobe.shadowing)
            area = dr::fmadd(cos_o, lobe.hidden(cos_i, lobe.sigma_shadow * sin_i),
                             dr::fmadd(cos_i, lobe.hidden(cos_o, lobe.sigma_shadow * sin_o), area));
        return dr::rcp(larger(area, Grazing));
    }

    /// As in the core's empirical_lobe.rs and level_water.rs.
    static constexpr float Nothing = -87.f, Grazing = 1e-6f, Leaning = 1e-3f, Shares = 1024.f;

    /// A place on an axis of so many steps: the step and how far along it.
    static std::pair<UInt32, Float> split(const Float &x, uint32_t steps) {
        UInt32 k = drjit::minimum(UInt32(x), steps - 1);
        return { k, x - Float(k) };
    }
};

} // namespace prob_water
