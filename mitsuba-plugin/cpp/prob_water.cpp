#include "compatible.h"

#include <mitsuba/core/fresolver.h>
#include <mitsuba/core/properties.h>
#include <mitsuba/core/warp.h>
#include <mitsuba/render/bsdf.h>
#include <mitsuba/render/mueller.h>
#include <mitsuba/render/texture.h>
#include <algorithm>
#include <mutex>
#include <optional>
#include <sstream>

#include "prob-water-mitsuba/src/lib.rs.h"
#include "rust/cxx.h"

#include "place.h"
#include "sea.h"
#include "words.h"

NAMESPACE_BEGIN(mitsuba)

// Parameters and examples: mitsuba-plugin/docs/prob_water.rst.
template <typename Float, typename Spectrum>
class ProbWater final : public BSDF<Float, Spectrum>, public prob_water::TakesSea {
public:
    MI_IMPORT_BASE(BSDF, m_flags, m_components)
    MI_IMPORT_TYPES(Texture)

    using Request = prob_water::Request;
    using Sea = prob_water::Sea<Float>;
    using Place = typename Sea::Place;

    static constexpr prob_water::Variant variant{ dr::is_jit_v<Float>, is_polarized_v<Spectrum>, is_spectral_v<Spectrum> };

    ProbWater(const Properties &props) : Base(props), m_options(prob_water::options()) {
        if (props.has_property("water_leaving"))
            m_water_leaving = props.get_texture<Texture>("water_leaving");
        check_water_leaving();
        refuse([&] {
            take(props);
            take_water_body(m_options->water_body());
            if (props.has_property("table"))
                m_options->set_text("table", file_resolver()->resolve(props.get<std::string_view>("table")).string());
        });
        configure();
    }

    void take_sea(const Properties &sea) override {
        // Scenes load on several threads.
        static std::mutex mutex;
        std::lock_guard<std::mutex> guard(mutex);
        refuse([&] {
            m_options->lend();
            take(sea);
        });
        configure();
    }

    void set_time(double time) override { (*m_water)->set_time(time); }

    void traverse(TraversalCallback *cb) override {
        for (prob_water::Number &number : m_exposed)
            cb->put(std::string(number.name), number.value, ParamFlags::NonDifferentiable);
        if (m_footprint)
            cb->put("footprint", m_footprint, ParamFlags::NonDifferentiable);
        if (m_whitecap_texture)
            cb->put("whitecaps", m_whitecap_texture, ParamFlags::NonDifferentiable);
        if (m_ior)
            cb->put("ior", m_ior, ParamFlags::NonDifferentiable);
        if (m_water_leaving)
            cb->put("water_leaving", m_water_leaving, ParamFlags::Differentiable);
    }

    void parameters_changed(const std::vector<std::string> & /*keys*/) override {
        try {
            check_water_leaving();
            refuse([&] { m_water.emplace(m_options->change({ m_exposed.data(), m_exposed.size() }, variant)); });
        } catch (...) {
            // A refused value leaves the sea as it was.
            apply();
            throw;
        }
        apply();
    }

    std::pair<BSDFSample3f, Spectrum> sample(const BSDFContext &ctx, const SurfaceInteraction3f &si, Float sample1,
                                             const Point2f &sample2, Mask active) const override {
        MI_MASKED_FUNCTION(ProfilerPhase::BSDFSample, active);
        active &= Frame3f::cos_theta(si.wi) > 0.f;
        auto at = local(ctx, si, active);
        return at ? draw(*at, sample1, sample2, active) : std::pair(dr::zeros<BSDFSample3f>(), Spectrum(0.f));
    }

    Spectrum eval(const BSDFContext &ctx, const SurfaceInteraction3f &si, const Vector3f &wo, Mask active) const override {
        MI_MASKED_FUNCTION(ProfilerPhase::BSDFEvaluate, active);
        auto at = local(ctx, si, active);
        return at ? value(*at, wo) & active : 0.f;
    }

