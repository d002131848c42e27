/**
 * The closed form of the BRDF as Dr.Jit expressions: the twin of the Rust core's
 * brdf.rs and sampling.rs over the same coefficients, compared with it lane by lane in the tests.
 * Equation numbers are the report's; the names are the core's.
 */
#pragma once

#include <drjit/math.h>
#include <mitsuba/core/vector.h>

namespace prob_water {

/// The larger and the smaller of two numbers, the second where the first is none: one comparison, where
/// Dr.Jit's own take several to pass on what is not a number.
template <typename A, typename B> A larger(const A &a, const B &b) {
    A c(b);
    return drjit::select(a > c, a, c);
}
template <typename A, typename B> A smaller(const A &a, const B &b) {
    A c(b);
    return drjit::select(a < c, a, c);
}

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

    /// Tilts have digits to spare, whose rounding errors the Gaussian and the Gram-Charlier polynomial
    /// magnify a thousandfold; not on GPUs, most of which are slow in double precision.
    using Wide = std::conditional_t<drjit::is_cuda_v<Float>, Float, drjit::float64_array_t<Float>>;
    using WideScalar = drjit::scalar_t<Wide>;

    /// The smallest normal number, and one whose fourth power is normal: keep quotients finite.
    static constexpr float Tiny = 1.17549435e-38f, Small = 1e-9f;
    static constexpr float Largest = 3.40282347e+38f;
    /// As in the core's brdf.rs and sampling.rs.
    static constexpr float SteepFloor = 1e-6f, FacetAlbedoFloor = 0.01f, Grazing = 1e-12f;

    /// Numbers are data, so that a change does not compile new kernels; decisions are made while tracing.
    Wide cos_wind, sin_wind, inv_sigma_u, inv_sigma_c, ior2;
    Float sigma_u, sigma_c, scale, c21, c03, steep_gain, sigma_shadow,
        bound, proposal_u, proposal_c, inv_proposal_u, inv_proposal_c, proposal_norm, normal_reflectance,
        whitecap_fraction, whitecap_brdf;
    bool exact = false, slope_measure = false, gram_charlier = false, shadowing = false, bounded = false,
         as_printed = false;
    float ierfc[10] = {}, ierfc_end = 0;

    explicit Lobe(const Coefficients &c)
        : exact(c.exact), slope_measure(c.slope_measure), gram_charlier(c.gram_charlier), shadowing(c.shadowing),
          bounded(c.bounded), as_printed(c.as_printed) {
        for (int k = 0; k < 10; ++k)
            ierfc[k] = c.ierfc[k];
        ierfc_end = c.ierfc_end;
        auto data = [](float x) { return drjit::opaque<Float>(x); };
        auto wide = [](double x) { return drjit::opaque<Wide>((WideScalar) x); };
        cos_wind = wide(c.cos_wind);
        sin_wind = wide(c.sin_wind);
        inv_sigma_u = wide(1. / c.sigma_u);
        inv_sigma_c = wide(1. / c.sigma_c);
        sigma_u = data((float) c.sigma_u);
        sigma_c = data((float) c.sigma_c);
        scale = data(c.scale);
        c21 = data(c.c21);
        c03 = data(c.c03);
        steep_gain = data(c.steep_gain);
        sigma_shadow = data(c.sigma_shadow);
        bound = data(c.bound);
        proposal_u = data(c.proposal_u);
        proposal_c = data(c.proposal_c);
        inv_proposal_u = data(1.f / c.proposal_u);
        inv_proposal_c = data(1.f / c.proposal_c);
        proposal_norm = data(8.f * drjit::Pi<float> * c.proposal_u * c.proposal_c);
        normal_reflectance = data((float) c.normal_reflectance);
        ior2 = wide(c.ior2);
        whitecap_fraction = data(c.whitecap_fraction);
        whitecap_brdf = data(c.whitecap_brdf);
    }

    DRJIT_STRUCT(Lobe, cos_wind, sin_wind, sigma_u, sigma_c, inv_sigma_u, inv_sigma_c, scale, c21, c03, steep_gain,
                 sigma_shadow, bound, proposal_u, proposal_c, inv_proposal_u, inv_proposal_c, proposal_norm,
                 normal_reflectance, ior2, whitecap_fraction, whitecap_brdf)

