"""Polarised variants: the facets' Mueller matrix in Mitsuba's frames, against Mitsuba's own helpers, published values and itself."""

import drjit as dr
import numpy as np
import pytest

from validation.support.core import direction
from validation.support.lit_water import scene, sun
from validation.support.plugin_calls import draw_one, interaction, matrix

SURFACES = ["flat", "instance", "ensemble", "empirical"]
POLARISED = ["scalar_spectral_polarized", "llvm_ad_mono_polarized", "llvm_ad_spectral_polarized"]
#: One wavelength, whatever the variant.
SEA = {"wind_speed": 9.0, "wind_direction": 30.0, "wavelength": 0.55}
BREWSTER = np.degrees(np.arctan(1.34))
PAIRS = [(direction(50, 20), direction(45, 190)), (direction(10, 300), direction(70, 90)), (direction(30, 0), direction(30, 0))]


def context(mi, mode="Radiance", component=None):
    return mi.BSDFContext(getattr(mi.TransportMode, mode), mi.BSDFFlags.All.value, component)


def expected(mi, i, o, f_cos, index, mode):
    """The matrix by Mitsuba's own helpers, for what facets reflect."""
    light, view = (o, i) if mode == "Radiance" else (i, o)
    half = (light + view) / np.linalg.norm(light + view)
    h, back, view = (mi.Vector3f([float(x) for x in v]) for v in (half, -light, view))
    if index.imag == 0.0:
        m = mi.mueller.specular_reflection(float(half @ light), float(index.real))
    else:
        m = mi.mueller.specular_reflection(float(half @ light), mi.Complex2f(float(index.real), float(index.imag)))
    s_in = s_out = mi.mueller.stokes_basis(h)
    if np.linalg.norm(np.cross(half, light)) > 1e-6:
        s_in, s_out = dr.normalize(dr.cross(h, back)), dr.normalize(dr.cross(h, view))
    turned = mi.mueller.rotate_mueller_basis(
        m, back, s_in, mi.mueller.stokes_basis(back), view, s_out, mi.mueller.stokes_basis(view)
    )
    turned = np.array(turned, dtype=np.float64).reshape(4, 4, -1)[..., 0]
    return f_cos * turned / turned[0, 0]


@pytest.mark.parametrize("variant", ["scalar_spectral_polarized", "llvm_ad_mono_polarized"])
@pytest.mark.parametrize("mode", ["Radiance", "Importance"])
@pytest.mark.parametrize(
    ("optics", "index"),
    [
        ({"ior": 1.34}, 1.34 + 0j),
        ({"ior": 1.34, "fresnel": "exact"}, 1.34 + 0j),
        ({"ior": 1.111, "extinction": 0.199, "fresnel": "exact"}, 1.111 + 0.199j),
    ],
    ids=["schlick", "exact", "absorbing"],
)
def test_matrices_are_those_of_the_helpers(use, variant, mode, optics, index):
    """f of the facets times `mueller.specular_reflection` about the half vector, over its first element; the sign of what circles."""
    mi = use(variant)
    bsdf = mi.load_dict({"type": "prob_water", **SEA, **optics, "whitecaps": False})
    for i, o in PAIRS:
        found = matrix(mi, bsdf, i, o, context(mi, mode))
        assert np.allclose(found, expected(mi, i, o, found[0, 0], index, mode), atol=3e-6 * found[0, 0], rtol=0), (i, o)


@pytest.mark.parametrize("surface", SURFACES)
def test_first_element_is_the_unpolarised_value(use, surface):
    """m00, densities and draws are those of light without polarisation, in both modes."""
    found = {}
    for variant in ("llvm_ad_mono", "llvm_ad_mono_polarized", "scalar_spectral_polarized", "llvm_ad_spectral_polarized"):
        mi = use(variant)
        bsdf = mi.load_dict({"type": "prob_water", **SEA, "surface": surface, "water_leaving": {"type": "uniform", "value": 0.03}})
        rows = []
        for mode in ("Radiance", "Importance"):
            for i, o in PAIRS:
                m = matrix(mi, bsdf, i, o, context(mi, mode))
                rows.append([m.ravel()[0], float(np.ravel(bsdf.pdf(context(mi, mode), interaction(mi, i), mi.Vector3f(o.tolist())))[0])])
        found[variant] = np.array(rows)
    plain = found.pop("llvm_ad_mono")
    for variant, rows in found.items():
        print(surface, variant, np.max(np.abs(rows / plain - 1)))
        assert np.allclose(rows, plain, rtol=1e-4 if variant.startswith("scalar") else 5e-6), variant


