/**
 * The water at one place, with one interface: in traced code the core's programs (replay.h), in scalar code its functions.
 */
#pragma once

#include "replay.h"
#include <drjit/while_loop.h>

namespace prob_water {

/// What is asked for: some of the lobes, for a path that runs to the light or comes from it.
struct Request {
    bool facets, whitecaps, water_leaving, to_light;
    uint32_t parts() const { return (facets ? 1u : 0u) | (whitecaps ? 2u : 0u); }
    bool surface() const { return facets || whitecaps; }
    bool none() const { return !surface() && !water_leaving; }
};

/// Position in m, footprint in m and probability of a whitecap, as far as they differ from place to place.
template <typename Float> struct Where {
    /// Extended precision; not on GPUs, most of which are slow in double precision.
    using Extended = std::conditional_t<drjit::is_cuda_v<Float>, Float, drjit::float64_array_t<Float>>;
    Extended x = 0, y = 0;
    Float footprint = std::numeric_limits<float>::quiet_NaN(), whitecap = footprint;
};

template <typename Float> struct Draw {
    mitsuba::Vector<Float, 3> wo;
    /// f cos(theta_o) and density, 1/sr; where they are told apart, of facets, and that of whitecaps.
    Float value, whitecaps, pdf;
    drjit::mask_t<Float> from_whitecap;
};

template <typename Float> struct TracedPlace {
    using Vector3f = mitsuba::Vector<Float, 3>;

    const Replay<Float> &replay;
    bool ordered;
    Inputs<Float> inputs;

    /// f cos(theta_o), or where they are told apart that of facets and that of whitecaps.
    std::pair<Float, Float> eval(Request r, const Vector3f &wi, const Vector3f &wo, bool apart, Kernel kernel = Kernel::Eval) const {
        if (!apart)
            return { value(kernel, r, wi, wo), 0.f };
        Request facets{ true, false, false, r.to_light }, whitecaps{ false, true, false, r.to_light };
        return { r.facets ? value(kernel, facets, wi, wo) : Float(0.f), r.whitecaps ? value(kernel, whitecaps, wi, wo) : Float(0.f) };
    }

    Float pdf(Request r, const Vector3f &wi, const Vector3f &wo) const { return run(Kernel::Pdf, r, wi, wo)[0]; }

    Draw<Float> sample(Request r, const Vector3f &wi, const Vector3f &u, bool apart) const {
        Inputs<Float> in = inputs;
        in.set(Input::Source, wi);
        in.set(Input::Random, u);
        auto drawn = replay.run(Kernel::Draw, r.parts(), in);
        Vector3f wo(drawn[0], drawn[1], drawn[2]);
        auto [value, whitecaps] = eval(r, wi, wo, apart, Kernel::Weight);
        return { wo, value, whitecaps, pdf(r, wi, wo), drawn[3] > 0.f };
    }

    /// f cos(theta_o) of light from below for a reflectance of 1, and the density of draws by cosine. The index is that of a lane.
    std::pair<Float, Float> water_leaving(const Vector3f &wi, const Vector3f &wo, const Float &index) const {
        auto found = run(Kernel::WaterLeaving, {}, wi, wo, 0.f, index);
        return { found[0], found[1] };
    }

    /// m01, m22 and m23 of the facets' Mueller matrix over m00.
    Vector3f polarisation(const Vector3f &wi, const Vector3f &wo, const Float &index) const {
        auto found = run(Kernel::Polarisation, {}, wi, wo, 0.f, index);
        return { found[0], found[1], found[2] };
    }

    /// The facets' reflectance for the indices of lanes over the sea's.
    template <typename Lanes> Lanes lane_reflectances(const Vector3f &wi, const Vector3f &wo, const Lanes &index) const {
        Lanes ratios;
        for (size_t k = 0; k < Lanes::Size; ++k)
            ratios[k] = run(Kernel::LaneReflectance, {}, wi, wo, 0.f, index[k])[0];
        return ratios;
    }

    Float water_leaving_share(Request r, const Vector3f &wi, const Float &reflectance) const {
        Inputs<Float> in = inputs;
        in.set(Input::Source, wi);
        in.set(Input::Reflectance, reflectance);
        return replay.run(Kernel::WaterLeavingShare, r.parts(), in)[0];
    }

    /// Diffuse reflectance of the whitecaps, and the share of water without any.
    std::pair<Float, Float> diffuse() const {
        auto found = replay.run(Kernel::Diffuse, 0, inputs);
        return { found[0], found[1] };
    }

private:
    /// The order matters to means alone; densities are of draws from wi, whichever way the light goes.
    Float value(Kernel kernel, Request r, const Vector3f &wi, const Vector3f &wo) const {
        bool turned = ordered && r.to_light;
        return run(kernel, r, turned ? wo : wi, turned ? wi : wo, wo.z())[0];
    }

    std::vector<Float> run(Kernel kernel, Request r, const Vector3f &i, const Vector3f &o, const Float &cos = 0.f,
                           const Float &index = 0.f) const {
        Inputs<Float> in = inputs;
        in.set(Input::Index, index);
        in.set(Input::Source, i);
        in.set(Input::Observer, o);
        in.set(Input::Cosine, cos);
        return replay.run(kernel, r.parts(), in);
    }
};

template <typename Float_> struct TracedSea {
    using Float = Float_;
    using Place = TracedPlace<Float>;
    using Extended = typename Where<Float>::Extended;
    using Vector3f = mitsuba::Vector<Float, 3>;
    using UInt32 = drjit::uint32_array_t<Float>;
    using Buffer = mitsuba::DynamicBuffer<Extended>;

    Replay<Float> replay;
    Buffer waves;
    uint32_t count = 0;
    Traits traits{};

    TracedSea(const Water &water) : replay(water.kernels()), traits(water.traits()) {
        rust::Vec<double> found = water.drawn_waves();
        count = (uint32_t) found.size() / 8;
        std::vector<drjit::scalar_t<Extended>> numbers(found.begin(), found.end());
        numbers.resize(std::max<size_t>(numbers.size(), 8));
        waves = drjit::load<Buffer>(numbers.data(), numbers.size());
        // Copies from here to there keep their memory up to the next kernel, or to this.
        drjit::sync_thread();
    }

    DRJIT_STRUCT(TracedSea, replay, waves)

    /// The indices at wavelengths in nm, and the whitecaps' BRDF over the sea's.
    template <typename Lanes> std::pair<Lanes, Lanes> lanes(const Lanes &wavelengths) const {
        std::pair<Lanes, Lanes> all;
        for (size_t k = 0; k < Lanes::Size; ++k) {
            Inputs<Float> in;
            in.set(Input::Wavelength, wavelengths[k]);
            auto found = replay.run(Kernel::Lane, 0, in);
            all.first[k] = found[0];
            all.second[k] = found[1];
        }
        return all;
    }

    Place at(const Where<Float> &where) const {
        Place place{ replay, traits.ordered, {} };
        place.inputs.set(Input::Footprint, where.footprint);
        place.inputs.set(Input::Whitecap, where.whitecap);
        if (traits.drawn)
            add_waves(where, place.inputs);
        return place;
    }

private:
    /// The wave normal and the probability of a whitecap.
    void add_waves(const Where<Float> &where, Inputs<Float> &inputs) const {
        namespace dr = drjit;
        Float log2_footprint = traits.varying_footprint ? dr::log2(where.footprint) : Float(0.f);
        Inputs<Float> in;
        auto [j, sums] = dr::while_loop(
            dr::make_tuple(UInt32(0), Vector3f(0.f)), [&](const UInt32 &j, auto &...) { return j < count; },
            [&](UInt32 &j, Vector3f &sums) {
                auto wave = dr::gather<dr::Array<Extended, 8>>(waves, j);
                Extended turns = dr::fmadd(wave[1], where.x, dr::fmadd(wave[2], where.y, wave[0]));
                in.set(Input::Wave, Float(turns - dr::floor(turns)));
                for (size_t k = 1; k < 6; ++k)
                    in.numbers[(size_t) Input::Wave + k] = Float(wave[k]);
                in.set(Input::Footprint, log2_footprint);
                in.set(Input::Sums, sums);
                auto found = replay.run(Kernel::Wave, 0, in);
                sums = { found[0], found[1], found[2] };
                j += 1u;
            },
            "waves of prob_water");
        in.set(Input::Footprint, log2_footprint);
        in.set(Input::Sums, sums);
        auto found = replay.run(Kernel::Normal, 0, in);
        inputs.set(Input::Normal, Vector3f(found[0], found[1], found[2]));
        if (!traits.whitecap_texture)
            inputs.set(Input::Whitecap, found[3]);
    }
};

// The core's functions for scalar variants: mitsuba-plugin/src/evaluate.rs.
extern "C" {
struct ProbWaterSample {
    float direction[3], pdf, value;
    bool whitecap;
    float whitecaps;
};
static_assert(sizeof(ProbWaterSample) == 28 && sizeof(Where<float>) == 24, "as the core has them");
struct ProbWaterPair {
    float first, second;
};
struct ProbWaterLocal {
    alignas(16) unsigned char bytes[256];
};
void prob_water_place(const Water *, const Where<float> *, ProbWaterLocal *);
ProbWaterPair prob_water_place_eval(const ProbWaterLocal *, uint32_t parts, const float *i, const float *o, bool to_light, bool apart);
float prob_water_place_pdf(const ProbWaterLocal *, uint32_t parts, const float *i, const float *o);
ProbWaterSample prob_water_place_sample(const ProbWaterLocal *, uint32_t parts, const float *i, const float *u, bool to_light, bool apart);
ProbWaterPair prob_water_place_water_leaving(const ProbWaterLocal *, const float *i, const float *o, float index);
void prob_water_place_polarisation(const ProbWaterLocal *, const float *i, const float *o, float index, float *shares);
void prob_water_place_lane_reflectances(const ProbWaterLocal *, const float *i, const float *o, size_t count, const float *indices, float *ratios);
void prob_water_lanes(const Water *, size_t count, const float *wavelengths, float *indices, float *whitecaps);
float prob_water_place_water_leaving_share(const ProbWaterLocal *, uint32_t parts, const float *i, float reflectance);
ProbWaterPair prob_water_place_diffuse(const ProbWaterLocal *);
}

template <typename Float> struct ScalarPlace {
    using Vector3f = mitsuba::Vector<Float, 3>;
    using Pair = std::pair<Float, Float>;

    ProbWaterLocal local;

    Pair eval(Request r, const Vector3f &i, const Vector3f &o, bool apart) const {
        ProbWaterPair found = prob_water_place_eval(&local, r.parts(), i.data(), o.data(), r.to_light, apart);
        return { found.first, found.second };
    }
    Float pdf(Request r, const Vector3f &i, const Vector3f &o) const {
        return prob_water_place_pdf(&local, r.parts(), i.data(), o.data());
    }
    Draw<Float> sample(Request r, const Vector3f &i, const Vector3f &u, bool apart) const {
        ProbWaterSample s = prob_water_place_sample(&local, r.parts(), i.data(), u.data(), r.to_light, apart);
        return { Vector3f(s.direction[0], s.direction[1], s.direction[2]), s.value, s.whitecaps, s.pdf, s.whitecap };
    }
    Pair water_leaving(const Vector3f &i, const Vector3f &o, Float index) const {
        ProbWaterPair found = prob_water_place_water_leaving(&local, i.data(), o.data(), index);
        return { found.first, found.second };
    }
    Vector3f polarisation(const Vector3f &i, const Vector3f &o, Float index) const {
        Vector3f shares;
        prob_water_place_polarisation(&local, i.data(), o.data(), index, shares.data());
        return shares;
    }
    template <typename Lanes> Lanes lane_reflectances(const Vector3f &i, const Vector3f &o, const Lanes &index) const {
        Lanes ratios;
        prob_water_place_lane_reflectances(&local, i.data(), o.data(), Lanes::Size, index.data(), ratios.data());
        return ratios;
    }
    Float water_leaving_share(Request r, const Vector3f &i, Float reflectance) const {
        return prob_water_place_water_leaving_share(&local, r.parts(), i.data(), reflectance);
    }
    Pair diffuse() const {
        ProbWaterPair found = prob_water_place_diffuse(&local);
        return { found.first, found.second };
    }
};

template <typename Float> struct ScalarSea {
    using Place = ScalarPlace<Float>;

    const Water *water = nullptr;

    ScalarSea() = default;
    explicit ScalarSea(const Water &water) : water(&water) {}

    template <typename Lanes> std::pair<Lanes, Lanes> lanes(const Lanes &wavelengths) const {
        std::pair<Lanes, Lanes> all;
        prob_water_lanes(water, Lanes::Size, wavelengths.data(), all.first.data(), all.second.data());
        return all;
    }

    Place at(const Where<Float> &where) const {
        Place place;
        prob_water_place(water, &where, &place.local);
        return place;
    }
};

template <typename Float> using Sea = std::conditional_t<drjit::is_jit_v<Float>, TracedSea<Float>, ScalarSea<Float>>;

} // namespace prob_water