    /// The wave normal with tangents along and across the wind; level where there are no waves.
    struct Frame {
        bool level = true;
        Vector3f u, c, n;
    };

    Frame frame(const Vector3f &n) const {
        namespace dr = drjit;
        Float cos_w(cos_wind), sin_w(sin_wind), along = dr::fmadd(cos_w, n.x(), sin_w * n.y());
        Vector3f u = dr::normalize(Vector3f(cos_w, sin_w, 0.f) - along * n);
        return { false, u, dr::cross(n, u), n };
    }

    /// Components along the wind, across it and along the normal.
    Vector3f to_local(const Frame &frame, const Vector3f &v) const {
        if (!frame.level)
            return { drjit::dot(frame.u, v), drjit::dot(frame.c, v), drjit::dot(frame.n, v) };
        auto [u, c] = wind_frame(v.x(), v.y());
        return { u, c, v.z() };
    }

    /// What the two directions fix, with tilts in numbers of type T.
    template <typename T> struct Geometry {
        Float cos_i, cos_o, cos_zeta;
        /// tan^2 xi and 1/cos^2 xi.
        Float tan2_xi, inv_cos2_xi;
        /// Slopes of the half vector along and across the wind.
        Float slope_u, slope_c;
        /// Tilts in the density's measure.
        T tilt_u, tilt_c;
        /// The source in the frame of the normal, and the horizontal parts of both as seen from the normal.
        Vector3f local_i;
        Point2f seen_i, seen_o;
        Mask lit;
        /// On a wave: what its area shown to the source is, over the level surface's.
        bool level = true;
        Float shown;
    };

    template <typename T> Geometry<T> geometry(const Vector3f &i, const Vector3f &o, const Frame &frame = {}) const {
        namespace dr = drjit;
        Geometry<T> g;
        g.local_i = to_local(frame, i);
        g.cos_zeta = smaller(.5f * dr::norm(i + o), 1.f);
        if (!frame.level) {
            tilted(g, i, o, frame);
            return g;
        }
        g.cos_i = i.z();
        g.cos_o = o.z();
        g.lit = g.cos_i > 0.f && g.cos_o > 0.f;
        g.seen_i = { i.x(), i.y() };
        g.seen_o = { o.x(), o.y() };

        T z = larger(T(i.z()) + T(o.z()), dr::scalar_t<T>(Small));
        auto [u, c] = wind_frame(T(i.x()) + T(o.x()), T(i.y()) + T(o.y()));
        Float hz(z);
        Float inv_hz = dr::rcp(hz);
        if (slope_measure) {
            g.tilt_u = quotient(u, z, inv_hz);
            g.tilt_c = quotient(c, z, inv_hz);
        } else {
            // Both quotients of min and max by one reciprocal.
            T abs_u = dr::abs(u), abs_c = dr::abs(c), most_u = larger(abs_u, z), most_c = larger(abs_c, z);
            Float m_u(most_u), m_c(most_c), inv = dr::rcp(m_u * m_c);
            g.tilt_u = angle(u, z, abs_u, most_u, Float(inv * m_c));
            g.tilt_c = angle(c, z, abs_c, most_c, Float(inv * m_u));
        }
        g.slope_u = Float(u) * inv_hz;
        g.slope_c = Float(c) * inv_hz;
        g.tan2_xi = dr::fmadd(g.slope_u, g.slope_u, g.slope_c * g.slope_c);
        g.inv_cos2_xi = 1.f + g.tan2_xi;
        return g;
    }

    /// f cos(theta_o), Eqs. 55-79, of some of its parts, each with its share of the surface; on a wave that of the level
    /// surface, as the core's on_wave.
    template <typename T> Float eval(const Geometry<T> &g, Parts parts) const {
        namespace dr = drjit;
        Float f = 0.f;
        if (parts.facets) {
            f = smaller(facets(g), Largest);
            if (parts.whitecaps)
                f = dr::fmadd(whitecap_fraction, whitecap_brdf - f, f);
            else
                f -= whitecap_fraction * f;
        } else if (parts.whitecaps) {
            f = whitecap_fraction * whitecap_brdf;
        }
        f *= g.cos_o;
        if (!g.level)
            f *= g.shown;
        return dr::select(g.lit, f, 0.f);
    }