    Float pdf(const BSDFContext &ctx, const SurfaceInteraction3f &si, const Vector3f &wo, Mask active) const override {
        MI_MASKED_FUNCTION(ProfilerPhase::BSDFEvaluate, active);
        auto at = local(ctx, si, active);
        return at ? dr::select(active, density(*at, wo), 0.f) : 0.f;
    }

    std::pair<Spectrum, Float> eval_pdf(const BSDFContext &ctx, const SurfaceInteraction3f &si, const Vector3f &wo,
                                        Mask active) const override {
        MI_MASKED_FUNCTION(ProfilerPhase::BSDFEvaluate, active);
        auto at = local(ctx, si, active);
        if (!at)
            return { 0.f, 0.f };
        return { value(*at, wo) & active, dr::select(active, density(*at, wo), 0.f) };
    }

    std::tuple<Spectrum, Float, BSDFSample3f, Spectrum>
    eval_pdf_sample(const BSDFContext &ctx, const SurfaceInteraction3f &si, const Vector3f &wo, Float sample1,
                    const Point2f &sample2, Mask active) const override {
        MI_MASKED_FUNCTION(ProfilerPhase::BSDFSample, active);
        auto at = local(ctx, si, active);
        if (!at)
            return { 0.f, 0.f, dr::zeros<BSDFSample3f>(), 0.f };
        auto [bs, weight] = draw(*at, sample1, sample2, active && Frame3f::cos_theta(si.wi) > 0.f);
        return { value(*at, wo) & active, dr::select(active, density(*at, wo), 0.f), bs, weight };
    }

    Spectrum eval_diffuse_reflectance(const SurfaceInteraction3f &si, Mask active) const override {
        auto [whitecaps, smooth] = place(si, active).diffuse();
        UnpolarizedSpectrum diffuse = whitecaps;
        if (m_traits.lanes)
            diffuse *= lanes(si, active).second;
        if (m_water_leaving)
            diffuse += within_one(m_water_leaving->eval(si, active)) * smooth;
        return depolarizer<Spectrum>(diffuse) & active;
    }

    // The base class reads numbers of the traced type alone.
    UnpolarizedSpectrum eval_attribute(const std::string &name, const SurfaceInteraction3f &si, Mask active) const override {
        const double *number = exposed(name);
        return number ? dr::select(active, UnpolarizedSpectrum(*number), 0.f) : Base::eval_attribute(name, si, active);
    }

    Float eval_attribute_1(const std::string &name, const SurfaceInteraction3f &si, Mask active) const override {
        const double *number = exposed(name);
        return number ? dr::select(active, Float(*number), 0.f) : Base::eval_attribute_1(name, si, active);
    }

    Color3f eval_attribute_3(const std::string &name, const SurfaceInteraction3f &si, Mask active) const override {
        const double *number = exposed(name);
        return number ? dr::select(active, Color3f(*number), 0.f) : Base::eval_attribute_3(name, si, active);
    }

