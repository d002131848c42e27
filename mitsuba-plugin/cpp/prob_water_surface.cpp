#include "compatible.h"

#include <mitsuba/core/plugin.h>
#include <mitsuba/core/properties.h>
#include <mitsuba/render/bsdf.h>
#include <mitsuba/render/mesh.h>
#include <mitsuba/render/texture.h>
#include <algorithm>

#include "prob-water-mitsuba/src/surface.rs.h"
#include "rust/cxx.h"

#include "sea.h"
#include "words.h"

NAMESPACE_BEGIN(mitsuba)

// Parameters and examples: mitsuba-plugin/docs/prob_water_surface.rst.
template <typename Float, typename Spectrum>
class ProbWaterSurface final : public Mesh<Float, Spectrum> {
public:
    MI_IMPORT_BASE(Mesh, m_bsdf, m_to_world, m_vertex_count, m_face_count, m_vertex_positions, m_vertex_normals,
                   m_vertex_texcoords, m_faces, add_attribute, attribute_buffer, recompute_bbox, initialize)
    MI_IMPORT_TYPES(BSDF, Texture)
    using typename Base::FloatStorage;

    ProbWaterSurface(const Properties &props) : Base(props), m_mesh(configure(props)), m_time(m_mesh->time()) {
        for (const char *flag : { "flip_normals", "face_normals" })
            if (props.get<bool>(flag, false))
                Throw("prob_water_surface: %s = true has no meaning here: normals are the waves'", flag);
        {
            prob_water::StaticGeometry level = m_mesh->level();
            m_vertex_count = (uint32_t) level.footprints.size();
            m_face_count = (uint32_t) (level.faces.size() / 3);
            m_faces = dr::load<DynamicBuffer<UInt32>>(level.faces.data(), level.faces.size());
            m_vertex_texcoords = load(level.texcoords);
            add_attribute("vertex_footprint", 1, { level.footprints.begin(), level.footprints.end() });
        }
        bool whitecaps = fill();
        recompute_bbox();
        lend(props, whitecaps);
        initialize();
    }

    void traverse(TraversalCallback *cb) override {
        Base::traverse(cb);
        cb->put("time", m_time, ParamFlags::NonDifferentiable);
    }

    void parameters_changed(const std::vector<std::string> &keys) override {
        if (!keys.empty() && std::find(keys.begin(), keys.end(), "time") == keys.end()) {
            // What was set together with a refused value of something else.
            m_time = m_mesh->time();
            return Base::parameters_changed(keys);
        }
        try {
            refuse([&] { m_mesh->set_time(m_time); });
        } catch (...) {
            // A refused time leaves the sea as it was.
            m_time = m_mesh->time();
            throw;
        }
        fill();
        for (prob_water::TakesSea *takes : prob_water::takers(m_bsdf.get()))
            takes->set_time(m_time);
        std::vector<std::string> moved = keys;
        moved.insert(moved.end(), { "vertex_positions", "vertex_normals" });
        Base::parameters_changed(moved);
    }

    std::string to_string() const override {
        return "ProbWaterSurface[\n  " + string::indent(std::string(m_mesh->describe()), 2) + "\n  bsdf = " +
               string::indent(m_bsdf->to_string(), 2) + "\n]";
    }

    MI_DECLARE_CLASS(ProbWaterSurface)

private:
    /// Runs a call into the core; its errors become Mitsuba's.
    template <typename Call> static auto refuse(Call call) {
        try {
            return call();
        } catch (const rust::Error &e) {
            Throw("prob_water_surface: %s", e.what());
        }
    }

    static FloatStorage load(const rust::Vec<float> &values) {
        return dr::load<FloatStorage>(values.data(), values.size());
    }

    rust::Box<prob_water::SeaMesh> configure(const Properties &props) const {
        return refuse([&] {
            rust::Box<prob_water::MeshOptions> options = prob_water::mesh_options();
            prob_water::set_words(props, prob_water::mesh_vocabulary(), *options, [](const std::string &name) {
                Throw("prob_water_surface: %s is an object or an array: allowed is a plain number, true or false, or a word", name);
            });
            auto center = props.get<ScalarPoint3f>("center", ScalarPoint3f(0.f));
            options->set_center({ center.x(), center.y(), center.z() });
            auto m = m_to_world.scalar().matrix;
            options->set_to_world({ m(0, 0), m(0, 1), m(0, 2), m(0, 3), m(1, 0), m(1, 1), m(1, 2), m(1, 3),
                                    m(2, 0), m(2, 1), m(2, 2), m(2, 3) });
            return options->configure();
        });
    }

    /// Takes the waves as they are now; whether there are whitecaps.
    bool fill() {
        prob_water::Vertices v = m_mesh->vertices();
        m_vertex_positions = load(v.positions);
        m_vertex_normals = load(v.normals);
        if (v.whitecaps.empty())
            return false;
        if (m_whitecaps)
            attribute_buffer("vertex_whitecaps") = load(v.whitecaps);
        else
            add_attribute("vertex_whitecaps", 1, { v.whitecaps.begin(), v.whitecaps.end() });
        return m_whitecaps = true;
    }

    /// The BSDF has the shape's sea, D and whitecaps.
    void lend(const Properties &props, bool whitecaps) {
        bool nested = false;
        for (auto &prop : props.objects())
            nested |= prop.template try_get<BSDF>() != nullptr;
        if (!nested)
            m_bsdf = PluginManager::instance()->create_object<BSDF>(Properties("prob_water"));

        Properties sea(props);
        sea.set("components", (int64_t) m_mesh->components(), false);
        sea.set("footprint", attribute("vertex_footprint"), false);
        sea.set("whitecaps", false, false);
        if (whitecaps)
            sea.set("whitecaps", attribute("vertex_whitecaps"), false);
        for (prob_water::TakesSea *takes : prob_water::takers(m_bsdf.get()))
            takes->take_sea(sea);
    }

    static ref<Object> attribute(const char *name) {
        Properties props("mesh_attribute");
        props.set("name", std::string(name));
        return PluginManager::instance()->create_object<Texture>(props).get();
    }

    rust::Box<prob_water::SeaMesh> m_mesh;
    double m_time;
    bool m_whitecaps = false;

    MI_TRAVERSE_CB(Base)
};

extern "C" MI_EXPORT void init_plugin(std::string_view name, PluginRegisterFn fn) {
    prob_water::check_compatible();
    MI_REGISTER_PLUGIN(fn, name, ProbWaterSurface);
}

NAMESPACE_END(mitsuba)