    /// Density, 1/sr, with which sample() draws o.
    template <typename T> Float pdf(const Geometry<T> &g, Parts parts) const {
        namespace dr = drjit;
        if (!parts.facets)
            return dr::select(g.lit, g.cos_o * dr::InvPi<float>, 0.f);
        Proposal p = proposal(g.local_i);
        // Tilts of the proposal are slopes, or the angle from the normal with its azimuth.
        Float tilt_over_slope = 1.f, jacobian = dr::square(g.inv_cos2_xi);
        if (!slope_measure) {
            tilt_over_slope = atan_over(g.tan2_xi);
            jacobian = g.inv_cos2_xi * tilt_over_slope;
        }
        Float z_u = g.slope_u * inv_proposal_u, z_c = g.slope_c * inv_proposal_c,
              z2 = dr::square(tilt_over_slope) * dr::fmadd(z_u, z_u, z_c * z_c),
              slanted = dr::fmadd(g.slope_u, p.i_u, g.slope_c * p.i_c) * p.inv_cos,
              shown = larger(1.f + slanted, Small),
              beyond = dr::fmsub(slanted, tilt_over_slope, 1.f),
              gauss = dr::exp(-.5f * z2) * smaller(shown, 2.f),
              tail = dr::exp(smaller(dr::fmsub(dr::square(p.inv_d), beyond, .5f * z2), 0.f)) * beyond,
              pdf = (gauss + dr::select(beyond > 0.f, tail, 0.f)) * jacobian * p.inv_cos /
                    (proposal_norm * (1.f + p.tail) * shown);
        pdf = smaller(pdf, Largest);
        if (parts.whitecaps) {
            auto [facets, whitecaps] = albedos(g.cos_i);
            pdf = dr::fmadd(facets, pdf, whitecaps * g.cos_o * dr::InvPi<float>) /
                  larger(facets + whitecaps, Tiny);
        }
        return dr::select(g.lit, pdf, 0.f);
    }

    /// A direction, zero where the draw is lost, and whether it comes from the whitecaps.
    std::pair<Vector3f, Mask> sample(const Vector3f &i, Float u0, const Point2f &u, Parts parts,
                                     const Frame &frame = {}) const {
        namespace dr = drjit;
        if (!parts.facets) {
            auto [sin, cos] = turn_sincos(u.y());
            return { cosine(u.x(), sin, cos, frame), Mask(true) };
        }
        Vector3f l = to_local(frame, i);

        Mask whitecap = false;
        Float choice = u0;
        if (parts.whitecaps) {
            // u0 over the facets' share.
            auto [facets, whitecaps] = albedos(l.z());
            choice = u0 * (facets + whitecaps) / larger(facets, Tiny);
            whitecap = choice >= 1.f;
            choice = smaller(choice, 1.f);
        }

        Proposal p = proposal(l);
        Float scaled = choice * (1.f + p.tail);
        Mask in_tail = scaled < p.tail;
        Float rest = dr::select(in_tail, scaled / larger(p.tail, Tiny), scaled - p.tail);
        Mask turns = in_tail;
        if (parts.whitecaps)
            turns &= !whitecap;
        auto [sin, cos] = turn_sincos(dr::select(turns, rest, u.y()));

        // Box-Muller around the source's azimuth; in the tail r is Rayleigh beyond 1/D.
        Float root = dr::sqrt(radius2(u.x())), r = dr::select(in_tail, p.inv_d + root, root * cos),
              q = dr::select(in_tail, dr::sqrt(radius2(u.y())) * cos, root * sin);
        Mask level = p.inv_d > 1e15f;
        Float e_u = dr::select(level, 1.f, p.u * p.inv_d), e_c = dr::select(level, 0.f, p.c * p.inv_d),
              t_u = dr::fmsub(e_u, r, e_c * q) * proposal_u, t_c = dr::fmadd(e_c, r, e_u * q) * proposal_c;
        // The half vector of this tilt.
        Mask valid = true;
        Float tilt2 = dr::fmadd(t_u, t_u, t_c * t_c), sin_over, cos_xi;
        if (slope_measure) {
            sin_over = cos_xi = dr::rsqrt(1.f + tilt2);
        } else {
            valid = tilt2 < dr::square(dr::Pi<float> * .5f);
            std::tie(sin_over, cos_xi) = quarter_sincos(tilt2);
        }

        // Kept, or turned around, in proportion to what the two show the source.
        Float h_u = t_u * sin_over, h_c = t_c * sin_over,
              level_area = cos_xi * l.z(), slanted = dr::fmadd(h_u, p.i_u, h_c * p.i_c),
              a = larger(level_area + slanted, 0.f), b = larger(level_area - slanted, 0.f);
        Mask turn = !in_tail && rest * (a + b) < b;
        h_u = dr::select(turn, -h_u, h_u);
        h_c = dr::select(turn, -h_c, h_c);
        Vector3f h;
        if (frame.level) {
            Float cos_w(cos_wind), sin_w(sin_wind);
            h = Vector3f(dr::fmsub(h_u, cos_w, h_c * sin_w), dr::fmadd(h_u, sin_w, h_c * cos_w), cos_xi);
        } else {
            h = dr::fmadd(h_u, frame.u, dr::fmadd(h_c, frame.c, cos_xi * frame.n));
        }
        Vector3f o = dr::fmsub(Vector3f(2.f * dr::dot(i, h)), h, i);
        o = dr::select(valid, o, 0.f);
        if (parts.whitecaps)
            o = dr::select(whitecap, cosine(u.x(), sin, cos, frame), o);
        return { o, whitecap };
    }

private:
    template <typename> friend struct Afar;
    template <typename> friend struct Drawn;
    template <typename> friend struct Tabled;