    std::string to_string() const override {
        std::ostringstream text;
        text << "ProbWater[\n  " << string::indent(std::string((*m_water)->describe()), 2);
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
    /// Runs a call into the core; its errors become Mitsuba's.
    template <typename Call> static auto refuse(Call call) {
        try {
            return call();
        } catch (const rust::Error &e) {
            Throw("prob_water: %s", e.what());
        }
    }

    /// Takes over the parameters that are given.
    void take(const Properties &props) {
        prob_water::set_words(props, prob_water::vocabulary(), *m_options, [&](const std::string &name) {
            m_options->set_object(name);
            if (name == "footprint")
                m_footprint = props.get_unbounded_texture<Texture>(name);
            else if (name == "ior")
                m_ior = props.get_unbounded_texture<Texture>(name);
            else
                m_whitecap_texture = props.get_texture<Texture>(name);
        });
    }

    /// Takes over the reflectance of a water body by its chlorophyll.
    void take_water_body(const rust::Vec<double> &reflectance) {
        if (reflectance.empty())
            return;
        if (m_water_leaving)
            Throw("prob_water: chlorophyll and water_leaving are both given: one of them is the water body");
        Properties body;
        body.set("reflectance", Properties::Spectrum({ reflectance.begin(), reflectance.end() }, 360.0, 830.0));
        m_water_leaving = body.get_texture<Texture>("reflectance");
    }

    const double *exposed(const std::string &name) const {
        for (const prob_water::Number &number : m_exposed)
            if (name == std::string_view(number.name.data(), number.name.size()))
                return &number.value;
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

    void configure() {
        m_water.emplace(refuse([&] { return m_options->configure(variant); }));
        for (const rust::String &warning : (*m_water)->warnings())
            Log(Warn, "prob_water: %s", std::string(warning));
        m_exposed = (*m_water)->exposed();
        apply();
    }

    /// Takes over what the configured sea says.
    void apply() {
        const prob_water::Water &water = **m_water;
        // In place: parameters that were traversed keep pointers.
        rust::Vec<prob_water::Number> exposed = water.exposed();
        for (size_t k = 0; k < m_exposed.size(); ++k)
            m_exposed[k].value = exposed[k].value;
        m_traits = water.traits();
        m_sea = Sea(water);

        m_components.clear();
        uint32_t where = +BSDFFlags::FrontSide;
        if (m_traits.drawn || m_traits.whitecap_texture || m_traits.varying_footprint || m_ior)
            where |= +BSDFFlags::SpatiallyVarying;
        if (m_traits.pixel)
            where |= +BSDFFlags::NeedsDifferentials;
        m_components.push_back(BSDFFlags::GlossyReflection | BSDFFlags::Anisotropic | where);
        m_flags = m_components[0];
        if (m_traits.whitecaps || m_water_leaving) {
            if (m_water_leaving)
                where |= +BSDFFlags::SpatiallyVarying;
            m_components.push_back(+BSDFFlags::DiffuseReflection | where);
            m_flags = m_flags | m_components[1];
        }
    }

    Request request(const BSDFContext &ctx) const {
        bool diffuse = m_components.size() > 1 && ctx.is_enabled(BSDFFlags::DiffuseReflection, 1);
        return { ctx.is_enabled(BSDFFlags::GlossyReflection, 0), m_traits.whitecaps && diffuse,
                 m_water_leaving && diffuse, ctx.mode == TransportMode::Radiance };
    }

    /// The facets' footprint at a place.
    Float footprint(const SurfaceInteraction3f &si, Mask active) const {
        Float d;
        if (m_traits.pixel) {
            // Side of a square as large as the pixel on the water.
            Vector3f x = dr::fmadd(si.dp_du, si.duv_dx.x(), si.dp_dv * si.duv_dx.y()),
                     y = dr::fmadd(si.dp_du, si.duv_dy.x(), si.dp_dv * si.duv_dy.y());
            d = m_traits.diameter * dr::sqrt(dr::norm(dr::cross(x, y)));
            Float by_angle = m_traits.footprint;
            if (m_traits.pixel_angle > 0.f)
                by_angle = m_traits.diameter * m_traits.pixel_angle * si.t * dr::rsqrt(prob_water::larger(si.wi.z(), 1e-4f));
            d = dr::select(d > 0.f, d, by_angle);
        } else {
            // What is no length is as small as can be.
            d = prob_water::larger(m_traits.diameter * m_footprint->eval_1(si, active), 1e-30f);
        }
        // Shorter waves than the sea's are not drawn.
        return m_traits.drawn ? prob_water::larger(d, m_traits.footprint) : d;
    }

    Place place(const SurfaceInteraction3f &si, Mask active) const {
        prob_water::Where<Float> where;
        if (m_traits.drawn) {
            using Extended = decltype(where.x);
            auto along = [&](const Vector3f &v) {
                return dr::fmadd(Extended(v.x()), Extended(si.p.x()),
                                 dr::fmadd(Extended(v.y()), Extended(si.p.y()), Extended(v.z()) * Extended(si.p.z())));
            };
            where.x = along(si.sh_frame.s);
            where.y = along(si.sh_frame.t);
        }
        if (m_traits.varying_footprint)
            where.footprint = footprint(si, active);
        if (m_whitecap_texture)
            where.whitecap = within_one(m_whitecap_texture->eval_1(si, active));
        return m_sea.at(where);
    }

    /// Within 0 and 1; what is no number is 0.
    template <typename T> static T within_one(const T &value) {
        return prob_water::smaller(prob_water::larger(value, 0.f), 1.f);
    }

    /// The index of every lane, and the whitecaps' BRDF there over the sea's.
    std::pair<UnpolarizedSpectrum, UnpolarizedSpectrum> lanes(const SurfaceInteraction3f &si, Mask active) const {
        UnpolarizedSpectrum index = 0.f, whitecaps = 1.f;
        if constexpr (is_spectral_v<Spectrum>)
            std::tie(index, whitecaps) = m_sea.lanes(UnpolarizedSpectrum(si.wavelengths));
        if (m_ior)
            index = prob_water::larger(m_ior->eval(si, active), 1.f);
        return { index, whitecaps };
    }

    /// The water as an interaction sees it.
    struct Local {
        Request on;
        Place place;
        Vector3f wi;
        /// Of the water body.
        UnpolarizedSpectrum reflectance = 0.f;
        /// Share of draws that go to it.
        Float share = 0.f;
        /// Where lanes differ: what `lanes` gives.
        UnpolarizedSpectrum index = 0.f, whitecaps = 1.f;
    };

    /// Nothing where nothing is asked for.
    std::optional<Local> local(const BSDFContext &ctx, const SurfaceInteraction3f &si, Mask active) const {
        Request on = request(ctx);
        if (unlikely(on.none() || dr::none_or<false>(active)))
            return std::nullopt;
        Local at{ on, place(si, active), si.wi };
        if (m_traits.lanes)
            std::tie(at.index, at.whitecaps) = lanes(si, active);
        if (on.water_leaving) {
            at.reflectance = within_one(m_water_leaving->eval(si, active));
            at.share = on.surface() ? at.place.water_leaving_share(on, si.wi, dr::mean(at.reflectance)) : Float(1.f);
        }
        return at;
    }

    /// Whether facets and whitecaps differ by more than their number: in polarisation or between lanes.
    bool apart() const { return is_polarized_v<Spectrum> || m_traits.lanes; }

    /// f cos(theta_o), 1/sr.
    Spectrum value(const Local &at, const Vector3f &wo) const {
        std::pair<Float, Float> surface(0.f, 0.f);
        if (at.on.surface())
            surface = at.place.eval(at.on, at.wi, wo, apart());
        return light(at, wo, surface.first, surface.second);
    }

    /// The same, for what facets and whitecaps reflect of light without polarisation at the sea's own wavelength.
    Spectrum light(const Local &at, const Vector3f &wo, UnpolarizedSpectrum facets, const Float &whitecaps) const {
        UnpolarizedSpectrum diffuse = at.whitecaps * whitecaps;
        if (m_traits.lanes && at.on.facets)
            facets *= at.place.lane_reflectances(at.wi, wo, at.index);
        Float below = 0.f;
        for (size_t k = 0; at.on.water_leaving && k < dr::size_v<UnpolarizedSpectrum>; ++k) {
            if (k == 0 || m_traits.lanes)
                below = at.place.water_leaving(at.wi, wo, at.index[k]).first;
            diffuse[k] += at.reflectance[k] * below;
        }
        if constexpr (is_polarized_v<Spectrum>)
            return polarised(at, wo, facets) + depolarizer<Spectrum>(diffuse);
        else
            return facets + diffuse;
    }

    /// The Mueller matrix of what facets reflect, in Mitsuba's frames.
    Spectrum polarised(const Local &at, const Vector3f &wo, const UnpolarizedSpectrum &facets) const {
        UnpolarizedSpectrum m[3];
        Vector3f of_lane = 0.f;
        for (size_t k = 0; k < dr::size_v<UnpolarizedSpectrum>; ++k) {
            if (k == 0 || m_traits.lanes)
                of_lane = at.place.polarisation(at.wi, wo, at.index[k]);
            for (size_t j = 0; j < 3; ++j)
                m[j][k] = facets[k] * of_lane[j];
        }
        Spectrum matrix(facets, m[0], 0.f, 0.f, m[0], facets, 0.f, 0.f, 0.f, 0.f, m[1], m[2], 0.f, 0.f, -m[2], m[1]);
        // About the normal of the plane of incidence, which the two directions have in common.
        Vector3f light = at.on.to_light ? wo : at.wi, view = at.on.to_light ? at.wi : wo, s = dr::cross(light, view);
        s = dr::select(dr::squared_norm(s) > 1e-12f, s, mueller::stokes_basis(view));
        return mueller::rotate_mueller_basis(matrix, -light, s, mueller::stokes_basis(-light), view, s,
                                             mueller::stokes_basis(view));
    }

    /// Density of draws, 1/sr.
    Float density(const Local &at, const Vector3f &wo) const {
        Float density = at.on.surface() ? at.place.pdf(at.on, at.wi, wo) : Float(0.f);
        return at.on.water_leaving ? dr::lerp(density, at.place.water_leaving(at.wi, wo, at.index[0]).second, at.share) : density;
    }

    std::pair<BSDFSample3f, Spectrum> draw(const Local &at, Float sample1, const Point2f &sample2, Mask active) const {
        BSDFSample3f bs = dr::zeros<BSDFSample3f>();
        Spectrum f_cos = 0.f;
        Mask diffuse = false, below = false;
        if (at.on.water_leaving) {
            below = sample1 < at.share;
            Float rest = (sample1 - at.share) * dr::rcp(prob_water::larger(1.f - at.share, 1e-9f));
            sample1 = dr::select(below, 0.f, prob_water::smaller(rest, dr::OneMinusEpsilon<Float>));
        }
        if (at.on.surface() && !dr::all_or<false>(below)) {
            auto drawn = at.place.sample(at.on, at.wi, { sample1, sample2.x(), sample2.y() }, apart());
            bs.wo = drawn.wo;
            bs.pdf = drawn.pdf;
            diffuse = drawn.from_whitecap;
            if (!at.on.water_leaving)
                f_cos = light(at, drawn.wo, drawn.value, drawn.whitecaps);
        }
        if (at.on.water_leaving) {
            bs.wo = dr::select(below, warp::square_to_cosine_hemisphere(sample2), bs.wo);
            bs.pdf = density(at, bs.wo);
            f_cos = value(at, bs.wo);
            diffuse |= below;
        }
        active &= bs.pdf > 0.f;
        bs.eta = 1.f;
        bs.sampled_component = dr::select(diffuse, UInt32(1), UInt32(0));
        bs.sampled_type = dr::select(diffuse, UInt32(+BSDFFlags::DiffuseReflection), UInt32(+BSDFFlags::GlossyReflection));
        return { bs, (f_cos / bs.pdf) & active };
    }

    rust::Box<prob_water::Options> m_options;
    std::optional<rust::Box<prob_water::Water>> m_water;
    rust::Vec<prob_water::Number> m_exposed;
    prob_water::Traits m_traits{};
    ref<Texture> m_footprint, m_whitecap_texture, m_ior, m_water_leaving;
    std::vector<ScalarFloat> m_shares;
    Sea m_sea;

    MI_TRAVERSE_CB(Base, m_footprint, m_whitecap_texture, m_ior, m_water_leaving, m_sea)
};

extern "C" MI_EXPORT void init_plugin(std::string_view name, PluginRegisterFn fn) {
    prob_water::check_compatible();
    MI_REGISTER_PLUGIN(fn, name, ProbWater);
}

NAMESPACE_END(mitsuba)
