/**
 * The closed form of the BRDF about (0, 0, 1) as Dr.Jit expressions: the twin of the Rust core's
 * brdf.rs and sampling.rs over the same coefficients, compared with it lane by lane in the tests.
 * Equation numbers are the report's; the names are the core's.
 */
#pragma once

#include <drjit/math.h>
#include <mitsuba/core/vector.h>

namespace prob_water {

/// Which of the two lobes take part.
struct Parts {
    bool facets, whitecaps;
    uint32_t bits() const { return (facets ? 1u : 0u) | (whitecaps ? 2u : 0u); }
    bool none() const { return !facets && !whitecaps; }
};

template <typename Float_> struct Lobe {
    using Float = Float_;
    using Mask = drjit::mask_t<Float>;
    using Vector3f = mitsuba::Vector<Float, 3>;
    using Point2f = mitsuba::Point<Float, 2>;

    /// The smallest normal number: keeps quotients finite.
    static constexpr float Tiny = 1.17549435e-38f;
    static constexpr float Largest = 3.40282347e+38f;
    /// As in the core's sampling.rs.
    static constexpr float WhitecapAlbedo = 0.22f, FacetAlbedoFloor = 0.01f, Grazing = 1e-12f;

    /// Numbers are data, so that a change does not compile new kernels; decisions are made while tracing.
    Float cos_wind, sin_wind, sigma_u, sigma_c, inv_sigma_u, inv_sigma_c, scale, c21, c03, steep_cos, steep_bound, sigma_shadow,
        bound, proposal_u, proposal_c, inv_proposal_u, inv_proposal_c, proposal_norm, normal_reflectance, ior2, whitecap_fraction, whitecap_brdf;
    bool exact = false, slope_measure = false, gram_charlier = false, shadowing = false, bounded = false,
         as_printed = false;
    float ierfc[6] = {};

    explicit Lobe(const Coefficients &c)
        : exact(c.exact), slope_measure(c.slope_measure), gram_charlier(c.gram_charlier), shadowing(c.shadowing),
          bounded(c.bounded), as_printed(c.as_printed) {
        for (int k = 0; k < 6; ++k)
            ierfc[k] = c.ierfc[k];
        auto data = [](float x) { return drjit::opaque<Float>(x); };
        cos_wind = data(c.cos_wind);
        sin_wind = data(c.sin_wind);
        sigma_u = data(c.sigma_u);
        sigma_c = data(c.sigma_c);
        inv_sigma_u = data(1.f / c.sigma_u);
        inv_sigma_c = data(1.f / c.sigma_c);
        scale = data(c.scale);
        c21 = data(c.c21);
        c03 = data(c.c03);
        steep_cos = data(c.steep_cos);
        steep_bound = data(c.steep_bound);
        sigma_shadow = data(c.sigma_shadow);
        bound = data(c.bound);
        proposal_u = data(c.proposal_u);
        proposal_c = data(c.proposal_c);
        inv_proposal_u = data(1.f / c.proposal_u);
        inv_proposal_c = data(1.f / c.proposal_c);
        proposal_norm = data(8.f * drjit::Pi<float> * c.proposal_u * c.proposal_c);
        normal_reflectance = data(c.normal_reflectance);
        ior2 = data(c.ior2);
        whitecap_fraction = data(c.whitecap_fraction);
        whitecap_brdf = data(c.whitecap_brdf);
    }

    DRJIT_STRUCT(Lobe, cos_wind, sin_wind, sigma_u, sigma_c, inv_sigma_u, inv_sigma_c, scale, c21, c03,
                 steep_cos, steep_bound, sigma_shadow, bound, proposal_u, proposal_c, inv_proposal_u,
                 inv_proposal_c, proposal_norm, normal_reflectance, ior2, whitecap_fraction, whitecap_brdf)

    /// What the two directions fix.
    struct Geometry {
        Float cos_i, cos_o, cos_zeta, cos_xi;
        /// Horizontal components of the half vector along and across the wind, and their scale to slopes.
        Float half_u, half_c, inv_half_z;
        /// Tilts in the density's measure.
        Float tilt_u, tilt_c;
        Mask lit;
    };

    Geometry geometry(const Vector3f &i, const Vector3f &o) const {
        namespace dr = drjit;
        Geometry g;
        g.cos_i = i.z();
        g.cos_o = o.z();
        g.lit = g.cos_i > 0.f && g.cos_o > 0.f;
        Vector3f h = i + o;
        Float length2 = dr::maximum(dr::squared_norm(h), Tiny), inv_length = dr::rsqrt(length2),
              hz = dr::maximum(h.z(), Tiny);
        g.cos_zeta = dr::minimum(.5f * length2 * inv_length, 1.f);
        g.cos_xi = hz * inv_length;
        std::tie(g.half_u, g.half_c) = wind_frame(h.x(), h.y());
        g.inv_half_z = dr::rcp(hz);
        g.tilt_u = slope_measure ? Float(g.half_u * g.inv_half_z) : angle(g.half_u, hz);
        g.tilt_c = slope_measure ? Float(g.half_c * g.inv_half_z) : angle(g.half_c, hz);
        return g;
    }

    /// f cos(theta_o), Eqs. 55-79, of some of its parts, each with its share of the surface.
    Float eval(const Geometry &g, const Vector3f &i, const Vector3f &o, Parts parts) const {
        namespace dr = drjit;
        Float f = 0.f;
        if (parts.facets) {
            f = dr::minimum(facets(g, i, o), Largest);
            if (parts.whitecaps)
                f = dr::fmadd(whitecap_fraction, whitecap_brdf - f, f);
            else
                f -= whitecap_fraction * f;
        } else if (parts.whitecaps) {
            f = whitecap_fraction * whitecap_brdf;
        }
        return dr::select(g.lit, f * g.cos_o, 0.f);
    }

    /// Density, 1/sr, with which sample() draws o.
    Float pdf(const Geometry &g, const Vector3f &i, Parts parts) const {
        namespace dr = drjit;
        if (!parts.facets)
            return dr::select(g.lit, g.cos_o * dr::InvPi<float>, 0.f);
        Proposal p = proposal(i);
        Float z_u = g.tilt_u * inv_proposal_u, z_c = g.tilt_c * inv_proposal_c,
              towards = dr::fmadd(z_u, p.u, z_c * p.c),
              shown = dr::square(g.cos_zeta) * 2.f * g.inv_half_z * p.inv_cos,
              shape = dr::minimum(shown, 2.f) + dr::select(towards > 1.f, towards, 0.f),
              gauss = dr::exp(-.5f * dr::fmadd(z_u, z_u, z_c * z_c)),
              jacobian = g.cos_xi * dr::square(g.cos_xi) * g.cos_zeta;
        if (!slope_measure) {
            Float inv2 = dr::square(g.inv_half_z);
            jacobian *= dr::fmadd(dr::square(g.half_u), inv2, 1.f) * dr::fmadd(dr::square(g.half_c), inv2, 1.f);
        }
        Float pdf = gauss * shape / dr::maximum(proposal_norm * (1.f + p.tail) * jacobian, Tiny);
        pdf = dr::minimum(pdf, Largest);
        if (parts.whitecaps) {
            auto [facets, all] = albedos(g.cos_i);
            Float share = facets / all;
            pdf = dr::fmadd(share, pdf, (1.f - share) * g.cos_o * dr::InvPi<float>);
        }
        return dr::select(g.lit, pdf, 0.f);
    }

    /// A direction, zero where the draw is lost, and whether it comes from the whitecaps.
    std::pair<Vector3f, Mask> sample(const Vector3f &i, Float u0, const Point2f &u, Parts parts) const {
        namespace dr = drjit;
        if (!parts.facets) {
            auto [sin, cos] = turn_sincos(u.y());
            return { cosine(u.x(), sin, cos), Mask(true) };
        }

        Mask whitecap = false;
        Float choice = u0;
        if (parts.whitecaps) {
            // u0 over the facets' share.
            auto [facets, all] = albedos(i.z());
            choice = u0 * all / facets;
            whitecap = choice >= 1.f;
            choice = dr::minimum(choice, 1.f);
        }

        Proposal p = proposal(i);
        Float scaled = choice * (1.f + p.tail);
        Mask in_tail = scaled < p.tail;
        Float rest = dr::select(in_tail, scaled / dr::maximum(p.tail, Tiny), scaled - p.tail);
        Mask turns = in_tail;
        if (parts.whitecaps)
            turns &= !whitecap;
        auto [sin, cos] = turn_sincos(dr::select(turns, rest, u.y()));

        // Box-Muller around the source's azimuth; in the tail r is Rayleigh beyond 1/D.
        Float first = radius2(u.x()), root = dr::sqrt(first),
              r = dr::select(in_tail, dr::sqrt(dr::fmadd(p.inv_d, p.inv_d, first)), root * cos),
              q = dr::select(in_tail, dr::sqrt(radius2(u.y())) * cos, root * sin);
        Mask level = p.inv_d > 1e15f;
        Float e_u = dr::select(level, 1.f, p.u * p.inv_d), e_c = dr::select(level, 0.f, p.c * p.inv_d),
              t_u = dr::fmsub(e_u, r, e_c * q) * proposal_u, t_c = dr::fmadd(e_c, r, e_u * q) * proposal_c;
        // The half vector up to its length; tangents of tilt angles as sines over cosines.
        Mask valid = true;
        Float z = 1.f;
        if (!slope_measure) {
            valid = dr::maximum(dr::abs(t_u), dr::abs(t_c)) < dr::Pi<float> * .5f;
            auto [s_u, c_u] = quarter_sincos(t_u);
            auto [s_c, c_c] = quarter_sincos(t_c);
            t_u = s_u * c_c;
            t_c = s_c * c_u;
            z = c_u * c_c;
        }

        // The tilt or its opposite, in proportion to what they show the source.
        auto [i_u, i_c] = wind_frame(i.x(), i.y());
        Float x = dr::fmadd(t_u, i_u, t_c * i_c), level_area = z * i.z(),
              a = dr::maximum(level_area + x, 0.f), b = dr::maximum(level_area - x, 0.f);
        Mask turn = !in_tail && rest * (a + b) < b;
        Float length = dr::rsqrt(dr::fmadd(z, z, dr::fmadd(t_u, t_u, t_c * t_c))),
              turned = dr::select(turn, -length, length);
        t_u *= turned;
        t_c *= turned;
        Vector3f h(dr::fmsub(t_u, cos_wind, t_c * sin_wind), dr::fmadd(t_u, sin_wind, t_c * cos_wind), z * length);
        Vector3f o = dr::fmsub(Vector3f(2.f * dr::dot(i, h)), h, i);
        o = dr::select(valid, o, 0.f);
        if (parts.whitecaps)
            o = dr::select(whitecap, cosine(u.x(), sin, cos), o);
        return { o, whitecap };
    }

private:
    /// What the source fixes of the facets' proposal: components of z that make rD, 1/D, D phi(1/D).
    struct Proposal {
        Float u, c, inv_cos, inv_d, tail;
    };

    Proposal proposal(const Vector3f &i) const {
        namespace dr = drjit;
        auto [u, c] = wind_frame(i.x(), i.y());
        Proposal p;
        p.inv_cos = dr::rcp(dr::maximum(i.z(), Grazing));
        p.u = u * proposal_u * p.inv_cos;
        p.c = c * proposal_c * p.inv_cos;
        Float d2 = dr::maximum(dr::fmadd(p.u, p.u, p.c * p.c), Tiny);
        p.inv_d = dr::rsqrt(d2);
        p.tail = d2 * p.inv_d * dr::exp(-.5f * p.inv_d * p.inv_d) * 0.3989422804f;
        return p;
    }

    static Vector3f cosine(const Float &u, const Float &sin, const Float &cos) {
        namespace dr = drjit;
        Float r = dr::sqrt(u);
        return { r * cos, r * sin, dr::safe_sqrt(1.f - u) };
    }

    static Float radius2(const Float &u) {
        namespace dr = drjit;
        return dr::maximum(-2.f * dr::log(dr::maximum(1.f - u, Tiny)), 0.f);
    }

    /// Components along W_u and W_c (Eq. 68).
    std::pair<Float, Float> wind_frame(const Float &x, const Float &y) const {
        namespace dr = drjit;
        return { dr::fmadd(x, cos_wind, y * sin_wind), dr::fmsub(y, cos_wind, x * sin_wind) };
    }

    /// f_SW, Eq. 56.
    Float facets(const Geometry &g, const Vector3f &i, const Vector3f &o) const {
        namespace dr = drjit;
        // p (Eqs. 72-73, 78-79) and cos^4 xi.
        Float u = dr::clip(-g.tilt_u * inv_sigma_u, -1e3f, 1e3f), c = dr::clip(g.tilt_c * inv_sigma_c, -1e3f, 1e3f);
        if (as_printed) {
            u = dr::abs(u);
            c = dr::abs(c);
        }
        Float u2 = u * u, c2 = c * c, cos4 = dr::maximum(dr::square(dr::square(g.cos_xi)), Tiny);
        Float p = dr::exp(-.5f * (u2 + c2));
        if (!slope_measure && !as_printed)
            p = dr::select(g.cos_xi < steep_cos, dr::minimum(p, steep_bound * cos4), p);
        if (gram_charlier) {
            Float skew_c = as_printed ? Float(c2 - 1.f) : Float((c2 - 1.f) * u);
            Float k = 1.f - .5f * c21 * skew_c - (1.f / 6.f) * c03 * u * (u2 - 3.f)
                    + (.40f / 24.f) * dr::fmadd(c2, c2 - 6.f, 3.f) + (.12f / 4.f) * (c2 - 1.f) * (u2 - 1.f)
                    + (.23f / 24.f) * dr::fmadd(u2, u2 - 6.f, 3.f);
            p *= dr::maximum(k, 0.f);
        }

        // cos theta_i cos theta_r/G (Eqs. 61-67), over rho where the bound is in force.
        Float rho = reflectance(g.cos_zeta), area = g.cos_i * g.cos_o;
        if (shadowing) {
            Float s_i = sigma_shadow * dr::safe_sqrt(dr::fnmadd(g.cos_i, g.cos_i, 1.f)),
                  s_o = sigma_shadow * dr::safe_sqrt(dr::fnmadd(g.cos_o, g.cos_o, 1.f));
            area += dr::fmadd(g.cos_o, hidden(g.cos_i, s_i), g.cos_i * hidden(g.cos_o, s_o));
        }
        if (bounded) {
            Float v_i = g.cos_i + hidden(g.cos_i, spread(i)), v_o = g.cos_o + hidden(g.cos_o, spread(o));
            area = dr::maximum(area, rho / bound * dr::maximum(v_i * g.cos_o, v_o * g.cos_i));
        }
        return p * rho * scale / cos4 / dr::maximum(area, Tiny);
    }

    /// sqrt(2) times the facets' standard deviation along v, times the sine.
    Float spread(const Vector3f &v) const {
        namespace dr = drjit;
        auto [u, c] = wind_frame(v.x(), v.y());
        return dr::SqrtTwo<float> * dr::sqrt(dr::square(u * sigma_u) + dr::square(c * sigma_c));
    }

    /// cos F of the shadowing function, Eq. 66, for spread = sigma sin.
    Float hidden(const Float &cos, const Float &spread) const {
        namespace dr = drjit;
        Float s = dr::maximum(spread, Tiny), nu = cos / s, p = ierfc[5] * nu;
        for (int k = 4; k >= 0; --k)
            p = (p + ierfc[k]) * nu;
        Float p2 = dr::square(p + 1.f), p4 = p2 * p2;
        return .5f * dr::InvSqrtPi<float> * s / (p4 * p4);
    }

    /// Sine and cosine of an angle within a quarter turn of 0, to 5e-8.
    static std::pair<Float, Float> quarter_sincos(const Float &x) {
        namespace dr = drjit;
        Float z = x * x;
        Float s = dr::fmadd(dr::fmadd(dr::fmadd(2.60005462e-06f, z, -0.000198066151f), z, 0.00833301729f), z,
                            -0.166666571f);
        Float c = dr::fmadd(dr::fmadd(dr::fmadd(2.31943849e-05f, z, -0.00138559271f), z, 0.0416639894f), z,
                            -0.499999323f);
        return { dr::fmadd(x * z, s, x), dr::fmadd(z, c, 1.f) };
    }

    /// Sine and cosine of 2 pi u for u in [0, 1).
    static std::pair<Float, Float> turn_sincos(const Float &u) {
        namespace dr = drjit;
        Float w = u - .5f;
        auto [s, c] = quarter_sincos(dr::TwoPi<float> * (.25f - dr::abs(w)));
        return { dr::select(w < 0.f, c, -c), -s };
    }

    /// Tilt angle atan(sine/cosine) for a positive cosine; exact to first order, where the lobe is narrow.
    static Float angle(const Float &sine, const Float &cosine) {
        namespace dr = drjit;
        Float a = dr::abs(sine), x = dr::minimum(a, cosine) / dr::maximum(a, cosine), z = x * x;
        Float sum = -0.00482252874f;
        for (float c : { 0.0247340458f, -0.0602031086f, 0.099684718f, -0.140413274f, 0.19974214f, -0.333323916f })
            sum = dr::fmadd(sum, z, c);
        Float angle = dr::fmadd(x * z, sum, x);
        angle = dr::select(a > cosine, dr::Pi<float> * .5f - angle, angle);
        return dr::select(sine < 0.f, -angle, angle);
    }

    /// rho of Eq. 63.
    Float schlick(const Float &cos) const {
        namespace dr = drjit;
        Float m = dr::maximum(1.f - cos, 0.f), m2 = m * m;
        return dr::fmadd(1.f - normal_reflectance, m2 * m2 * m, normal_reflectance);
    }

    Float reflectance(const Float &cos) const {
        namespace dr = drjit;
        if (!exact)
            return schlick(cos);
        Float excess = ior2 - 1.f, g = dr::sqrt(dr::fmadd(cos, cos, excess)), s = cos + g,
              p = dr::fmadd(ior2, cos, g), rs = excess / (s * s),
              rp = excess * dr::fmsub(ior2 + 1.f, cos * cos, 1.f) / (p * p);
        return .5f * dr::fmadd(rs, rs, rp * rp);
    }

    /// Albedos, roughly, by which a lobe is chosen: of the facets and of both.
    std::pair<Float, Float> albedos(const Float &cos) const {
        Float facets = (1.f - whitecap_fraction) * (schlick(cos) + FacetAlbedoFloor);
        return { facets, facets + WhitecapAlbedo * whitecap_fraction };
    }
};

} // namespace prob_water