    /// What the source fixes of the facets' proposal: its horizontal components, components of z that make rD,
    /// 1/cos theta_i, 1/D, D phi(1/D).
    struct Proposal {
        Float i_u, i_c, u, c, inv_cos, inv_d, tail;
    };

    /// For a source in the frame of the normal.
    Proposal proposal(const Vector3f &i) const {
        namespace dr = drjit;
        Proposal p;
        p.i_u = i.x();
        p.i_c = i.y();
        p.inv_cos = dr::rcp(larger(i.z(), Grazing));
        p.u = p.i_u * proposal_u * p.inv_cos;
        p.c = p.i_c * proposal_c * p.inv_cos;
        Float d2 = larger(dr::fmadd(p.u, p.u, p.c * p.c), Tiny);
        p.inv_d = dr::rsqrt(d2);
        p.tail = d2 * p.inv_d * dr::exp(-.5f * p.inv_d * p.inv_d) * 0.3989422804f;
        return p;
    }

    /// A direction about the normal, in proportion to its cosine.
    static Vector3f cosine(const Float &u, const Float &sin, const Float &cos, const Frame &frame) {
        namespace dr = drjit;
        Float r = dr::sqrt(u), x = r * cos, y = r * sin, z = dr::safe_sqrt(1.f - u);
        if (frame.level)
            return { x, y, z };
        // Tangents of a normal that points up, the identity for a level one.
        const Vector3f &n = frame.n;
        Float a = -dr::rcp(1.f + n.z()), b = n.x() * n.y() * a;
        Vector3f s(dr::fmadd(n.x() * n.x(), a, 1.f), b, -n.x()), t(b, dr::fmadd(n.y() * n.y(), a, 1.f), -n.y());
        return dr::fmadd(x, s, dr::fmadd(y, t, z * n));
    }

