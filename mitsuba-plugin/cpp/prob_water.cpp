#include "compatible.h"

#include <mitsuba/core/properties.h>
#include <mitsuba/render/bsdf.h>
#include <cmath>

#include "prob-water-mitsuba/src/lib.rs.h"
#include "rust/cxx.h"

#include "afar.h"

// The hot path of the scalar variants: the Rust core, called as plain C.
extern "C" {
struct ProbWaterSample {
    float direction[3];
    float pdf;
    float f;
    bool whitecap;
};
static_assert(sizeof(ProbWaterSample) == 24, "as the core's Sample");
float prob_water_bsdf_eval(const prob_water::Water *, uint32_t parts, const float i[3], const float o[3]);
float prob_water_bsdf_pdf(const prob_water::Water *, uint32_t parts, const float i[3], const float o[3]);
void prob_water_bsdf_sample(const prob_water::Water *, uint32_t parts, const float i[3], const float u[3],
                            ProbWaterSample *sample);
}

NAMESPACE_BEGIN(mitsuba)

/**!
.. _bsdf-prob_water:

Wind-roughened water (:monosp:`prob_water`)
-------------------------------------------

.. pluginparameters::

 * - wind_speed
   - |float|
   - Wind speed in m/s at :monosp:`wind_height`; 0 is calm, 36 at 10 m the upper limit. (Default: 5)
   - |exposed| (where given)

 * - wind_height
   - |float|
   - Height in m at which the wind speed is measured, 0.1 to 100. (Default: 10)
   - |exposed| (where given)

 * - friction_velocity
   - |float|
   - Friction velocity in cm/s instead of the wind speed, 0 to 238.65.
   - |exposed| (where given)

 * - beaufort
   - |int|
   - Beaufort number instead of the wind speed, 0 to 12.
   - |exposed| (where given)

 * - wind_direction
   - |float|
   - Azimuth in degrees that the wind comes *from*, counter-clockwise from the shading frame's
     s axis (dp_du). (Default: 0)
   - |exposed|

 * - footprint
   - |float|
   - Footprint D in m: waves shorter than 2 D are facets. The string "inf" counts all waves. (Default: inf, or 0.15
     where the surface is not flat)
   - |exposed|

 * - surface
   - |string|
   - Which surface the facets lie on: :monosp:`flat`, the normal that the geometry gives, or :monosp:`ensemble`, all
     waves longer than two footprints that the wind may raise, on average: the sea from afar. (Default: flat)

 * - average
   - |string|
   - What the ensemble's average is of: :monosp:`power`, reciprocal, or the :monosp:`report`'s mean of f times the flat
     cosine. No effect on the flat surface. (Default: power)

 * - components, instances, seed, time, depth, fetch
   - |float|
   - The vocabulary's words for drawn waves: components, depth and fetch matter to the ensemble; else they are
     checked and have no effect.

 * - wavelength
   - |float|
   - Wavelength in micrometres of the refractive index and the whitecaps, 0.2 to 200; spectral
     variants use it for every wavelength. (Default: 0.55)
   - |exposed|

 * - ior
   - |float|
   - Refractive index, 1 to 4. (Default: Hale and Querry's at the wavelength, with sea salt)
   - |exposed| (where given)

 * - water
   - |string|
   - :monosp:`ocean` or :monosp:`fresh`. (Default: ocean)

 * - fresnel
   - |string|
   - :monosp:`schlick`, as in the report, or :monosp:`exact`. (Default: schlick)

 * - slope_measure
   - |string|
   - Slopes are Gaussian as tilt angles (:monosp:`angle`, as in the report) or as
     :monosp:`slope`, Cox and Munk's measure. (Default: angle)

 * - readings
   - |string|
   - :monosp:`corrected` or :monosp:`as_printed` equations. (Default: corrected)

 * - whitecaps, shadowing, gram_charlier
   - |bool|
   - Whether whitecaps are blended in, the shadowing function and the skewness and kurtosis of
     the slopes are applied. (Default: true)

The sea as a renderer sees it from where single waves are not resolved: the water BRDF of the report
AFRL-RH-FS-TR-2023-0002, facets with Cox and Munk's slopes, whitecaps between them. One-sided, black
from below. It has two components: 0 the facets (glossy), 1 the whitecaps (diffuse), if there are any.

.. tabs::
    .. code-tab:: xml
        :name: prob-water

        <bsdf type="prob_water">
            <float name="wind_speed" value="7"/>
            <float name="wind_direction" value="90"/>
        </bsdf>

    .. code-tab:: python

        'type': 'prob_water',
        'wind_speed': 7,
        'wind_direction': 90

*/
template <typename Float, typename Spectrum>
class ProbWater final : public BSDF<Float, Spectrum> {
public:
    MI_IMPORT_BASE(BSDF, m_flags, m_components)
    MI_IMPORT_TYPES()

