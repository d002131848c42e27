#include "compatible.h"

#include <mitsuba/core/fresolver.h>
#include <mitsuba/core/properties.h>
#include <mitsuba/core/warp.h>
#include <mitsuba/render/bsdf.h>
#include <mitsuba/render/texture.h>
#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <sstream>

#include "prob-water-mitsuba/src/lib.rs.h"
#include "rust/cxx.h"

#include "place.h"
#include "replay.h"
#include "sea.h"
#include "words.h"

// The hot path of the scalar variants: the Rust core, called as plain C.
extern "C" {
struct ProbWaterSample {
    float direction[3];
    float pdf;
    /// f cos(theta_o).
    float value;
    bool whitecap;
};
static_assert(sizeof(ProbWaterSample) == 24, "as the core's Sample");
struct ProbWaterPlace {
    double place[2];
    float footprint, whitecaps;
};
struct ProbWaterSpot {
    alignas(16) unsigned char bytes[256];
};
float prob_water_reflectance(const prob_water::Water *, float cos);
float prob_water_bsdf_eval(const prob_water::Water *, uint32_t parts, const float i[3], const float o[3], bool to_light);
float prob_water_bsdf_pdf(const prob_water::Water *, uint32_t parts, const float i[3], const float o[3]);
void prob_water_bsdf_sample(const prob_water::Water *, uint32_t parts, const float i[3], const float u[3], bool to_light,
                            ProbWaterSample *sample);
void prob_water_spot(const prob_water::Water *, const ProbWaterPlace *, ProbWaterSpot *);
float prob_water_spot_whitecaps(const ProbWaterSpot *);
float prob_water_spot_eval(const ProbWaterSpot *, uint32_t parts, const float i[3], const float o[3]);
float prob_water_spot_pdf(const ProbWaterSpot *, uint32_t parts, const float i[3], const float o[3]);
void prob_water_spot_sample(const ProbWaterSpot *, uint32_t parts, const float i[3], const float u[3],
                            ProbWaterSample *sample);
}

NAMESPACE_BEGIN(mitsuba)

// Parameters and examples: mitsuba-plugin/docs/prob_water.rst.
template <typename Float, typename Spectrum>
class ProbWater final : public BSDF<Float, Spectrum>, public prob_water::TakesSea {
public:
    MI_IMPORT_BASE(BSDF, m_flags, m_components)
    MI_IMPORT_TYPES(Texture)

    using Replay = prob_water::Replay<Float>;
    using Drawn = prob_water::Drawn<Float>;
    using Parts = prob_water::Parts;
    using Wide = typename Drawn::Wide;

    ProbWater(const Properties &props) : Base(props), m_options(prob_water::options()) {
        if (props.has_property("water_leaving"))
            m_water_leaving = props.get_texture<Texture>("water_leaving");
        check_water_leaving();
        take(props);
        if (props.has_property("table")) {
            std::string path = file_resolver()->resolve(props.get<std::string_view>("table")).string();
            refuse([&] { m_options->open_table(path); });
        }
        double angle = props.get<double>("pixel_angle", 0.);
        if (!(angle >= 0. && angle < 90.) || (angle > 0. && !m_pixel))
            Throw("prob_water: pixel_angle = %s is out of range: allowed is 0 to 90 degrees, with footprint = pixel", angle);
        m_pixel_angle = (ScalarFloat) (angle * dr::Pi<double> / 180.);
        configure();
        if (dr::is_jit_v<Float> && m_pixel && angle == 0.)
            Throw("prob_water: footprint = pixel needs pixel_angle here: traced variants have no ray differentials");
    }

    void take_sea(const Properties &sea) override {
        // Scenes load on several threads.
        static std::mutex mutex;
        std::lock_guard<std::mutex> guard(mutex);
        if (m_lent)
            Throw("prob_water: one BSDF cannot lie on two prob_water_surfaces, each has a sea of its own");
        // One sea is described once.
        for (const std::string &name : m_given)
            if (sea.has_property(name) || prob_water::describes_sea(name))
                Throw("prob_water: %s is given on the BSDF of a prob_water_surface: give it on the shape", name);
        take(sea);
        m_lent = true;
        configure();
    }

    void set_time(double time) override { (*m_water)->set_time(time); }