    /// The geometry about a wave normal: alpha_u(H) - alpha_u(N) as one angle, as in the core.
    template <typename T>
    void tilted(Geometry<T> &g, const Vector3f &i, const Vector3f &o, const Frame &frame) const {
        namespace dr = drjit;
        using S = dr::scalar_t<T>;
        const Vector3f &n = frame.n;
        g.cos_i = g.local_i.z();
        g.cos_o = dr::dot(o, n);
        g.lit = g.cos_i > 0.f && g.cos_o > 0.f && i.z() > 0.f && o.z() > 0.f;
        g.level = false;
        g.shown = g.cos_i / larger(n.z() * i.z(), Tiny);
        g.seen_i = { dr::fmsub(i.x(), n.z(), i.z() * n.x()), dr::fmsub(i.y(), n.z(), i.z() * n.y()) };
        g.seen_o = { dr::fmsub(o.x(), n.z(), o.z() * n.x()), dr::fmsub(o.y(), n.z(), o.z() * n.y()) };

        T hx = T(i.x()) + T(o.x()), hy = T(i.y()) + T(o.y()), hz = T(i.z()) + T(o.z()), nx(n.x()), ny(n.y()), nz(n.z());
        auto [h_u, h_c] = wind_frame(hx, hy);
        auto [n_u, n_c] = wind_frame(nx, ny);
        auto [x_u, x_c] = wind_frame(T(hx * nz - hz * nx), T(hy * nz - hz * ny));
        auto measure = [&](const T &sine, const T &cosine) {
            if (slope_measure)
                return T(dr::select(cosine > S(0), sine / larger(cosine, S(Tiny)), S(1e6)));
            return T(dr::atan2(sine, cosine));
        };
        g.tilt_u = measure(x_u, dr::fmadd(h_u, n_u, hz * nz));
        g.tilt_c = measure(x_c, dr::fmadd(h_c, n_c, hz * nz));

        Vector3f h = to_local(frame, i + o);
        Float inv_h = dr::rcp(larger(h.z(), Small));
        g.slope_u = h.x() * inv_h;
        g.slope_c = h.y() * inv_h;
        g.tan2_xi = dr::fmadd(g.slope_u, g.slope_u, g.slope_c * g.slope_c);
        g.inv_cos2_xi = 1.f + g.tan2_xi;
    }

    static Float radius2(const Float &u) {
        namespace dr = drjit;
        return larger(-2.f * dr::log(larger(1.f - u, Tiny)), 0.f);
    }

    /// Components along W_u and W_c (Eq. 68).
    template <typename T> std::pair<T, T> wind_frame(const T &x, const T &y) const {
        namespace dr = drjit;
        T cos(cos_wind), sin(sin_wind);
        return { dr::fmadd(x, cos, y * sin), dr::fmsub(y, cos, x * sin) };
    }

    /// f_SW, Eq. 56.
    template <typename T> Float facets(const Geometry<T> &g) const {
        namespace dr = drjit;
        // p/cos^4 xi (Eqs. 72-73, 78-79).
        using S = dr::scalar_t<T>;
        T wide_u = -g.tilt_u * T(inv_sigma_u), wide_c = g.tilt_c * T(inv_sigma_c),
          wide_u2 = wide_u * wide_u, wide_c2 = wide_c * wide_c,
          exponent = larger((wide_u2 + wide_c2) * S(-.5 / dr::LogTwo<double>), S(-1e4));
        // Beyond 1000 sigma the density is 0 and its polynomial must not overflow.
        Float u = larger(smaller(Float(wide_u), 1e3f), -1e3f), c = larger(smaller(Float(wide_c), 1e3f), -1e3f),
              u2 = smaller(Float(wide_u2), 1e6f), c2 = smaller(Float(wide_c2), 1e6f);
        if (as_printed) {
            u = dr::abs(u);
            c = dr::abs(c);
        }
        // The power of two by its exponent's leading digits, then by the rest.
        Float leading(exponent), p = dr::exp2(leading);
        if constexpr (!std::is_same_v<T, Float>)
            p = dr::fmadd(p, Float(exponent - T(leading)) * dr::LogTwo<float>, p);
        Float gauss = p, inv_cos4 = dr::square(g.inv_cos2_xi);
        p *= inv_cos4;
        if (!slope_measure && !as_printed)
            p = dr::select(inv_cos4 > steep_gain, smaller(p, larger(gauss * steep_gain, SteepFloor)), p);
        if (gram_charlier) {
            Float c3 = as_printed ? Float(c2 - 1.f) : Float((c2 - 1.f) * u);
            Float k = dr::fmadd(-.5f * c21, c3, 1.f);
            k = dr::fmadd(c03 * (-1.f / 6.f) * u, u2 - 3.f, k);
            k = dr::fmadd(.40f / 24.f, dr::fmadd(c2, c2 - 6.f, 3.f), k);
            k = dr::fmadd((.12f / 4.f) * (c2 - 1.f), u2 - 1.f, k);
            k = dr::fmadd(.23f / 24.f, dr::fmadd(u2, u2 - 6.f, 3.f), k);
            p *= larger(k, 0.f);
        }

        // Eqs. 61-67, at least what the facets themselves hide where the bound is in force.
        Float rho = reflectance<T>(g.cos_zeta);
        auto [area, over] = unshadowed(rho, g.cos_i, g.cos_o, [&] { return std::pair(spread(g.seen_i), spread(g.seen_o)); });
        return p * (rho * scale * over) / larger(area, Tiny);
    }