    using Lobe = prob_water::Lobe<Float>;
    using Afar = prob_water::Afar<Float>;
    using Parts = prob_water::Parts;

    ProbWater(const Properties &props)
        : Base(props), m_options(options(props)), m_water(refuse([&] { return m_options->configure(); })) {
        for (const char *name : Exposed)
            if (!std::isnan(m_water->number(name)))
                m_exposed.emplace_back(name, 0.f);
        apply();
    }

    void traverse(TraversalCallback *cb) override {
        for (auto &[name, value] : m_exposed)
            cb->put(name, value, ParamFlags::NonDifferentiable);
    }

    void parameters_changed(const std::vector<std::string> & /*keys*/) override {
        try {
            refuse([&] {
                for (auto &[name, value] : m_exposed)
                    if (value != (ScalarFloat) m_water->number(name))
                        m_options->set_number(name, value);
                m_water = m_options->configure();
            });
        } catch (...) {
            // A refused value leaves the sea as it was.
            for (auto &[name, value] : m_exposed)
                m_options->set_number(name, m_water->number(name));
            apply();
            throw;
        }
        apply();
    }

    std::pair<BSDFSample3f, Spectrum> sample(const BSDFContext &ctx, const SurfaceInteraction3f &si, Float sample1,
                                             const Point2f &sample2, Mask active) const override {
        MI_MASKED_FUNCTION(ProfilerPhase::BSDFSample, active);

        BSDFSample3f bs = dr::zeros<BSDFSample3f>();
        Parts parts = enabled(ctx);
        active &= Frame3f::cos_theta(si.wi) > 0.f;
        if (unlikely(parts.none() || dr::none_or<false>(active)))
            return { bs, 0.f };

        Float weight;
        Mask whitecap;
        if constexpr (dr::is_jit_v<Float>) {
            std::tie(bs.wo, whitecap) = m_lobe.sample(si.wi, sample1, sample2, parts);
            // A weight divides two Gaussians: it needs no digits to spare.
            auto g = m_lobe.template geometry<Float>(si.wi, bs.wo);
            bs.pdf = m_lobe.pdf(g, si.wi, parts);
            active &= bs.pdf > 0.f;
            Float value = m_afar.rows ? m_afar.eval(m_lobe, si.wi, bs.wo, parts)
                                      : m_lobe.eval(g, si.wi, bs.wo, parts);
            weight = value / bs.pdf;
        } else {
            float u[3] = { sample1, sample2.x(), sample2.y() };
            ProbWaterSample s{};
            prob_water_bsdf_sample(&*m_water, parts.bits(), si.wi.data(), u, &s);
            bs.wo = Vector3f(s.direction[0], s.direction[1], s.direction[2]);
            bs.pdf = s.pdf;
            whitecap = s.whitecap;
            active &= s.pdf > 0.f;
            weight = s.f * s.direction[2] / s.pdf;
        }
        bs.eta = 1.f;
        bs.sampled_component = dr::select(whitecap, UInt32(1), UInt32(0));
        bs.sampled_type = dr::select(whitecap, UInt32(+BSDFFlags::DiffuseReflection),
                                     UInt32(+BSDFFlags::GlossyReflection));
        return { bs, spectrum(weight) & active };
    }

    Spectrum eval(const BSDFContext &ctx, const SurfaceInteraction3f &si, const Vector3f &wo,
                  Mask active) const override {
        MI_MASKED_FUNCTION(ProfilerPhase::BSDFEvaluate, active);

        Parts parts = enabled(ctx);
        if (unlikely(parts.none() || dr::none_or<false>(active)))
            return 0.f;
        if constexpr (dr::is_jit_v<Float>)
            return spectrum(eval_pdf(si.wi, wo, parts, false).first) & active;
        else
            return spectrum(prob_water_bsdf_eval(&*m_water, parts.bits(), si.wi.data(), wo.data())) & active;
    }

    Float pdf(const BSDFContext &ctx, const SurfaceInteraction3f &si, const Vector3f &wo,
              Mask active) const override {
        MI_MASKED_FUNCTION(ProfilerPhase::BSDFEvaluate, active);

        Parts parts = enabled(ctx);
        if (unlikely(parts.none() || dr::none_or<false>(active)))
            return 0.f;
        if constexpr (dr::is_jit_v<Float>)
            return dr::select(active, m_lobe.pdf(m_lobe.template geometry<Float>(si.wi, wo), si.wi, parts), 0.f);
        else
            return active ? prob_water_bsdf_pdf(&*m_water, parts.bits(), si.wi.data(), wo.data()) : 0.f;
    }