@pytest.mark.parametrize("variant", POLARISED)
@pytest.mark.parametrize("surface", SURFACES)
def test_weights_are_values_over_densities(use, variant, surface):
    """Of draws of either component; no element is NaN."""
    mi, rng = use(variant), np.random.default_rng(1)
    bsdf = mi.load_dict({"type": "prob_water", **SEA, "wind_speed": 13.0, "surface": surface})
    for u in rng.random((30, 3)):
        wo, pdf, weight = draw_one(mi, bsdf, PAIRS[0][0], u, context(mi))
        assert np.isfinite(weight).all()
        if pdf > 0:
            value = matrix(mi, bsdf, PAIRS[0][0], wo, context(mi))
            assert np.allclose(weight * pdf, value, atol=2e-3 * value[0, 0], rtol=0)


def test_whitecaps_and_water_depolarise(use):
    """Their matrix has one element; so has that of no reflection none."""
    mi = use("llvm_ad_mono_polarized")
    bsdf = mi.load_dict({"type": "prob_water", **SEA, "wind_speed": 20.0, "water_leaving": {"type": "uniform", "value": 0.05}})
    i, o = PAIRS[0]
    whole, facets, diffuse = (matrix(mi, bsdf, i, o, context(mi, component=k)) for k in (None, 0, 1))
    assert diffuse[0, 0] > 0 and np.count_nonzero(diffuse) == 1
    assert np.allclose(facets + diffuse, whole, rtol=1e-5, atol=1e-9) and facets[0, 0] > 0
    assert not matrix(mi, bsdf, i, -o, context(mi)).any()


@pytest.mark.parametrize("surface", SURFACES)
def test_brewster(use, surface):
    """Degree of polarisation of sunlight in the mirror at Brewster's angle, of facets of any wind: Fresnel's, 1, within 1 %."""
    mi = use("llvm_ad_mono_polarized")
    for angle in (BREWSTER, 30.0, 70.0):
        c, s2 = np.cos(np.radians(angle)), np.sin(np.radians(angle)) ** 2
        q = np.sqrt(1.34**2 - s2)
        share = ((s2 - c * q) / (s2 + c * q)) ** 2
        fresnel = (1 - share) / (1 + share)
        for wind in (2.0, 10.0):
            bsdf = mi.load_dict({"type": "prob_water", "wind_speed": wind, "ior": 1.34, "surface": surface})
            m = matrix(mi, bsdf, direction(angle, 0), direction(angle, 180), context(mi, component=0))
            degree = np.linalg.norm(m[1:, 0]) / m[0, 0]
            print(f"{surface} {angle:.2f} degrees, wind {wind}: {degree:.6f}, Fresnel {fresnel:.6f}")
            assert abs(degree - fresnel) < 1e-2 * fresnel


def seen(mi, azimuth, parameters):
    """Stokes vector, through the `stokes` integrator, of a pixel of the sea under a sun, all turned about the vertical."""
    i, o = direction(40, azimuth), direction(50, azimuth + 165)
    to_world = mi.ScalarTransform4f().look_at([30 * float(x) for x in o], [0, 0, 0], [0, 0, 1])
    film = {"type": "hdrfilm", "width": 1, "height": 1, "pixel_format": "luminance", "rfilter": {"type": "box"}}
    sensor = {"type": "perspective", "fov": 0.01, "to_world": to_world, "film": film}
    integrator = {"type": "stokes", "nested": {"type": "path", "max_depth": 2}}
    sea = scene(mi, {**parameters, "wind_direction": (azimuth + 70.0) % 360.0}, emitter=sun(i), sensor=sensor, integrator=integrator)
    image = np.array(mi.render(sea, spp=16))[0, 0]
    # Red, green and blue of each, which are alike.
    return image[-12::3]


def test_stokes_do_not_jump_around_the_sea(use):
    """Camera, sun and wind turned together see the same Stokes vector, whatever frames Mitsuba has for their directions."""
    mi = use("llvm_ad_mono_polarized")
    all_stokes = np.array([seen(mi, azimuth, {**SEA, "ior": 1.34}) for azimuth in np.arange(0.0, 360.0, 7.5)])
    first = all_stokes[0]
    print("stokes", first, "largest step over I", np.max(np.abs(all_stokes - first)) / first[0])
    assert abs(first[1]) > 0.1 * first[0]
    assert np.max(np.abs(all_stokes - first)) < 2e-3 * first[0]