    /// cos theta_i cos theta_r/G as a quotient area/over; `spreads` gives the facets' along the two directions.
    template <typename Spreads>
    std::pair<Float, Float> unshadowed(const Float &rho, const Float &cos_i, const Float &cos_o, Spreads spreads) const {
        namespace dr = drjit;
        Float area = cos_i * cos_o, over = 1.f;
        if (shadowing) {
            auto [h_i, h_o] = hidden(cos_i, sigma_shadow * sine(cos_i), cos_o, sigma_shadow * sine(cos_o));
            over = h_i.over * h_o.over;
            area = dr::fmadd(area, over, dr::fmadd(cos_o * h_i.area, h_o.over, cos_i * h_o.area * h_i.over));
        }
        if (bounded) {
            auto [s_i, s_o] = spreads();
            auto [h_i, h_o] = hidden(cos_i, s_i, cos_o, s_o);
            Float v_i = cos_i + h_i.area / h_i.over, v_o = cos_o + h_o.area / h_o.over;
            area = larger(area, over * rho / bound * larger(v_i * cos_o, v_o * cos_i));
        }
        return { area, over };
    }

    static Float sine(const Float &cos) {
        namespace dr = drjit;
        return dr::safe_sqrt(dr::fnmadd(cos, cos, 1.f));
    }

    /// sqrt(2) times the facets' standard deviation along v, times the sine.
    Float spread(const Point2f &v) const {
        namespace dr = drjit;
        auto [u, c] = wind_frame(v.x(), v.y());
        return dr::SqrtTwo<float> * dr::sqrt(dr::square(u * sigma_u) + dr::square(c * sigma_c));
    }

    /// cos F of the shadowing function, Eq. 66, as a quotient area/over.
    struct Hidden {
        Float area, over;
    };

    /// The same of two directions, for spread = sigma sin, by one reciprocal.
    std::pair<Hidden, Hidden> hidden(const Float &cos_i, Float s_i, const Float &cos_o, Float s_o) const {
        namespace dr = drjit;
        s_i = larger(s_i, Small);
        s_o = larger(s_o, Small);
        Float inv = dr::rcp(s_i * s_o);
        return { hidden(cos_i * s_o * inv, s_i), hidden(cos_o * s_i * inv, s_o) };
    }

    /// The same of nu = cos/spread; beyond 3.6 it is below 1e-8, and `over` must leave room for its square in
    /// derivatives.
    Hidden hidden(const Float &nu, const Float &spread) const {
        namespace dr = drjit;
        Float x = smaller(nu, 3.6f), p = ierfc[6] * x;
        for (int k = 5; k >= 0; --k)
            p = (p + ierfc[k]) * x;
        Float p2 = dr::square(p + 1.f), p4 = p2 * p2;
        return { .5f * dr::InvSqrtPi<float> * spread, p4 * p4 };
    }

    /// sin(x)/x and cos(x), to 5e-8, of x^2 up to a quarter turn's.
    static std::pair<Float, Float> quarter_sincos(const Float &x2) {
        namespace dr = drjit;
        Float s = dr::fmadd(dr::fmadd(dr::fmadd(2.60005462e-06f, x2, -0.000198066151f), x2, 0.00833301729f), x2,
                            -0.166666571f);
        Float c = dr::fmadd(dr::fmadd(dr::fmadd(2.31943849e-05f, x2, -0.00138559271f), x2, 0.0416639894f), x2,
                            -0.499999323f);
        return { dr::fmadd(x2, s, 1.f), dr::fmadd(x2, c, 1.f) };
    }

