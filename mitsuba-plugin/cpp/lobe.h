/**
 * The closed form of the BRDF as Dr.Jit expressions: the twin of the Rust core's
 * brdf.rs and sampling.rs over the same coefficients, compared with it lane by lane in the tests.
 * Equation numbers are the report's; the names are the core's.
 */
#pragma once

#include <algorithm>
#include <cmath>
#include "replay.h"
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

template <typename Float_> struct Lobe {
    using Float = Float_;
    using Mask = drjit::mask_t<Float>;
    using Vector3f = mitsuba::Vector<Float, 3>;
    using Point2f = mitsuba::Point<Float, 2>;

    /// hi + lo: a number and what rounding took from it, itself to some digits only. Tilts need it, whose rounding errors
    /// the Gaussian and the Gram-Charlier polynomial magnify a thousandfold. lo has no derivative; where a function is not
    /// Fine it has no value either.
    struct Pair {
        Float hi, lo;
    };

    /// The smallest normal number, and one whose fourth power is normal: keep quotients finite.
    static constexpr float Tiny = 1.17549435e-38f, Small = 1e-9f;
    static constexpr float Largest = 3.40282347e+38f;
    /// 1/sqrt(2 ln 2).
    static constexpr double InvWidth = .84932180028801904272;
    /// log2(e)/2, and the steepest slope told from others.
    static constexpr float HalfLog2e = .721347520f, Steepest = 1e5f;
    /// As in the core's brdf.rs and sampling.rs.
    static constexpr float SteepFloor = 1e-6f, FacetAlbedoFloor = 0.01f, Grazing = 1e-12f;

    /// Numbers are data, so that a change does not compile new kernels; decisions are made while tracing.
    Float cos_wind, sin_wind, cos_wind_lo, sin_wind_lo;
    /// 1/(sigma sqrt(2 ln 2)): tilts in these units make the Gaussian a power of two.
    Float inv_width_u, inv_width_c, inv_width_u_lo, inv_width_c_lo;
    /// What multiplies the tilt in Eq. 78, with its square along and across the wind; as printed also without the tilt.
    Float skew, skew_u2, skew_c2, printed, printed_c2;
    Float sigma_u, sigma_c, scale, steep_gain, sigma_shadow,
        bound, proposal_u, proposal_c, inv_proposal_u, inv_proposal_c, proposal_norm, normal_reflectance, excess,
        whitecap_fraction, smooth_fraction, whitecap_brdf;
    bool exact = false, slope_measure = false, gram_charlier = false, shadowing = false, bounded = false,
         as_printed = false;
    /// Quarter turns of a wind along an axis, which tilts need not be turned by with care; 4 for another.
    int quarters = 4;
    float ierfc[10] = {}, ierfc_end = 0;

    explicit Lobe(const Coefficients &c)
        : exact(c.exact), slope_measure(c.slope_measure), gram_charlier(c.gram_charlier), shadowing(c.shadowing),
          bounded(c.bounded), as_printed(c.as_printed) {
        std::copy(std::begin(c.ierfc), std::end(c.ierfc), ierfc);
        ierfc_end = c.ierfc_end;
        auto data = [](double x) { return drjit::opaque<Float>((float) x); };
        auto rest = [&](double x) { return data(x - (float) x); };
        cos_wind = data(c.cos_wind);
        sin_wind = data(c.sin_wind);
        cos_wind_lo = rest(c.cos_wind);
        sin_wind_lo = rest(c.sin_wind);
        const double along[4][2] = { { 1., 0. }, { 0., 1. }, { -1., 0. }, { 0., -1. } };
        for (int k = 0; k < 4; ++k)
            if (std::abs(c.cos_wind - along[k][0]) + std::abs(c.sin_wind - along[k][1]) < 1e-14)
                quarters = k;
        inv_width_u = data(InvWidth / c.sigma_u);
        inv_width_c = data(InvWidth / c.sigma_c);
        inv_width_u_lo = rest(InvWidth / c.sigma_u);
        inv_width_c_lo = rest(InvWidth / c.sigma_c);
        // U rises towards upwind, against the tilt.
        constexpr double W = 1. / InvWidth, W2 = W * W;
        double c21 = c.as_printed ? 0. : c.c21;
        skew = data(-.5 * (c21 + c.c03) * W);
        skew_u2 = data(c.c03 / 6. * W2 * W);
        skew_c2 = data(.5 * c21 * W2 * W);
        printed = data(.5 * c.c21);
        printed_c2 = data(-.5 * c.c21 * W2);
        sigma_u = data(c.sigma_u);
        sigma_c = data(c.sigma_c);
        scale = data(c.scale);
        steep_gain = data(c.steep_gain);
        sigma_shadow = data(c.sigma_shadow);
        bound = data(c.bound);
        proposal_u = data(c.proposal_u);
        proposal_c = data(c.proposal_c);
        inv_proposal_u = data(1. / c.proposal_u);
        inv_proposal_c = data(1. / c.proposal_c);
        proposal_norm = data(8. * drjit::Pi<double> * c.proposal_u * c.proposal_c);
        normal_reflectance = data(c.normal_reflectance);
        excess = data(c.excess);
        whitecap_fraction = data(c.whitecap_fraction);
        smooth_fraction = data(c.smooth_fraction);
        whitecap_brdf = data(c.whitecap_brdf);
    }

    DRJIT_STRUCT(Lobe, cos_wind, sin_wind, cos_wind_lo, sin_wind_lo, inv_width_u, inv_width_c, inv_width_u_lo,
                 inv_width_c_lo, skew, skew_u2, skew_c2, printed, printed_c2, sigma_u, sigma_c, scale, steep_gain,
                 sigma_shadow, bound, proposal_u, proposal_c, inv_proposal_u, inv_proposal_c, proposal_norm,
                 normal_reflectance, excess, whitecap_fraction, smooth_fraction, whitecap_brdf)

    bool oblique() const { return quarters == 4; }

    /// The share of whitecaps at a place.
    void set_whitecaps(const Float &fraction) {
        whitecap_fraction = fraction;
        smooth_fraction = 1.f - fraction;
    }

    /// The wave normal with tangents along and across the wind; level where there are no waves.
    struct Frame {
        bool level = true;
        Vector3f u, c, n;
    };

    Frame frame(const Vector3f &n) const {
        namespace dr = drjit;
        Float along = dr::fmadd(cos_wind, n.x(), sin_wind * n.y());
        Vector3f u = dr::normalize(Vector3f(cos_wind, sin_wind, 0.f) - along * n);
        return { false, u, dr::cross(n, u), n };
    }

    /// Components along the wind, across it and along the normal.
    Vector3f to_local(const Frame &frame, const Vector3f &v) const {
        if (!frame.level)
            return { drjit::dot(frame.u, v), drjit::dot(frame.c, v), drjit::dot(frame.n, v) };
        auto [u, c] = wind_frame(v.x(), v.y());
        return { u, c, v.z() };
    }

    /// What the two directions fix.
    struct Geometry {
        Float cos_i, cos_o, cos_zeta;
        /// tan^2 xi and 1/cos^2 xi.
        Float tan2_xi, inv_cos2_xi;
        /// Slopes of the half vector along and across the wind.
        Float slope_u, slope_c;
        /// Tilts in the density's measure.
        Pair tilt_u, tilt_c;
        /// The source in the frame of the normal, and the horizontal parts of both as seen from the normal.
        Vector3f local_i;
        Point2f seen_i, seen_o;
        Mask lit;
        /// On a wave: what its area shown to the source is, over the level surface's.
        bool level = true;
        Float shown;
    };

    template <bool Fine> Geometry geometry(const Vector3f &i, const Vector3f &o, const Frame &frame = {}) const {
        namespace dr = drjit;
        Geometry g;
        g.local_i = to_local(frame, i);
        if (!frame.level) {
            tilted<Fine>(g, i, o, frame);
            return g;
        }
        g.cos_i = i.z();
        g.cos_o = o.z();
        g.lit = g.cos_i > 0.f && g.cos_o > 0.f;
        g.seen_i = { i.x(), i.y() };
        g.seen_o = { o.x(), o.y() };

        Pair x = sum<Fine>(i.x(), o.x()), y = sum<Fine>(i.y(), o.y()), z = sum<Fine>(i.z(), o.z());
        auto [u, c] = wind_frame<Fine>(x, y);
        Float flat2 = dr::fmadd(x.hi, x.hi, y.hi * y.hi);
        g.cos_zeta = smaller(.5f * dr::sqrt(dr::fmadd(z.hi, z.hi, flat2)), 1.f);
        z.hi = larger(z.hi, Small);
        Float inv_z = dr::rcp(z.hi);
        g.tilt_u = slope_measure ? tangent<Fine>(u, z, inv_z) : angle<Fine>(u, z);
        g.tilt_c = slope_measure ? tangent<Fine>(c, z, inv_z) : angle<Fine>(c, z);
        g.slope_u = u.hi * inv_z;
        g.slope_c = c.hi * inv_z;
        g.tan2_xi = flat2 / dr::square(z.hi);
        g.inv_cos2_xi = 1.f + g.tan2_xi;
        return g;
    }

    /// f cos(theta_o), Eqs. 55-79, of some of its parts, each with its share of the surface; on a wave that of the level
    /// surface, as the core's on_wave.
    template <bool Fine> Float eval(const Geometry &g, Parts parts) const {
        namespace dr = drjit;
        Float f = 0.f;
        if (parts.facets) {
            f = smaller(facets<Fine>(g), Largest);
            if (parts.whitecaps)
                f = dr::fmadd(whitecap_fraction, whitecap_brdf, smooth_fraction * f);
            else
                f *= smooth_fraction;
        } else if (parts.whitecaps) {
            f = whitecap_fraction * whitecap_brdf;
        }
        f *= g.cos_o;
        if (!g.level)
            f *= g.shown;
        return dr::select(g.lit, f, 0.f);
    }

    /// Density, 1/sr, with which sample() draws o.
    Float pdf(const Geometry &g, Parts parts) const {
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
              halvings = HalfLog2e * z2, gauss = decay(halvings) * smaller(shown, 2.f),
              tail = decay(larger(dr::fnmadd(2.f * p.halvings, beyond, halvings), 0.f)) * beyond,
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
            h = Vector3f(dr::fmsub(h_u, cos_wind, h_c * sin_wind), dr::fmadd(h_u, sin_wind, h_c * cos_wind), cos_xi);
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
    /// 1/cos theta_i, 1/D, how often phi(1/D) halves phi(0), D phi(1/D).
    struct Proposal {
        Float i_u, i_c, u, c, inv_cos, inv_d, halvings, tail;
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
        p.halvings = HalfLog2e * dr::square(p.inv_d);
        p.tail = d2 * p.inv_d * decay(p.halvings) * 0.3989422804f;
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
    template <bool Fine>
    void tilted(Geometry &g, const Vector3f &i, const Vector3f &o, const Frame &frame) const {
        namespace dr = drjit;
        const Vector3f &n = frame.n;
        g.cos_i = g.local_i.z();
        g.cos_o = dr::dot(o, n);
        g.lit = g.cos_i > 0.f && g.cos_o > 0.f && i.z() > 0.f && o.z() > 0.f;
        g.level = false;
        g.shown = g.cos_i / larger(n.z() * i.z(), Tiny);
        g.seen_i = { dr::fmsub(i.x(), n.z(), i.z() * n.x()), dr::fmsub(i.y(), n.z(), i.z() * n.y()) };
        g.seen_o = { dr::fmsub(o.x(), n.z(), o.z() * n.x()), dr::fmsub(o.y(), n.z(), o.z() * n.y()) };

        Pair x = sum<Fine>(i.x(), o.x()), y = sum<Fine>(i.y(), o.y()), z = sum<Fine>(i.z(), o.z()),
             n_x{ n.x(), 0.f }, n_y{ n.y(), 0.f }, n_z{ n.z(), 0.f };
        auto [h_u, h_c] = wind_frame<Fine>(x, y);
        auto [n_u, n_c] = wind_frame<Fine>(n_x, n_y);
        auto [x_u, x_c] = wind_frame<Fine>(products<Fine>(x, n_z, z, -n_x), products<Fine>(y, n_z, z, -n_y));
        auto measure = [&](const Pair &sine, Pair cosine) {
            if (!slope_measure)
                return angle<Fine>(sine, cosine, true);
            Mask faces = cosine.hi > 0.f;
            cosine.hi = larger(cosine.hi, Tiny);
            Pair t = tangent<Fine>(sine, cosine, dr::rcp(cosine.hi));
            t.hi = dr::select(faces, t.hi, Steepest);
            return t;
        };
        g.tilt_u = measure(x_u, products<Fine>(h_u, n_u, z, n_z));
        g.tilt_c = measure(x_c, products<Fine>(h_c, n_c, z, n_z));

        Vector3f h = to_local(frame, i + o);
        Float inv_h = dr::rcp(larger(h.z(), Small));
        g.cos_zeta = smaller(.5f * dr::norm(i + o), 1.f);
        g.slope_u = h.x() * inv_h;
        g.slope_c = h.y() * inv_h;
        g.tan2_xi = dr::fmadd(g.slope_u, g.slope_u, g.slope_c * g.slope_c);
        g.inv_cos2_xi = 1.f + g.tan2_xi;
    }

    /// -2 ln(1 - u), to 3e-8, for u in [0, 1).
    static Float radius2(const Float &u) {
        namespace dr = drjit;
        using Int = dr::int32_array_t<Float>;
        // As a power of two and what is within sqrt(2) of 1.
        Float x = larger(1.f - u, Tiny);
        Int power = (dr::reinterpret_array<Int>(dr::detach(x)) - 0x3f3504f3) >> 23;
        Float t = dr::fmsub(x, dr::reinterpret_array<Float>(0x3f800000 - (power << 23)), 1.f), sum = .0872235671f;
        for (float c : { -.143668443f, .149522662f, -.165623933f, .199568331f, -.250020742f, .333341867f,
                         -.499999881f, 1.f })
            sum = dr::fmadd(sum, t, c);
        return larger(-2.f * dr::fmadd(Float(power), dr::LogTwo<float>, t * sum), 0.f);
    }

    /// 2^-(n + x), to 3e-9 and rounding, for whole n >= 0 and |x| up to 1/2; 0 from 2^-127 on.
    static Float decay(const Float &n, const Float &x) {
        namespace dr = drjit;
        using Int = dr::int32_array_t<Float>;
        Float sum = .000153523171f;
        for (float c : { -.00134001696f, .00961844996f, -.0555032939f, .240226477f, -.693147182f, 1.f })
            sum = dr::fmadd(sum, x, c);
        Int power(dr::fnmadd(smaller(n, 127.f), 0x1p23f, 127.f * 0x1p23f));
        return sum * dr::reinterpret_array<Float>(power);
    }

    /// 2^-x for x >= 0.
    static Float decay(const Float &x) {
        Float at = smaller(x, 127.f), n = drjit::round(drjit::detach(at));
        return decay(n, at - n);
    }

    /// Components along W_u and W_c (Eq. 68).
    std::pair<Float, Float> wind_frame(const Float &x, const Float &y) const {
        namespace dr = drjit;
        return { dr::fmadd(x, cos_wind, y * sin_wind), dr::fmsub(y, cos_wind, x * sin_wind) };
    }

    template <bool Fine> std::pair<Pair, Pair> wind_frame(const Pair &x, const Pair &y) const {
        if constexpr (!Fine) {
            auto [u, c] = wind_frame(x.hi, y.hi);
            return { { u, 0.f }, { c, 0.f } };
        } else if (oblique()) {
            Pair cos{ cos_wind, cos_wind_lo }, sin{ sin_wind, sin_wind_lo };
            return { settled(products<Fine>(x, cos, y, sin)), settled(products<Fine>(y, cos, -x, sin)) };
        } else {
            switch (quarters) {
                case 0: return { x, y };
                case 1: return { y, -x };
                case 2: return { -x, -y };
                default: return { -y, x };
            }
        }
    }

    /// f_SW, Eq. 56.
    template <bool Fine> Float facets(const Geometry &g) const {
        namespace dr = drjit;
        // p/cos^4 xi (Eqs. 72-73, 78-79).
        Pair u = scaled<Fine>(g.tilt_u, inv_width_u, inv_width_u_lo),
             c = scaled<Fine>(g.tilt_c, inv_width_c, inv_width_c_lo);
        if (as_printed) {
            // Without the sign of the tilt.
            Mask rises = u.hi > 0.f;
            u = { dr::select(rises, -u.hi, u.hi), dr::select(rises, -u.lo, u.lo) };
        }
        Float u2 = dr::square(u.hi), c2 = dr::square(c.hi), gauss;
        if constexpr (Fine) {
            // What is left of the squares beside whole numbers loses no digits.
            Float n = dr::round(dr::detach(u2 + c2)), n_c = dr::round(dr::detach(c2)),
                  lo = dr::fmadd(dr::detach(u.hi), u.lo, dr::detach(c.hi) * c.lo),
                  x = dr::fmadd(2.f, lo, dr::fmsub(u.hi, u.hi, n - n_c) + dr::fmsub(c.hi, c.hi, n_c));
            if (slope_measure)
                x = larger(smaller(x, 1.f), -1.f);
            gauss = decay(n, x);
        } else {
            gauss = decay(u2 + c2);
        }
        Float p = gauss * dr::square(g.inv_cos2_xi);
        if (!slope_measure && !as_printed)
            p = smaller(p, larger(gauss * steep_gain, SteepFloor));
        if (gram_charlier) {
            // Rounded once each.
            constexpr double W2 = 1. / (InvWidth * InvWidth), W4 = W2 * W2;
            constexpr float U4 = .23 / 24. * W4, C4 = .40 / 24. * W4, Both = .12 / 4. * W4,
                            U2 = -(.12 / 4. + .23 / 4.) * W2, C2 = -(.12 / 4. + .40 / 4.) * W2,
                            One = 1. + (.23 + .40) / 8. + .12 / 4.;
            Float even = dr::fmadd(c2, dr::fmadd(C4, c2, dr::fmadd(Both, u2, C2)),
                                   dr::fmadd(u2, dr::fmadd(U4, u2, U2), One));
            Float odd = dr::fmadd(skew_u2, u2, skew);
            if (as_printed)
                even += dr::fmadd(printed_c2, c2, printed);
            else
                odd = dr::fmadd(skew_c2, c2, odd);
            Float k = dr::fmadd(u.hi, odd, even);
            if constexpr (Fine) {
                // What rounding took from the tilt, by the highest powers' derivative.
                Float slope = dr::fmadd(4.f * U4, dr::detach(u.hi), 3.f * skew_u2);
                k = dr::fmadd(slope * dr::detach(u2), u.lo, k);
            }
            p *= larger(k, 0.f);
        }

        // Eqs. 61-67, at least what the facets themselves hide where the bound is in force.
        Float rho = reflectance(g.cos_zeta),
              area = unshadowed(rho, g.cos_i, g.cos_o, [&] { return std::pair(spread(g.seen_i), spread(g.seen_o)); });
        return p * (rho * scale) / larger(area, Tiny);
    }

    /// cos theta_i cos theta_r/G; `spreads` gives the facets' along the two directions.
    template <typename Spreads>
    Float unshadowed(const Float &rho, const Float &cos_i, const Float &cos_o, Spreads spreads) const {
        namespace dr = drjit;
        Float area = cos_i * cos_o;
        if (shadowing)
            area = dr::fmadd(cos_o, hidden(cos_i, sigma_shadow * sine(cos_i)),
                             dr::fmadd(cos_i, hidden(cos_o, sigma_shadow * sine(cos_o)), area));
        if (bounded) {
            auto [s_i, s_o] = spreads();
            Float v_i = cos_i + hidden(cos_i, s_i), v_o = cos_o + hidden(cos_o, s_o);
            area = larger(area, rho / bound * larger(v_i * cos_o, v_o * cos_i));
        }
        return area;
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

    /// cos F of the shadowing function, Eq. 66, for spread = sigma sin.
    Float hidden(const Float &cos, const Float &spread) const {
        namespace dr = drjit;
        Float nu = smaller(cos / larger(spread, Small), ierfc_end), root = ierfc[9];
        for (int k = 8; k >= 0; --k)
            root = dr::fmadd(root, nu, ierfc[k]);
        return .5f * spread * dr::square(root);
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

    /// What atan(x)/x adds to 1 - x^2/4, over x^2, for x^2 in [0, 1]: relative error of atan 3e-9.
    static Float atan_rest(const Float &x2) {
        namespace dr = drjit;
        Float sum = -.00179447105f;
        for (float c : { .0109186051f, -.0311857592f, .0579661280f, -.0840399414f, .109523930f, -.142642871f,
                         .199985534f, -.0833329931f })
            sum = dr::fmadd(sum, x2, c);
        return sum;
    }

    /// atan(t)/t of t^2.
    static Float atan_over(const Float &t2) {
        namespace dr = drjit;
        Float inv_t = dr::rsqrt(larger(t2, Tiny));
        Mask steep = t2 > 1.f;
        Float x2 = dr::select(steep, dr::square(inv_t), t2), over = dr::fmadd(x2, atan_rest(x2) - .25f, 1.f);
        return dr::select(steep, dr::fmsub(dr::Pi<float> * .5f, inv_t, over * x2), over);
    }

    friend Pair operator-(const Pair &a) { return { -a.hi, -a.lo }; }

    /// a + b.
    template <bool Fine> static Pair sum(const Float &a, const Float &b) {
        namespace dr = drjit;
        Pair s{ a + b, 0.f };
        if constexpr (Fine) {
            Float a0 = dr::detach(a), s0 = dr::detach(s.hi), t = s0 - a0;
            s.lo = (a0 - (s0 - t)) + (dr::detach(b) - t);
        }
        return s;
    }

    /// a + b where a is 0 or not below b; what rounding takes from it adds to lo.
    template <bool Fine> static Float sum(const Float &a, const Float &b, Float &lo) {
        namespace dr = drjit;
        Float s = a + b;
        if constexpr (Fine)
            lo += dr::detach(b) - (dr::detach(s) - dr::detach(a));
        return s;
    }

    /// a b + c d.
    template <bool Fine> static Pair products(const Pair &a, const Pair &b, const Pair &c, const Pair &d) {
        namespace dr = drjit;
        if constexpr (!Fine)
            return { dr::fmadd(a.hi, b.hi, c.hi * d.hi), 0.f };
        Float first = a.hi * b.hi, second = c.hi * d.hi;
        Pair s = sum<Fine>(first, second);
        Float a0 = dr::detach(a.hi), b0 = dr::detach(b.hi), c0 = dr::detach(c.hi), d0 = dr::detach(d.hi);
        s.lo += dr::fmsub(a0, b0, dr::detach(first)) + dr::fmsub(c0, d0, dr::detach(second));
        s.lo = dr::fmadd(a0, b.lo, dr::fmadd(b0, a.lo, dr::fmadd(c0, d.lo, dr::fmadd(d0, c.lo, s.lo))));
        return s;
    }

    /// Two parts of which the second is small beside the first even where larger numbers cancelled.
    static Pair settled(const Pair &a) {
        namespace dr = drjit;
        Float hi = a.hi + a.lo;
        return { hi, a.lo - (dr::detach(hi) - dr::detach(a.hi)) };
    }

    /// a times a coefficient.
    template <bool Fine> static Pair scaled(const Pair &a, const Float &b, const Float &b_lo) {
        namespace dr = drjit;
        Pair p{ a.hi * b, 0.f };
        if constexpr (Fine) {
            Float a0 = dr::detach(a.hi);
            p.lo = dr::fmadd(a.lo, dr::detach(b), dr::fmadd(a0, b_lo, dr::fmsub(a0, dr::detach(b), dr::detach(p.hi))));
        }
        return p;
    }

    /// a/b, for 1/b in any number of digits.
    template <bool Fine> static Pair quotient(const Pair &a, const Pair &b, const Float &inv_b) {
        namespace dr = drjit;
        Pair q{ a.hi * inv_b, 0.f };
        if constexpr (Fine) {
            Float q0 = dr::detach(q.hi), rest = dr::fnmadd(q0, dr::detach(b.hi), dr::detach(a.hi));
            q.lo = dr::fnmadd(q0, b.lo, rest + a.lo) * dr::detach(inv_b);
        }
        return q;
    }

    /// The same where a slope may be steeper than numbers can tell.
    template <bool Fine> static Pair tangent(const Pair &a, const Pair &b, const Float &inv_b) {
        Pair q = quotient<Fine>(a, b, inv_b);
        q.hi = larger(smaller(q.hi, Steepest), -Steepest);
        return q;
    }

    /// Tilt angle of which these are in proportion to the sine and the cosine; `beyond` upright too.
    template <bool Fine> static Pair angle(const Pair &sine, const Pair &cosine, bool beyond = false) {
        namespace dr = drjit;
        // atan(a/b) from an angle on an axis.
        constexpr float Right = dr::Pi<float> * .5f;
        constexpr double RightLo = dr::Pi<double> * .5 - Right;
        Mask steep = dr::abs(sine.hi) > (beyond ? dr::abs(cosine.hi) : cosine.hi);
        Pair a{ dr::select(steep, -cosine.hi, sine.hi), 0.f }, b{ dr::select(steep, sine.hi, cosine.hi), 0.f };
        Float right = dr::copysign(Float(Right), dr::detach(sine.hi)), base = dr::select(steep, right, 0.f);
        if (beyond) {
            base = dr::select(!steep && cosine.hi < 0.f, 2.f * right, base);
            b.hi = dr::select(b.hi == 0.f, Tiny, b.hi);
        }
        if constexpr (Fine) {
            a.lo = dr::select(steep, -cosine.lo, sine.lo);
            b.lo = dr::select(steep, sine.lo, cosine.lo);
        }
        Pair t = quotient<Fine>(a, b, dr::rcp(b.hi));
        Float t2 = t.hi * t.hi, t3 = t.hi * t2, quarter = -.25f * t3, rest = atan_rest(t2),
              more = dr::fmadd(t3, rest, quarter), lo = 0.f;
        if constexpr (Fine) {
            // d atan(t)/dt to some percent, and what rounding took from t^3 and from more.
            auto [t0, t02, t03] = std::tuple(dr::detach(t.hi), dr::detach(t2), dr::detach(t3));
            lo = dr::fmadd(t.lo, dr::fmadd(-.5f, t02, .957f), base * float(RightLo / Right));
            lo = dr::fmadd(dr::fmsub(t0, t02, t03), -.3f, lo);
            lo += dr::fmadd(t03, dr::detach(rest), dr::detach(quarter) - dr::detach(more));
        }
        Float hi = sum<Fine>(base, t.hi, lo);
        hi = sum<Fine>(hi, more, lo);
        return { hi, lo };
    }

    /// rho of Eq. 63.
    Float schlick(const Float &cos) const {
        namespace dr = drjit;
        Float m = larger(1.f - cos, 0.f), m2 = m * m;
        return dr::fmadd(1.f - normal_reflectance, m2 * m2 * m, normal_reflectance);
    }

public:
    /// rho of Schlick or of Fresnel's equations, whose near-equal numbers are multiplied out.
    Float reflectance(const Float &cos) const {
        namespace dr = drjit;
        if (!exact)
            return schlick(cos);
        Float cos2 = cos * cos, g = dr::sqrt(cos2 + excess), s = cos + g, p = dr::fmadd(excess, cos, s),
              rs = excess / larger(s * s, Tiny),
              rp = excess * dr::fmsub(excess + 2.f, cos2, 1.f) / larger(p * p, Tiny);
        return .5f * dr::fmadd(rs, rs, rp * rp);
    }

private:
    /// Albedos, roughly, by which a lobe is chosen: of the facets and of the whitecaps.
    std::pair<Float, Float> albedos(const Float &cos) const {
        Float facets = smooth_fraction * (schlick(cos) + FacetAlbedoFloor);
        return { facets, drjit::Pi<float> * whitecap_brdf * whitecap_fraction };
    }
};

} // namespace prob_water
