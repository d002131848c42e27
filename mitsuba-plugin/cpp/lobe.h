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
    template <typename T> using Pair = std::array<T, 2>;

    /// Smallest normal number: keeps quotients finite.
    static constexpr float Tiny = 1.17549435e-38f;
    static constexpr float Largest = 3.40282347e+38f;
    /// As in the core's sampling.rs.
    static constexpr float WhitecapAlbedo = 0.22f, FacetAlbedoFloor = 0.01f, Grazing = 1e-12f;

    /// Numbers are data, so that a change does not compile new kernels; decisions are made while tracing.
    Float cos_wind, sin_wind, sigma_u, sigma_c, scale, c21, c03, steep_cos, steep_bound, sigma_shadow,
        bound, proposal_u, proposal_c, normal_reflectance, ior2, whitecap_fraction, whitecap_brdf;
    bool exact = false, slope_measure = false, gram_charlier = false, shadowing = false, bounded = false,
         as_printed = false;
    float ierfc[7] = {}, ierfc_scale = 0.f, ierfc_end = 0.f;

    explicit Lobe(const Coefficients &c)
        : exact(c.exact), slope_measure(c.slope_measure), gram_charlier(c.gram_charlier), shadowing(c.shadowing),
          bounded(c.bounded), as_printed(c.as_printed), ierfc_scale(c.ierfc_scale), ierfc_end(c.ierfc_end) {
        for (int k = 0; k < 7; ++k)
            ierfc[k] = c.ierfc[k];
        auto data = [](float x) { return drjit::opaque<Float>(x); };
        cos_wind = data(c.cos_wind);
        sin_wind = data(c.sin_wind);
        sigma_u = data(c.sigma_u);
        sigma_c = data(c.sigma_c);
        scale = data(c.scale);
        c21 = data(c.c21);
        c03 = data(c.c03);
        steep_cos = data(c.steep_cos);
        steep_bound = data(c.steep_bound);
        sigma_shadow = data(c.sigma_shadow);
        bound = data(c.bound);
        proposal_u = data(c.proposal_u);
        proposal_c = data(c.proposal_c);
        normal_reflectance = data(c.normal_reflectance);
        ior2 = data(c.ior2);
        whitecap_fraction = data(c.whitecap_fraction);
        whitecap_brdf = data(c.whitecap_brdf);
    }

    DRJIT_STRUCT(Lobe, cos_wind, sin_wind, sigma_u, sigma_c, scale, c21, c03, steep_cos, steep_bound,
                       sigma_shadow, bound, proposal_u, proposal_c, normal_reflectance, ior2, whitecap_fraction,
                       whitecap_brdf)

    /// What the two directions fix, however the water is.
    struct Geometry {
        Float cos_i, cos_o, cos_zeta, cos_xi;
        /// Slopes of the half vector along and across the wind.
        Float slope_u, slope_c;
        /// The same in the density's measure.
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
        Float length = dr::maximum(dr::norm(h), Tiny), hz = dr::maximum(h.z(), Tiny);
        g.cos_zeta = dr::minimum(.5f * length, 1.f);
        g.cos_xi = hz / length;
        Pair<Float> s = wind_frame(h.x(), h.y());
        Float inv_hz = 1.f / hz;
        g.slope_u = s[0] * inv_hz;
        g.slope_c = s[1] * inv_hz;
        g.tilt_u = slope_measure ? g.slope_u : Float(dr::atan(g.slope_u));
        g.tilt_c = slope_measure ? g.slope_c : Float(dr::atan(g.slope_c));
        return g;
    }

    /// f cos(theta_o), Eqs. 55-79, of some of its parts, each with its share of the surface.
    Float eval(const Geometry &g, const Vector3f &i, const Vector3f &o, Parts parts) const {
        namespace dr = drjit;
        Float f = 0.f;
        if (parts.facets) {
            f = dr::minimum(density(g) * visible_reflectance(g, i, o), Largest);
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
        Float z_u = g.tilt_u / proposal_u, z_c = g.tilt_c / proposal_c,
              towards = dr::fmadd(z_u, p.u, z_c * p.c),
              shown = g.cos_zeta / (g.cos_xi * dr::maximum(g.cos_i, Grazing)),
              shape = dr::minimum(shown, 2.f) + dr::select(towards > 1.f, towards, 0.f),
              gauss = dr::exp(-.5f * dr::fmadd(z_u, z_u, z_c * z_c)),
              jacobian = g.cos_xi * g.cos_xi * g.cos_xi;
        if (!slope_measure)
            jacobian *= dr::fmadd(g.slope_u, g.slope_u, 1.f) * dr::fmadd(g.slope_c, g.slope_c, 1.f);
        Float norm = (1.f + p.tail) * dr::TwoPi<float> * proposal_u * proposal_c;
        Float pdf = dr::minimum(gauss * shape / (norm * dr::maximum(4.f * g.cos_zeta * jacobian, Tiny)), Largest);
        if (parts.whitecaps) {
            Float share = facet_share(g.cos_i);
            pdf = dr::fmadd(share, pdf, (1.f - share) * g.cos_o * dr::InvPi<float>);
        }
        return dr::select(g.lit, pdf, 0.f);
    }

    /// A direction, zero where the draw is lost, and whether it comes from the whitecaps.
    std::pair<Vector3f, Mask> sample(const Vector3f &i, Float u0, const Point2f &u, Parts parts) const {
        namespace dr = drjit;
        auto [sin, cos] = dr::sincos(dr::TwoPi<float> * u.y());
        Vector3f cosine = Vector3f(dr::sqrt(u.x()) * cos, dr::sqrt(u.x()) * sin, dr::safe_sqrt(1.f - u.x()));
        if (!parts.facets)
            return { cosine, Mask(true) };

        Mask whitecap = false;
        Float choice = u0;
        if (parts.whitecaps) {
            Float share = facet_share(i.z());
            whitecap = !(u0 < share);
            choice = dr::minimum(u0 / dr::maximum(share, Tiny), 1.f);
        }

        Proposal p = proposal(i);
        Float p_tail = p.tail / (1.f + p.tail);
        Mask in_tail = choice < p_tail;
        Float rest = dr::select(in_tail, choice / dr::maximum(p_tail, Tiny), (choice - p_tail) / (1.f - p_tail));

        // Box-Muller around the source's azimuth; in the tail r is Rayleigh beyond 1/D.
        Float first = radius2(u.x()), d = dr::maximum(p.d, Tiny);
        auto [sin_t, cos_t] = dr::sincos(dr::TwoPi<float> * rest);
        Float root = dr::sqrt(first),
              r = dr::select(in_tail, dr::sqrt(first + 1.f / (d * d)), root * cos),
              q = dr::select(in_tail, dr::sqrt(radius2(u.y())) * cos_t, root * sin);
        Mask level = p.d < 1e-18f;
        Float e_u = dr::select(level, 1.f, p.u / d), e_c = dr::select(level, 0.f, p.c / d),
              t_u = dr::fmsub(e_u, r, e_c * q) * proposal_u, t_c = dr::fmadd(e_c, r, e_u * q) * proposal_c;
        Mask valid = true;
        if (!slope_measure) {
            valid = dr::abs(t_u) < dr::Pi<float> * .5f && dr::abs(t_c) < dr::Pi<float> * .5f;
            t_u = dr::tan(t_u);
            t_c = dr::tan(t_c);
        }

        // The tilt or its opposite, in proportion to what they show the source.
        Pair<Float> wi = wind_frame(i.x(), i.y());
        Float x = dr::fmadd(t_u, wi[0], t_c * wi[1]),
              a = dr::maximum(i.z() + x, 0.f), b = dr::maximum(i.z() - x, 0.f);
        Mask turn = !in_tail && rest * (a + b) < b;
        t_u = dr::select(turn, -t_u, t_u);
        t_c = dr::select(turn, -t_c, t_c);
        Float c = dr::rsqrt(1.f + dr::fmadd(t_u, t_u, t_c * t_c));
        Vector3f h(dr::fmsub(t_u, cos_wind, t_c * sin_wind) * c, dr::fmadd(t_u, sin_wind, t_c * cos_wind) * c, c);
        Vector3f o = dr::fmsub(Vector3f(2.f * dr::dot(i, h)), h, i);
        o = dr::select(valid, o, 0.f);
        if (parts.whitecaps)
            o = dr::select(whitecap, cosine, o);
        return { o, whitecap };
    }

private:
    /// What the source fixes of the facets' proposal.
    struct Proposal {
        Float u, c, d, tail;
    };

    Proposal proposal(const Vector3f &i) const {
        namespace dr = drjit;
        Pair<Float> w = wind_frame(i.x(), i.y());
        Float inv = 1.f / dr::maximum(i.z(), Grazing);
        Proposal p;
        p.u = w[0] * proposal_u * inv;
        p.c = w[1] * proposal_c * inv;
        Float d2 = dr::fmadd(p.u, p.u, p.c * p.c);
        p.d = dr::sqrt(d2);
        p.tail = p.d * dr::exp(-.5f / dr::maximum(d2, Tiny)) * 0.3989422804f;
        return p;
    }

    static Float radius2(const Float &u) {
        namespace dr = drjit;
        return dr::maximum(-2.f * dr::log(dr::maximum(1.f - u, Tiny)), 0.f);
    }

    /// Components along W_u and W_c (Eq. 68).
    Pair<Float> wind_frame(const Float &x, const Float &y) const {
        namespace dr = drjit;
        return { dr::fmadd(x, cos_wind, y * sin_wind), dr::fmsub(y, cos_wind, x * sin_wind) };
    }

    /// p/cos^4 xi with the constants of Eq. 56 (Eqs. 72-73, 78-79).
    Float density(const Geometry &g) const {
        namespace dr = drjit;
        Float u = dr::clip(-g.tilt_u / sigma_u, -1e3f, 1e3f), c = dr::clip(g.tilt_c / sigma_c, -1e3f, 1e3f);
        if (as_printed) {
            u = dr::abs(u);
            c = dr::abs(c);
        }
        Float u2 = u * u, c2 = c * c, cos2 = g.cos_xi * g.cos_xi;
        Float p = dr::exp(-.5f * (u2 + c2)) / dr::maximum(cos2 * cos2, Tiny);
        if (!slope_measure && !as_printed)
            p = dr::select(g.cos_xi < steep_cos, dr::minimum(p, steep_bound), p);
        if (gram_charlier) {
            Float skew_c = as_printed ? c2 - 1.f : (c2 - 1.f) * u;
            Float k = 1.f - .5f * c21 * skew_c - (1.f / 6.f) * c03 * u * (u2 - 3.f)
                    + (.40f / 24.f) * dr::fmadd(c2, c2 - 6.f, 3.f) + (.12f / 4.f) * (c2 - 1.f) * (u2 - 1.f)
                    + (.23f / 24.f) * dr::fmadd(u2, u2 - 6.f, 3.f);
            p *= dr::maximum(k, 0.f);
        }
        return p * scale;
    }

    /// rho G/(cos theta_i cos theta_r) (Eqs. 61-67).
    Float visible_reflectance(const Geometry &g, const Vector3f &i, const Vector3f &o) const {
        namespace dr = drjit;
        Float area = g.cos_i * g.cos_o;
        if (shadowing) {
            Float s_i = sigma_shadow * dr::safe_sqrt(dr::fnmadd(g.cos_i, g.cos_i, 1.f)),
                  s_o = sigma_shadow * dr::safe_sqrt(dr::fnmadd(g.cos_o, g.cos_o, 1.f));
            area += dr::fmadd(g.cos_o, hidden(g.cos_i, s_i), g.cos_i * hidden(g.cos_o, s_o));
        }
        Float value = reflectance(g.cos_zeta) / dr::maximum(area, Tiny);
        if (bounded) {
            Float v_i = g.cos_i + hidden(g.cos_i, spread(i)), v_o = g.cos_o + hidden(g.cos_o, spread(o));
            value = dr::minimum(value, bound / dr::maximum(dr::maximum(v_i * g.cos_o, v_o * g.cos_i), Tiny));
        }
        return value;
    }

    /// sqrt(2) times the facets' standard deviation along v, times the sine.
    Float spread(const Vector3f &v) const {
        namespace dr = drjit;
        Pair<Float> w = wind_frame(v.x(), v.y());
        return dr::SqrtTwo<float> * dr::sqrt(dr::square(w[0] * sigma_u) + dr::square(w[1] * sigma_c));
    }

    /// cos F of the shadowing function, Eq. 66, for spread = sigma sin.
    Float hidden(const Float &cos, const Float &spread) const {
        namespace dr = drjit;
        Float nu = dr::minimum(cos / dr::maximum(spread, Tiny), ierfc_end), t = 1.f / dr::fmadd(nu, ierfc_scale, 1.f);
        Float sum = ierfc[6];
        for (int k = 5; k >= 0; --k)
            sum = dr::fmadd(sum, t, ierfc[k]);
        return .5f * spread * dr::exp(-nu * nu) * sum;
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

    /// Probability of drawing from the facets.
    Float facet_share(const Float &cos) const {
        Float facets = (1.f - whitecap_fraction) * (schlick(cos) + FacetAlbedoFloor);
        return facets / (facets + WhitecapAlbedo * whitecap_fraction);
    }
};

} // namespace prob_water
