/**
 * The sea from afar as a Dr.Jit expression, `surface = "ensemble"`: the twin of the Rust core's ensemble_lobe.rs over the
 * same table, interpolated linearly, D by squares. Directions are drawn by the Lobe beside it.
 */
#pragma once

#include "lobe.h"
#include <mitsuba/core/fwd.h>

namespace prob_water {

template <typename Float_> struct Afar {
    using Float = Float_;
    using Mask = drjit::mask_t<Float>;
    using UInt32 = drjit::uint32_array_t<Float>;
    using Vector3f = mitsuba::Vector<Float, 3>;
    using Buffer = mitsuba::DynamicBuffer<Float>;
    /// D, means and variances of the slopes upwind and crosswind, second differences of D, and what fills a packet.
    using Cell = drjit::Array<Float, 8>;

    /// Nodes on a side of the table; 0 where there are no waves, or the surface is another.
    uint32_t rows = 0;
    /// `average = "report"`: the mean of f, not of power.
    bool report = false;
    Float inv_step_u, inv_step_c, sigma_u, sigma_c, foam, foam_u, foam_c;
    Buffer cells;

    explicit Afar(const Waves &w) : rows(w.rows), report(w.report) {
        if (rows == 0)
            return;
        auto data = [](float x) { return drjit::opaque<Float>(x); };
        inv_step_u = data(1.f / w.steps[0]);
        inv_step_c = data(1.f / w.steps[1]);
        sigma_u = data(w.sigma[0]);
        sigma_c = data(w.sigma[1]);
        foam = data(w.foam[0]);
        foam_u = data(w.foam[1]);
        foam_c = data(w.foam[2]);
        cells = drjit::load<Buffer>(w.cells.data(), w.cells.size());
    }

    DRJIT_STRUCT(Afar, inv_step_u, inv_step_c, sigma_u, sigma_c, foam, foam_u, foam_c, cells)

    /// f times a cosine of some of its parts, for light from i seen from o.
    Float eval(const Lobe<Float> &lobe, const Vector3f &i, const Vector3f &o, const Float &cosine, Parts parts) const {
        namespace dr = drjit;
        auto [i_u, i_c] = lobe.wind_frame(i.x(), i.y());
        auto [o_u, o_c] = lobe.wind_frame(o.x(), o.y());
        Mask lit = i.z() > 0.f && o.z() > 0.f;

        Float reflected = 0.f;
        if (parts.facets) {
            Float inv_h = dr::rcp(larger(i.z() + o.z(), Lobe<Float>::Small));
            Cell cell = at(-(i_u + o_u) * inv_h, -(i_c + o_c) * inv_h, lit);
            // The plane of the slopes: of the two directions, or of the observer.
            Float d_u = o_u, d_c = o_c;
            if (!report) {
                d_u -= i_u;
                d_c -= i_c;
            }
            Float inv_d = dr::rsqrt(larger(dr::fmadd(d_u, d_u, d_c * d_c), 1e-20f));
            d_u *= inv_d;
            d_c *= inv_d;
            Float variance = larger(dr::fmadd(d_u * d_u, cell[3], d_c * d_c * cell[4]), 0.f), spread = dr::sqrt(variance),
                  rho = lobe.reflectance(smaller(.5f * dr::norm(i + o), 1.f)), shadowing = 0.f;
            auto visible_at = [&](const Float &step, const Float &across) {
                Float s_u = dr::fmadd(d_u, step, cell[1]), s_c = dr::fmadd(d_c, step, cell[2]);
                return visible(lobe, rho, i_u, i_c, i.z(), o_u, o_c, o.z(), s_u, s_c, across);
            };
            if (report) {
                // Gauss and Legendre's seven up to where waves turn from the observer.
                constexpr float Rule[4][2] = { { 0.f, .417959184f }, { .405845151f, .381830051f },
                                               { .741531186f, .279705391f }, { .949107912f, .129484966f } };
                constexpr float End = 3.5f;
                Float across = larger(cell[3] + cell[4] - variance, 0.f), level = dr::fmadd(o_u, d_u, o_c * d_c),
                      turns = (o.z() - dr::fmadd(o_u, cell[1], o_c * cell[2])) / larger(level * spread, 1e-12f),
                      half = .5f * (larger(smaller(turns, End), -End) + End);
                for (const auto &[x, weight] : Rule) {
                    for (float side : { 1.f, -1.f }) {
                        if (x == 0.f && side < 0.f)
                            continue;
                        Float at = dr::fmsub(half, 1.f + side * x, End);
                        shadowing = dr::fmadd(visible_at(spread * at, across), weight * gauss(at), shadowing);
                    }
                }
                shadowing *= half;
            } else {
                // Gauss and Hermite's five.
                constexpr float Rule[3][2] = { { 0.f, 8.f / 15.f }, { 1.35562618f, .222075922f },
                                               { 2.85697001f, .0112574113f } };
                for (const auto &[x, weight] : Rule) {
                    for (float side : { 1.f, -1.f }) {
                        if (x == 0.f && side < 0.f)
                            continue;
                        shadowing = dr::fmadd(visible_at(spread * (side * x), 0.f), weight, shadowing);
                    }
                }
            }
            reflected = cell[0] * rho * shadowing;
        }
        if (parts.whitecaps) {
            Float seen;
            if (report) {
                Float spread2 = dr::fmadd(foam_u * o_u, o_u, foam_c * o_c * o_c) / larger(foam, Lobe<Float>::Tiny),
                      inv = dr::rsqrt(larger(spread2, 1e-12f)), turns = o.z() * inv;
                seen = dr::fmadd(foam * i.z(), below(turns),
                                 dr::fmadd(foam_u * i_u, o_u, foam_c * i_c * o_c) * inv * gauss(turns));
            } else {
                seen = dr::fmadd(foam * i.z(), o.z(), dr::fmadd(foam_u * i_u, o_u, foam_c * i_c * o_c));
            }
            reflected = dr::fmadd(lobe.whitecap_brdf, larger(seen, 0.f), reflected);
        }
        if (report)
            reflected *= o.z();
        // Over cos theta_i (1 + L_i + L_o).
        Float h_i = lobe.hidden(i.z(), waves(i_u, i_c)), h_o = lobe.hidden(o.z(), waves(o_u, o_c)),
              over = dr::fmadd(i.z(), o.z(), dr::fmadd(o.z(), h_i, i.z() * h_o));
        return dr::select(lit, reflected * cosine / larger(over, Lobe<Float>::Tiny), 0.f);
    }

private:
    /// Facets along a half vector of a slope upwind and crosswind; none beyond the table.
    Cell at(const Float &slope_u, const Float &slope_c, const Mask &active) const {
        namespace dr = drjit;
        float middle = .5f * (rows - 1), end = rows - 1.001f;
        Float angle_u = slope_u * Lobe<Float>::atan_over(slope_u * slope_u),
              angle_c = slope_c * Lobe<Float>::atan_over(slope_c * slope_c),
              u = dr::fmadd(angle_u, inv_step_u, middle), c = dr::fmadd(angle_c, inv_step_c, middle);
        Mask inside = active && u >= 0.f && c >= 0.f && u < end && c < end;
        u = dr::select(inside, u, 0.f);
        c = dr::select(inside, c, 0.f);
        UInt32 row(u), column(c), index = row * rows + column;
        u -= Float(row);
        c -= Float(column);
        auto node = [&](uint32_t offset) { return dr::gather<Cell>(cells, index + offset, inside); };
        Cell corner = node(0), opposite = node(rows + 1), near = dr::fmadd(Cell(c), node(1) - corner, corner),
             far_side = node(rows), far = dr::fmadd(Cell(c), opposite - far_side, far_side),
             cell = dr::fmadd(Cell(u), far - near, near);
        // What a straight line misses.
        Float bend = dr::fmadd(dr::fnmadd(u, u, u), corner[5] + opposite[5],
                               dr::fnmadd(c, c, c) * (corner[6] + opposite[6]));
        cell[0] = larger(dr::fnmadd(.25f, bend, cell[0]), 0.f);
        return cell;
    }

    /// sqrt(2) times the drawn slopes' standard deviation along a horizontal vector, times its length.
    Float waves(const Float &u, const Float &c) const {
        namespace dr = drjit;
        return dr::SqrtTwo<float> * dr::sqrt(dr::square(u * sigma_u) + dr::square(c * sigma_c));
    }

    /// Gauss's density.
    static Float gauss(const Float &x) {
        namespace dr = drjit;
        return dr::exp(-.5f * x * x) * (dr::InvSqrtTwoPi<float>);
    }

    /// Its integral up to an x not below 0, to 1e-7 (Abramowitz and Stegun, 7.1.26).
    static Float below(const Float &x) {
        namespace dr = drjit;
        Float t = dr::rcp(dr::fmadd(.3275911f * dr::InvSqrtTwo<float>, x, 1.f)), sum = 1.061405429f;
        for (float c : { -1.453152027f, 1.421413741f, -.284496736f, .254829592f })
            sum = dr::fmadd(sum, t, c);
        return dr::fnmadd(.5f * sum * t, dr::exp(-.5f * x * x), 1.f);
    }

    /// G about the normal of a slope, held to what the facets leave visible, and for the report's mean over its cosine to
    /// the observer; 0 where it turns away. There normals lean across as well, by slopes of a variance.
    Float visible(const Lobe<Float> &lobe, const Float &rho, const Float &i_u, const Float &i_c, const Float &i_z,
                  const Float &o_u, const Float &o_c, const Float &o_z, const Float &s_u, const Float &s_c,
                  const Float &across) const {
        namespace dr = drjit;
        Float lean = dr::fmadd(s_u, s_u, s_c * s_c);
        if (report)
            lean += across;
        Float n_z = dr::rsqrt(1.f + lean),
              cos_i = (i_z - dr::fmadd(i_u, s_u, i_c * s_c)) * n_z, cos_o = (o_z - dr::fmadd(o_u, s_u, o_c * s_c)) * n_z,
              both = cos_i * cos_o;
        Mask lit = cos_i > 0.f && cos_o > 0.f;
        auto spread = [&](const Float &u, const Float &c, const Float &z) {
            Float a = dr::fmadd(z, s_u, u) * n_z * lobe.sigma_u, b = dr::fmadd(z, s_c, c) * n_z * lobe.sigma_c;
            return Float(dr::SqrtTwo<float> * dr::sqrt(dr::fmadd(a, a, b * b)));
        };
        Float area = lobe.unshadowed(rho, cos_i, cos_o, [&] {
            return std::pair(spread(i_u, i_c, i_z), spread(o_u, o_c, o_z));
        });
        return dr::select(lit, (report ? cos_i : both) / larger(area, Lobe<Float>::Tiny), 0.f);
    }
};

} // namespace prob_water