    void traverse(TraversalCallback *cb) override {
        for (auto &[name, value] : m_exposed)
            cb->put(name, value, ParamFlags::NonDifferentiable);
        if (m_footprint)
            cb->put("footprint", m_footprint, ParamFlags::NonDifferentiable);
        if (m_whitecap_texture)
            cb->put("whitecaps", m_whitecap_texture, ParamFlags::NonDifferentiable);
        if (m_water_leaving)
            cb->put("water_leaving", m_water_leaving, ParamFlags::Differentiable);
    }

    void parameters_changed(const std::vector<std::string> & /*keys*/) override {
        try {
            check_water_leaving();
            refuse([&] {
                for (auto &[name, value] : m_exposed)
                    if (value != (ScalarFloat) water().number(name))
                        m_options->set_number(name, value);
                m_water.emplace(m_options->configure(varied()));
            });
        } catch (...) {
            // A refused value leaves the sea as it was.
            for (auto &[name, value] : m_exposed)
                m_options->set_number(name, water().number(name));
            apply();
            throw;
        }
        apply();
    }

    std::pair<BSDFSample3f, Spectrum> sample(const BSDFContext &ctx, const SurfaceInteraction3f &si, Float sample1,
                                             const Point2f &sample2, Mask active) const override {
        MI_MASKED_FUNCTION(ProfilerPhase::BSDFSample, active);

        active &= Frame3f::cos_theta(si.wi) > 0.f;
        Enabled on = enabled(ctx);
        if (unlikely(on.none() || dr::none_or<false>(active)))
            return { dr::zeros<BSDFSample3f>(), 0.f };
        return sample(on, here(si, active), si, sample1, sample2, active);
    }

    Spectrum eval(const BSDFContext &ctx, const SurfaceInteraction3f &si, const Vector3f &wo,
                  Mask active) const override {
        MI_MASKED_FUNCTION(ProfilerPhase::BSDFEvaluate, active);

        Enabled on = enabled(ctx);
        if (unlikely(on.none() || dr::none_or<false>(active)))
            return 0.f;
        return eval_pdf<true, false>(on, here(si, active), si, wo, active).first;
    }

    Float pdf(const BSDFContext &ctx, const SurfaceInteraction3f &si, const Vector3f &wo,
              Mask active) const override {
        MI_MASKED_FUNCTION(ProfilerPhase::BSDFEvaluate, active);

        Enabled on = enabled(ctx);
        if (unlikely(on.none() || dr::none_or<false>(active)))
            return 0.f;
        return eval_pdf<false, true>(on, here(si, active), si, wo, active).second;
    }

    std::pair<Spectrum, Float> eval_pdf(const BSDFContext &ctx, const SurfaceInteraction3f &si, const Vector3f &wo,
                                        Mask active) const override {
        MI_MASKED_FUNCTION(ProfilerPhase::BSDFEvaluate, active);

        Enabled on = enabled(ctx);
        if (unlikely(on.none() || dr::none_or<false>(active)))
            return { 0.f, 0.f };
        return eval_pdf<true, true>(on, here(si, active), si, wo, active);
    }

    std::tuple<Spectrum, Float, BSDFSample3f, Spectrum>
    eval_pdf_sample(const BSDFContext &ctx, const SurfaceInteraction3f &si, const Vector3f &wo, Float sample1,
                    const Point2f &sample2, Mask active) const override {
        MI_MASKED_FUNCTION(ProfilerPhase::BSDFSample, active);

        Enabled on = enabled(ctx);
        if (unlikely(on.none() || dr::none_or<false>(active)))
            return { 0.f, 0.f, dr::zeros<BSDFSample3f>(), 0.f };
        Here at = here(si, active);
        auto [value, pdf] = eval_pdf<true, true>(on, at, si, wo, active);
        active &= Frame3f::cos_theta(si.wi) > 0.f;
        auto [bs, weight] = sample(on, at, si, sample1, sample2, active);
        return { value, pdf, bs, weight };
    }

    Spectrum eval_diffuse_reflectance(const SurfaceInteraction3f &si, Mask active) const override {
        Float whitecaps = whitecap_share(here(si, active));
        UnpolarizedSpectrum diffuse = m_whitecap_brdf * dr::Pi<ScalarFloat> * whitecaps;
        if (m_water_leaving)
            diffuse += within_one(m_water_leaving->eval(si, active)) * (1.f - whitecaps);
        return depolarizer<Spectrum>(diffuse) & active;
    }