    /// Sine and cosine of 2 pi u for u in [0, 1).
    static std::pair<Float, Float> turn_sincos(const Float &u) {
        namespace dr = drjit;
        Float w = u - .5f, x = dr::TwoPi<float> * (.25f - dr::abs(w));
        auto [s, c] = quarter_sincos(x * x);
        return { dr::select(w < 0.f, c, -c), -x * s };
    }

    /// What atan(x)/x adds to 1, over x^2, for x^2 in [0, 1]: relative error of atan 3e-9.
    static Float atan_rest(const Float &x2) {
        namespace dr = drjit;
        Float sum = -0.00179362171f;
        for (float c : { 0.0109146062f, -0.0311778476f, 0.0579575963f, -0.0840345055f, 0.109521859f, -0.142642417f,
                         0.199985483f, -0.333332991f })
            sum = dr::fmadd(sum, x2, c);
        return sum;
    }

    /// atan(t)/t of t^2.
    static Float atan_over(const Float &t2) {
        namespace dr = drjit;
        Float inv_t = dr::rsqrt(larger(t2, Tiny));
        Mask steep = t2 > 1.f;
        Float x2 = dr::select(steep, dr::square(inv_t), t2), over = dr::fmadd(x2, atan_rest(x2), 1.f);
        return dr::select(steep, dr::fmsub(dr::Pi<float> * .5f, inv_t, over * x2), over);
    }

    /// a/b from 1/b in Float, with the digits of T.
    template <typename T> static T quotient(const T &a, const T &b, const Float &inv_b) {
        namespace dr = drjit;
        Float leading = Float(a) * inv_b;
        if constexpr (std::is_same_v<T, Float>)
            return leading;
        else
            return T(leading) + T(Float(dr::fnmadd(T(leading), b, a)) * inv_b);
    }

    /// Tilt angle atan(sine/cosine) for a positive cosine, given |sine|, the larger of it and the cosine, and
    /// that one's reciprocal: the quotient in T, what atan adds to it in Float.
    template <typename T>
    static T angle(const T &sine, const T &cosine, const T &abs_sine, const T &most, const Float &inv_most) {
        namespace dr = drjit;
        using S = dr::scalar_t<T>;
        T x = quotient(T(smaller(abs_sine, cosine)), most, inv_most);
        Float t(x), t2 = t * t;
        T angle = x + T(t * t2 * atan_rest(t2));
        angle = dr::select(abs_sine > cosine, S(.5 * dr::Pi<double>) - angle, angle);
        return dr::select(sine < S(0), -angle, angle);
    }

    /// rho of Eq. 63.
    Float schlick(const Float &cos) const {
        namespace dr = drjit;
        Float m = larger(1.f - cos, 0.f), m2 = m * m;
        return dr::fmadd(1.f - normal_reflectance, m2 * m2 * m, normal_reflectance);
    }

public:
    /// rho of Schlick or of Fresnel's equations, to the digits of T.
    template <typename T = Float> Float reflectance(const Float &cos_zeta) const {
        namespace dr = drjit;
        if (!exact)
            return schlick(cos_zeta);
        using S = dr::scalar_t<T>;
        T cos(cos_zeta), n2(ior2), excess = n2 - S(1), g = dr::sqrt(dr::fmadd(cos, cos, excess)), s = cos + g,
            p = dr::fmadd(n2, cos, g), rs = excess / larger(s * s, S(Tiny)),
            rp = excess * dr::fmsub(n2 + S(1), cos * cos, T(S(1))) / larger(p * p, S(Tiny));
        return Float(S(.5) * dr::fmadd(rs, rs, rp * rp));
    }

private:
    /// Albedos, roughly, by which a lobe is chosen: of the facets and of the whitecaps.
    std::pair<Float, Float> albedos(const Float &cos) const {
        Float facets = (1.f - whitecap_fraction) * (schlick(cos) + FacetAlbedoFloor);
        return { facets, drjit::Pi<float> * whitecap_brdf * whitecap_fraction };
    }
};

} // namespace prob_water
