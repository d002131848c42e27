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

/**!
.. _shape-prob_water_surface:

A drawn sea (:monosp:`prob_water_surface`)
------------------------------------------

.. pluginparameters::

 * - center
   - |point|
   - Where the cells are smallest, m: x and y in the shape's own coordinates, below the camera, say; z is 0. (Default:
     0, 0, 0)

 * - radius
   - |float|
   - Distance of the mesh's edge from there, m, up to 1e6. (Default: 20000)

 * - azimuth, opening
   - |float|
   - Middle and angle of the sector that is built, degrees counter-clockwise from +x. (Default: 0 and 360, all around)

 * - vertices
   - |int|
   - Most vertices: cells grow with the distance as little as these allow. (Default: 1000000)

 * - memory
   - |int|
   - Most memory in MiB while the scene is built; a mesh that needs more is refused before it is begun. (Default: 2048)

 * - footprint
   - |float|
   - Footprint D in m at the centre, where a cell is a third of it: waves longer than 2 D are geometry, shorter ones facets.
     (Default: 0.15)

 * - components, seed
   - |int|
   - How many waves are drawn, evenly over the spectrum, and which. (Default: 512 and 0)

 * - time
   - |float|
   - Time in s; setting it moves the waves. (Default: 0)
   - |exposed|

 * - wind_speed, wind_height, friction_velocity, beaufort, wind_direction, depth, fetch, water, whitecaps
   - |float|, |string| or |bool|
   - The sea, as for :monosp:`prob_water`; the wind's azimuth counts from the shape's own +x.

 * - wavelength, ior, fresnel, slope_measure, readings, shadowing, gram_charlier
   - |float|, |string| or |bool|
   - The facets, as for :monosp:`prob_water`.

 * - to_world
   - |transform|
   - From the shape's own coordinates, metres with z up, to the world's: a rotation and a shift. (Default: none)

 * - (nested plugin)
   - |bsdf|
   - Without one the shape makes its own :monosp:`prob_water`. One of that type takes the sea from the shape, also inside of
     another, such as :monosp:`twosided`; any other stays as it is.

 * - vertex_footprint, vertex_whitecaps
   - |float|
   - At every vertex, D in m and the probability of a whitecap (where the wind raises any).
   - |exposed|

One realised sea as a triangle mesh. Cells and with them D grow with the distance: what the mesh cannot show is facets in
the BSDF, and no wave ends at a line. The shading frame's s is the shape's +x everywhere. In a shapegroup its instances must
not be transformed: Mitsuba interpolates vertex attributes in the wrong place there.

.. tabs::
    .. code-tab:: xml
        :name: prob-water-surface

        <shape type="prob_water_surface">
            <float name="wind_speed" value="7"/>
            <float name="radius" value="5000"/>
        </shape>

    .. code-tab:: python

        'type': 'prob_water_surface',
        'wind_speed': 7,
        'radius': 5000
*/
template <typename Float, typename Spectrum>
class ProbWaterSurface final : public Mesh<Float, Spectrum> {
public:
    MI_IMPORT_BASE(Mesh, m_bsdf, m_to_world, m_vertex_count, m_face_count, m_vertex_positions, m_vertex_normals,
                   m_vertex_texcoords, m_faces, add_attribute, attribute_buffer, recompute_bbox, initialize)
    MI_IMPORT_TYPES(BSDF, Texture)
    using typename Base::FloatStorage;

    ProbWaterSurface(const Properties &props) : Base(props), m_mesh(configure(props)), m_time(m_mesh->time()) {
        check_rigid(m_to_world.scalar());
        for (const char *flag : { "flip_normals", "face_normals" })
            if (props.get<bool>(flag, false))
                Throw("prob_water_surface: %s = true has no meaning here: normals are the waves'", flag);
        {
            prob_water::Level level = m_mesh->level();
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

    /// Waves stay as steep as they are, and z stays up for them.
    static void check_rigid(const ScalarAffineTransform4f &to_world) {
        ScalarVector3f x = to_world * ScalarVector3f(1.f, 0.f, 0.f), y = to_world * ScalarVector3f(0.f, 1.f, 0.f),
                       z = to_world * ScalarVector3f(0.f, 0.f, 1.f);
        ScalarPoint3f o = to_world * ScalarPoint3f(0.f);
        auto near = [](ScalarFloat a, ScalarFloat b) { return std::abs(a - b) < 1e-4f; };
        bool rigid = near(dr::norm(x), 1.f) && near(dr::norm(y), 1.f) && near(dr::dot(x, y), 0.f) &&
                     near(dr::norm(dr::cross(x, y) - z), 0.f) && std::isfinite(o.x() + o.y() + o.z());
        if (!rigid)
            Throw("prob_water_surface: to_world scales, shears, mirrors or is not finite: allowed are rotations and shifts");
    }

    static FloatStorage load(const rust::Vec<float> &values) {
        return dr::load<FloatStorage>(values.data(), values.size());
    }

    /// Calls with the name and the value of every word that the scene gives.
    template <typename Word> static void words(const Properties &props, Word word) {
        prob_water::words(props, prob_water::mesh_vocabulary(), word, [](const std::string &name) {
            Throw("prob_water_surface: %s is an object or an array: allowed is a plain number, true or false, or a word", name);
        });
    }

    static rust::Box<prob_water::SeaMesh> configure(const Properties &props) {
        return refuse([&] {
            rust::Box<prob_water::MeshOptions> options = prob_water::mesh_options();
            words(props, prob_water::set_word(*options));
            auto center = props.get<ScalarPoint3f>("center", ScalarPoint3f(0.f));
            if (center.z() != 0.f)
                Throw("prob_water_surface: center has z = %s: allowed is 0", center.z());
            options->set_center(center.x(), center.y());
            return options->configure();
        });
    }

    /// Takes the waves as they are now; whether there are whitecaps.
    bool fill() {
        prob_water::Vertices v = m_mesh->vertices();
        ScalarAffineTransform4f to_world = m_to_world.scalar();
        for (size_t i = 0; i < v.positions.size(); i += 3) {
            auto p = to_world * ScalarPoint3f(v.positions[i], v.positions[i + 1], v.positions[i + 2]);
            auto n = dr::normalize(to_world * ScalarNormal3f(v.normals[i], v.normals[i + 1], v.normals[i + 2]));
            for (size_t axis = 0; axis < 3; ++axis) {
                v.positions[i + axis] = (float) p[axis];
                v.normals[i + axis] = (float) n[axis];
            }
        }
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

        Properties sea("prob_water");
        sea.set("components", (int64_t) m_mesh->components());
        words(props, [&](const std::string &name, const auto &value) {
            if (name != "footprint" && name != "whitecaps" && name != "components")
                sea.set(name, value);
        });
        sea.set("footprint", attribute("vertex_footprint"));
        if (whitecaps)
            sea.set("whitecaps", attribute("vertex_whitecaps"));
        else
            sea.set("whitecaps", false);
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