    std::pair<Spectrum, Float> eval_pdf(const BSDFContext &ctx, const SurfaceInteraction3f &si, const Vector3f &wo,
                                        Mask active) const override {
        MI_MASKED_FUNCTION(ProfilerPhase::BSDFEvaluate, active);

        if constexpr (dr::is_jit_v<Float>) {
            Parts parts = enabled(ctx);
            if (parts.none())
                return { 0.f, 0.f };
            auto [value, pdf] = eval_pdf(si.wi, wo, parts, true);
            return { spectrum(value) & active, dr::select(active, pdf, 0.f) };
        } else {
            return { eval(ctx, si, wo, active), pdf(ctx, si, wo, active) };
        }
    }

    Spectrum eval_diffuse_reflectance(const SurfaceInteraction3f & /*si*/, Mask active) const override {
        return spectrum(m_lobe.whitecap_fraction * m_lobe.whitecap_brdf * dr::Pi<ScalarFloat>) & active;
    }

    std::string to_string() const override {
        return "ProbWater[\n  " + string::indent(std::string(m_water->describe()), 2) + "\n]";
    }

    MI_DECLARE_CLASS(ProbWater)

private:
    /// Numbers that traverse() exposes, where they are set.
    static constexpr const char *Exposed[] = { "wind_speed", "wind_height", "friction_velocity", "beaufort",
                                               "wind_direction", "footprint", "wavelength", "ior" };

    static Spectrum spectrum(const Float &value) {
        return depolarizer<Spectrum>(UnpolarizedSpectrum(value));
    }

    /// Runs a call into the core; its errors become Mitsuba's.
    template <typename Call> static auto refuse(Call call) {
        try {
            return call();
        } catch (const rust::Error &e) {
            Throw("prob_water: %s", e.what());
        }
    }

    /// The parameters of the vocabulary that the scene gives.
    static rust::Box<prob_water::Options> options(const Properties &props) {
        return refuse([&] {
            rust::Box<prob_water::Options> options = prob_water::options();
            for (const rust::String &word : prob_water::vocabulary()) {
                std::string name(word);
                if (!props.has_property(name))
                    continue;
                switch (props.type(name)) {
                    case Properties::Type::Bool:
                        options->set_flag(name, props.get<bool>(name));
                        break;
                    case Properties::Type::Integer:
                        options->set_number(name, (double) props.get<int64_t>(name));
                        break;
                    case Properties::Type::Float:
                        options->set_number(name, props.get<double>(name));
                        break;
                    case Properties::Type::String:
                        options->set_text(name, std::string(props.get<std::string_view>(name)));
                        break;
                    default:
                        Throw("prob_water: %s is an object: allowed is a number, true or false, or a word", name);
                }
            }
            return options;
        });
    }

    /// Takes over what the configured sea says.
    void apply() {
        for (auto &[name, value] : m_exposed)
            value = (ScalarFloat) m_water->number(name);

        prob_water::Coefficients c = m_water->coefficients();
        m_whitecaps = c.whitecap_fraction > 0.f;
        m_lobe = Lobe(c);
        if constexpr (dr::is_jit_v<Float>)
            m_afar = Afar(m_water->waves());

        m_components.clear();
        m_components.push_back(BSDFFlags::GlossyReflection | BSDFFlags::Anisotropic | BSDFFlags::FrontSide);
        m_flags = m_components[0];
        if (m_whitecaps) {
            m_components.push_back(BSDFFlags::DiffuseReflection | BSDFFlags::FrontSide);
            m_flags = m_flags | m_components[1];
        }
    }

    /// Traced f cos(theta_o) and, if wanted, the density. Only Gram-Charlier's polynomial asks for digits to spare.
    std::pair<Float, Float> eval_pdf(const Vector3f &wi, const Vector3f &wo, Parts parts, bool with_pdf) const {
        auto run = [&](auto type) {
            using T = decltype(type);
            auto g = m_lobe.template geometry<T>(wi, wo);
            return std::pair<Float, Float>(m_afar.rows ? m_afar.eval(m_lobe, wi, wo, parts)
                                                       : m_lobe.template eval<T>(g, wi, wo, parts),
                                           with_pdf ? m_lobe.pdf(g, wi, parts) : Float(0.f));
        };
        return m_lobe.gram_charlier && !m_afar.rows ? run(typename Lobe::Wide()) : run(Float());
    }

    Parts enabled(const BSDFContext &ctx) const {
        return { ctx.is_enabled(BSDFFlags::GlossyReflection, 0),
                 m_whitecaps && ctx.is_enabled(BSDFFlags::DiffuseReflection, 1) };
    }

    rust::Box<prob_water::Options> m_options;
    rust::Box<prob_water::Water> m_water;
    std::vector<std::pair<std::string, ScalarFloat>> m_exposed;
    bool m_whitecaps = false;
    Lobe m_lobe;
    Afar m_afar;

    MI_TRAVERSE_CB(Base, m_lobe, m_afar)
};

extern "C" MI_EXPORT void init_plugin(std::string_view name, PluginRegisterFn fn) {
    prob_water::check_compatible();
    MI_REGISTER_PLUGIN(fn, name, ProbWater);
}

NAMESPACE_END(mitsuba)