    // Numbers are read by the base class where their type is the traced one, which it is in scalar variants alone.
    UnpolarizedSpectrum eval_attribute(const std::string &name, const SurfaceInteraction3f &si, Mask active) const override {
        const ScalarFloat *number = exposed(name);
        return number ? dr::select(active, UnpolarizedSpectrum(*number), 0.f) : Base::eval_attribute(name, si, active);
    }

    Float eval_attribute_1(const std::string &name, const SurfaceInteraction3f &si, Mask active) const override {
        const ScalarFloat *number = exposed(name);
        return number ? dr::select(active, Float(*number), 0.f) : Base::eval_attribute_1(name, si, active);
    }

    Color3f eval_attribute_3(const std::string &name, const SurfaceInteraction3f &si, Mask active) const override {
        const ScalarFloat *number = exposed(name);
        return number ? dr::select(active, Color3f(*number), 0.f) : Base::eval_attribute_3(name, si, active);
    }

    std::string to_string() const override {
        std::ostringstream text;
        text << "ProbWater[\n  " << string::indent(std::string(water().describe()), 2);
        if (m_whitecap_texture)
            text << "\n  # whitecaps = a texture";
        if (m_water_leaving) {
            std::string reflectance = m_water_leaving->to_string();
            std::replace(reflectance.begin(), reflectance.end(), '\n', ' ');
            text << "\n  # water_leaving = " << reflectance;
        }
        text << "\n]";
        return text.str();
    }

    MI_DECLARE_CLASS(ProbWater)

private:
    /// Numbers that traverse() exposes, where they are set and matter.
    static constexpr const char *Exposed[] = { "wind_speed", "wind_height", "friction_velocity", "beaufort",
                                               "wind_direction", "footprint", "time", "wavelength", "ior" };

    /// The lobes that a context asks for, whether light from below takes part, and whether wo is the way to the light (on a
    /// path from the camera) or the light's own.
    struct Enabled {
        Parts parts;
        bool below, to_light;
        bool none() const { return parts.none() && !below; }
    };

    /// The water at a place: for traced variants its lobe and wave normal; for scalar ones the core's, empty where all
    /// places are alike.
    struct TracedPlace {
        typename Replay::Inputs inputs;
    };
    struct ScalarPlace {
        ProbWaterSpot spot;
    };
    /// The light from below: the water's reflectance, and the share of draws that go to it, by what each reflects, roughly.
    struct Below {
        UnpolarizedSpectrum reflectance;
        Float share;
    };
    using Here = std::conditional_t<dr::is_jit_v<Float>, TracedPlace, ScalarPlace>;

    static Spectrum spectrum(const UnpolarizedSpectrum &value) { return depolarizer<Spectrum>(value); }

    /// Runs a call into the core; its errors become Mitsuba's.
    template <typename Call> static auto refuse(Call call) {
        try {
            return call();
        } catch (const rust::Error &e) {
            Throw("prob_water: %s", e.what());
        }
    }

    /// Takes over the parameters of the vocabulary that are given.
    void take(const Properties &props) {
        refuse([&] {
            auto word = [&](const std::string &name, const auto &value) {
                m_given.push_back(name);
                if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::string>) {
                    if (name == "footprint" && value == "pixel") {
                        m_pixel = true;
                        return;
                    }
                }
                prob_water::set_word(*m_options)(name, value);
            };
            auto object = [&](const std::string &name) {
                m_given.push_back(name);
                if (name == "footprint")
                    m_footprint = props.get_unbounded_texture<Texture>(name);
                else if (name == "whitecaps")
                    m_whitecap_texture = props.get_texture<Texture>(name);
                else
                    Throw("prob_water: %s is an object or an array: allowed is a plain number, true or false, or a word", name);
            };
            prob_water::words(props, prob_water::vocabulary(), word, object);
        });
    }

    const prob_water::Water &water() const { return **m_water; }

    const ScalarFloat *exposed(const std::string &wanted) const {
        for (auto &[name, value] : m_exposed)
            if (name == wanted)
                return &value;
        return nullptr;
    }

    /// Refuses a water_leaving that is no share of the light, and gives back what it was; what varies is held within 0 and 1
    /// where it is evaluated.
    void check_water_leaving() {
        struct Numbers final : TraversalCallback {
            std::vector<Float *> found;
            void put_value(std::string_view, void *value, uint32_t, const std::type_info &type) override {
                if (type == typeid(Float) && dr::width(*(Float *) value) == 1)
                    found.push_back((Float *) value);
                // Colours of spectral variants are coefficients.
                if (!is_spectral_v<Spectrum> && type == typeid(Color3f))
                    for (size_t k = 0; k < 3; ++k)
                        found.push_back(&(*(Color3f *) value)[k]);
            }
            void put_object(std::string_view, Object *, uint32_t) override { }
        } numbers;
        if (!m_water_leaving || m_water_leaving->is_spatially_varying())
            return;
        m_water_leaving->traverse(&numbers);
        std::vector<ScalarFloat> shares;
        for (Float *number : numbers.found)
            shares.push_back((ScalarFloat) dr::slice(dr::detach(*number)));
        auto wrong = std::find_if(shares.begin(), shares.end(), [](ScalarFloat x) { return !(x >= 0.f && x <= 1.f); });
        if (wrong == shares.end()) {
            m_shares = shares;
            return;
        }
        for (size_t k = 0; k < m_shares.size(); ++k)
            *numbers.found[k] = dr::opaque<Float>(m_shares[k]);
        m_water_leaving->parameters_changed();
        Throw("prob_water: water_leaving = %s is out of range: allowed is 0 to 1", *wrong);
    }

    /// How the footprint changes from place to place; empty where it does not.
    std::string varied() const { return m_pixel ? "pixel" : m_footprint ? "a texture" : ""; }
    bool varies() const { return m_pixel || m_footprint; }

    void configure() {
        m_water.emplace(refuse([&] { return m_options->configure(varied()); }));
        for (const rust::String &warning : water().warnings())
            Log(Warn, "prob_water: %s", std::string(warning));
        bool drawn = water().kind() == prob_water::Kind::Instance;
        m_exposed.clear();
        for (const std::string name : Exposed)
            if (!std::isnan(water().number(name)) && (name != "footprint" || !varies()) &&
                (name != "time" || drawn) && (!m_lent || name == "wavelength" || name == "ior"))
                m_exposed.emplace_back(name, 0.f);
        apply();
        bool ensemble = water().kind() == prob_water::Kind::Ensemble;
        if (m_whitecap_texture && (ensemble || water().kind() == prob_water::Kind::Empirical))
            Throw("prob_water: whitecaps = a texture is out of range: allowed is true or false with surface = %s",
                  ensemble ? "ensemble" : "empirical");
    }

    /// Takes over what the configured sea says.
    void apply() {
        const prob_water::Water &water = this->water();
        for (auto &[name, value] : m_exposed)
            value = (ScalarFloat) water.number(name);

        prob_water::Cover cover = water.cover();
        m_whitecap_brdf = dr::opaque<Float>(cover.brdf);
        m_whitecap_fraction = dr::opaque<Float>(cover.fraction);
        m_facet_albedo_floor = cover.facet_albedo_floor;
        m_own_footprint = (ScalarFloat) water.number("footprint");
        m_drawn_waves = water.kind() == prob_water::Kind::Instance;
        m_from_afar = water.kind() == prob_water::Kind::Ensemble || water.kind() == prob_water::Kind::Empirical;
        m_places = m_drawn_waves || m_whitecap_texture || varies();
        if constexpr (dr::is_jit_v<Float>) {
            m_replay = Replay(water.kernels(m_whitecap_texture.get() != nullptr));
            m_drawn = Drawn(water.drawn_waves());
            // Copies from here to there keep their memory up to the next kernel, or to this.
            dr::sync_thread();
        }
        m_whitecaps = m_whitecap_texture || cover.whitecaps;

        m_components.clear();
        uint32_t where = +BSDFFlags::FrontSide;
        if (m_places)
            where |= +BSDFFlags::SpatiallyVarying;
        if (m_pixel)
            where |= +BSDFFlags::NeedsDifferentials;
        m_components.push_back(BSDFFlags::GlossyReflection | BSDFFlags::Anisotropic | where);
        m_flags = m_components[0];
        if (m_whitecaps || m_water_leaving) {
            if (m_water_leaving)
                where |= +BSDFFlags::SpatiallyVarying;
            m_components.push_back(+BSDFFlags::DiffuseReflection | where);
            m_flags = m_flags | m_components[1];
        }
    }

    Enabled enabled(const BSDFContext &ctx) const {
        bool diffuse = m_components.size() > 1 && ctx.is_enabled(BSDFFlags::DiffuseReflection, 1);
        return { { ctx.is_enabled(BSDFFlags::GlossyReflection, 0), m_whitecaps && diffuse }, m_water_leaving && diffuse,
                 ctx.mode == TransportMode::Radiance };
    }

    /// The facets' footprint at a place.
    Float footprint(const SurfaceInteraction3f &si, Mask active) const {
        Float d;
        if (m_pixel) {
            // Of a square as large as the pixel on the water.
            Vector3f x = dr::fmadd(si.dp_du, si.duv_dx.x(), si.dp_dv * si.duv_dx.y()),
                     y = dr::fmadd(si.dp_du, si.duv_dy.x(), si.dp_dv * si.duv_dy.y());
            d = dr::sqrt(dr::norm(dr::cross(x, y)));
            Float seen = m_own_footprint;
            if (m_pixel_angle > 0.f)
                seen = m_pixel_angle * si.t * dr::rsqrt(dr::maximum(si.wi.z(), 1e-4f));
            d = dr::select(d > 0.f, d, seen);
        } else {
            // What is no length is as small as can be.
            d = prob_water::larger(m_footprint->eval_1(si, active), 1e-30f);
        }
        // Shorter waves than the sea's are not drawn.
        return m_drawn_waves ? dr::maximum(d, m_own_footprint) : d;
    }

    Here here(const SurfaceInteraction3f &si, Mask active) const {
        Here at;
        auto along = [&](const Vector3f &v) {
            return dr::fmadd(Wide(v.x()), Wide(si.p.x()),
                             dr::fmadd(Wide(v.y()), Wide(si.p.y()), Wide(v.z()) * Wide(si.p.z())));
        };
        if constexpr (dr::is_jit_v<Float>) {
            at.inputs.whitecap = m_whitecap_fraction;
            Float &d = at.inputs.footprint, &share = at.inputs.whitecap;
            if (varies())
                d = footprint(si, active);
            if (m_drawn_waves) {
                auto [n, whitecap] = m_drawn.at(along(si.sh_frame.s), along(si.sh_frame.t), varies() ? &d : nullptr, m_replay);
                at.inputs.normal = n;
                share = m_whitecaps ? whitecap : Float(0.f);
            }
            if (m_whitecap_texture)
                share = within_one(m_whitecap_texture->eval_1(si, active));
        } else if (m_places) {
            constexpr float None = std::numeric_limits<float>::quiet_NaN();
            ProbWaterPlace place{ { 0., 0. }, None, None };
            if (m_drawn_waves) {
                place.place[0] = along(si.sh_frame.s);
                place.place[1] = along(si.sh_frame.t);
            }
            if (varies())
                place.footprint = footprint(si, active);
            if (m_whitecap_texture)
                place.whitecaps = within_one(m_whitecap_texture->eval_1(si, active));
            prob_water_spot(&water(), &place, &at.spot);
        }
        return at;
    }

    /// Within 0 and 1; what is no number is 0.
    template <typename T> static T within_one(const T &value) {
        return prob_water::smaller(prob_water::larger(value, 0.f), 1.f);
    }

    Float whitecap_share(const Here &at) const {
        if constexpr (dr::is_jit_v<Float>)
            return at.inputs.whitecap;
        else
            return m_places ? prob_water_spot_whitecaps(&at.spot) : m_whitecap_fraction;
    }

    /// The result of a program of the core's, for a path between two directions.
    Float run(typename Replay::Program program, Enabled on, const Here &at, const Vector3f &wi, const Vector3f &wo) const {
        typename Replay::Inputs inputs = at.inputs;
        // The order matters to means alone; the density is of draws from wi, whichever way the light goes.
        bool turned = program != Replay::Pdf && on.to_light && m_from_afar;
        inputs.source = turned ? wo : wi;
        inputs.observer = turned ? wi : wo;
        inputs.cosine = wo.z();
        return m_replay.run(program, on.parts, inputs)[0];
    }

    /// rho of the cosine of an angle.
    Float rho(const Float &cos) const {
        if constexpr (dr::is_jit_v<Float>)
            return m_replay.reflectance(cos);
        else
            return prob_water_reflectance(&water(), cos);
    }

    /// f cos(theta_o) and density of facets and whitecaps, as far as wanted.
    template <bool Value, bool Pdf>
    std::pair<Float, Float> surface(Enabled on, const Here &at, const Vector3f &wi, const Vector3f &wo) const {
        if constexpr (dr::is_jit_v<Float>) {
            return { Value ? run(Replay::Eval, on, at, wi, wo) : 0.f, Pdf ? run(Replay::Pdf, on, at, wi, wo) : 0.f };
        } else {
            const prob_water::Water *sea = &water();
            uint32_t bits = on.parts.bits();
            if (m_places)
                return { Value ? prob_water_spot_eval(&at.spot, bits, wi.data(), wo.data()) : 0.f,
                         Pdf ? prob_water_spot_pdf(&at.spot, bits, wi.data(), wo.data()) : 0.f };
            return { Value ? prob_water_bsdf_eval(sea, bits, wi.data(), wo.data(), on.to_light) : 0.f,
                     Pdf ? prob_water_bsdf_pdf(sea, bits, wi.data(), wo.data()) : 0.f };
        }
    }

    /// The same with the light from below.
    template <bool Value, bool Pdf>
    std::pair<Spectrum, Float> eval_pdf(Enabled on, const Here &at, const SurfaceInteraction3f &si, const Vector3f &wo,
                                        Mask active) const {
        if (on.below)
            return eval_pdf<Value, Pdf>(on, at, si, wo, below(on, at, si, active), active);
        auto [value, pdf] = surface<Value, Pdf>(on, at, si.wi, wo);
        return { spectrum(value) & active, dr::select(active, pdf, 0.f) };
    }

    template <bool Value, bool Pdf>
    std::pair<Spectrum, Float> eval_pdf(Enabled on, const Here &at, const SurfaceInteraction3f &si, const Vector3f &wo,
                                        const Below &below, Mask active) const {
        auto [value, pdf] = surface<Value, Pdf>(on, at, si.wi, wo);
        if (Pdf)
            pdf = dr::lerp(pdf, cosine_pdf(si.wi, wo), below.share);
        return { spectrum(value + from_below(at, si.wi, wo, below.reflectance)) & active, dr::select(active, pdf, 0.f) };
    }

    std::pair<BSDFSample3f, Spectrum> sample(Enabled on, const Here &at, const SurfaceInteraction3f &si, Float sample1,
                                             const Point2f &sample2, Mask active) const {
        BSDFSample3f bs = dr::zeros<BSDFSample3f>();
        Below below;
        Mask diffuse = false;
        if (on.below) {
            below = this->below(on, at, si, active);
            diffuse = sample1 < below.share;
            Float rest = (sample1 - below.share) * dr::rcp(dr::maximum(1.f - below.share, 1e-9f));
            sample1 = dr::select(diffuse, 0.f, dr::minimum(rest, dr::OneMinusEpsilon<Float>));
        }

        Float value = 0.f;
        Mask whitecap = false;
        if (!on.parts.none()) {
            if constexpr (dr::is_jit_v<Float>) {
                typename Replay::Inputs inputs = at.inputs;
                inputs.source = si.wi;
                inputs.random = { sample1, sample2.x(), sample2.y() };
                auto drawn = m_replay.run(Replay::Draw, on.parts, inputs);
                bs.wo = { drawn[0], drawn[1], drawn[2] };
                whitecap = drawn[3] > 0.f;
            } else if (!diffuse) {
                float u[3] = { sample1, sample2.x(), sample2.y() };
                ProbWaterSample s{};
                if (m_places)
                    prob_water_spot_sample(&at.spot, on.parts.bits(), si.wi.data(), u, &s);
                else
                    prob_water_bsdf_sample(&water(), on.parts.bits(), si.wi.data(), u, on.to_light, &s);
                bs.wo = Vector3f(s.direction[0], s.direction[1], s.direction[2]);
                bs.pdf = s.pdf;
                value = s.value;
                whitecap = s.whitecap;
            }
        }
        if (on.below) {
            Vector3f wo = warp::square_to_cosine_hemisphere(sample2);
            bs.wo = dr::select(diffuse, wo, bs.wo);
            auto [total, pdf] = eval_pdf<true, true>(on, at, si, bs.wo, below, active);
            bs.pdf = pdf;
            active &= bs.pdf > 0.f;
            return finish(bs, total / bs.pdf, diffuse || whitecap, active);
        }
        if constexpr (dr::is_jit_v<Float>) {
            // A weight divides two Gaussians: it needs no digits to spare.
            bs.pdf = run(Replay::Pdf, on, at, si.wi, bs.wo);
            value = run(Replay::Weight, on, at, si.wi, bs.wo);
        }
        active &= bs.pdf > 0.f;
        return finish(bs, spectrum(value / bs.pdf), whitecap, active);
    }

    static std::pair<BSDFSample3f, Spectrum> finish(BSDFSample3f bs, const Spectrum &weight, Mask diffuse, Mask active) {
        bs.eta = 1.f;
        bs.sampled_component = dr::select(diffuse, UInt32(1), UInt32(0));
        bs.sampled_type = dr::select(diffuse, UInt32(+BSDFFlags::DiffuseReflection),
                                     UInt32(+BSDFFlags::GlossyReflection));
        return { bs, weight & active };
    }

    /// f cos(theta_o) of the light from below: what level water lets in and out again.
    UnpolarizedSpectrum from_below(const Here &at, const Vector3f &wi, const Vector3f &wo,
                                   const UnpolarizedSpectrum &reflectance) const {
        auto through = [&](const Float &cos) { return 1.f - this->rho(dr::clip(cos, 0.f, 1.f)); };
        Float factor = through(wi.z()) * through(wo.z()) * (1.f - whitecap_share(at)) * cosine_pdf(wi, wo);
        return reflectance * factor;
    }

    static Float cosine_pdf(const Vector3f &wi, const Vector3f &wo) {
        return dr::select(wi.z() > 0.f, dr::maximum(wo.z(), 0.f) * dr::InvPi<Float>, 0.f);
    }

    /// The light from below at a place.
    Below below(Enabled on, const Here &at, const SurfaceInteraction3f &si, Mask active) const {
        UnpolarizedSpectrum reflectance = within_one(m_water_leaving->eval(si, active));
        if (on.parts.none())
            return { reflectance, 1.f };
        Float rho = this->rho(dr::clip(si.wi.z(), 0.f, 1.f)), foam = whitecap_share(at),
              below = dr::mean(reflectance) * (1.f - rho) * (1.f - foam),
              rest = (on.parts.facets ? (1.f - foam) * (rho + m_facet_albedo_floor) : Float(0.f)) +
                     (on.parts.whitecaps ? foam * m_whitecap_brdf * dr::Pi<Float> : Float(0.f));
        return { reflectance, below / dr::maximum(below + rest, 1e-9f) };
    }

    rust::Box<prob_water::Options> m_options;
    std::optional<rust::Box<prob_water::Water>> m_water;
    std::vector<std::string> m_given;
    std::vector<std::pair<std::string, ScalarFloat>> m_exposed;
    ref<Texture> m_footprint, m_whitecap_texture, m_water_leaving;
    std::vector<ScalarFloat> m_shares;
    ScalarFloat m_own_footprint = 0.f, m_pixel_angle = 0.f;
    bool m_pixel = false, m_whitecaps = false, m_drawn_waves = false, m_places = false, m_lent = false;
    bool m_from_afar = false;
    ScalarFloat m_facet_albedo_floor = 0.f;
    Float m_whitecap_brdf = 0.f, m_whitecap_fraction = 0.f;
    Replay m_replay;
    Drawn m_drawn;

    MI_TRAVERSE_CB(Base, m_footprint, m_whitecap_texture, m_water_leaving, m_whitecap_brdf, m_whitecap_fraction, m_replay, m_drawn)
};

extern "C" MI_EXPORT void init_plugin(std::string_view name, PluginRegisterFn fn) {
    prob_water::check_compatible();
    MI_REGISTER_PLUGIN(fn, name, ProbWater);
}

NAMESPACE_END(mitsuba)
