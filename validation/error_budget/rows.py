"""The rows of the error budget: what each stage is, where it was looked at, what is claimed and what it means for f."""

from typing import NamedTuple

#: By whom an error is; every kind with errors gets its columns. Lanes are float32 too, and claim the same unless they say
#: otherwise.
KINDS = ("float64", "float32", "lanes", "approximation")

Bounds = tuple[float, float]


class Row(NamedTuple):
    """A stage. Bounds are of median and worst; `lanes` have those of float32 unless given."""

    name: str
    title: str
    equations: str
    measure: str
    bounds: dict[str, Bounds]
    domain: str
    passed_on: str
    dominated_by: str

    def bound(self, kind: str) -> Bounds:
        """What is claimed of a kind."""
        return self.bounds["float32" if kind == "lanes" and kind not in self.bounds else kind]


class Group(NamedTuple):
    """Rows under a heading."""

    title: str
    rows: list[Row]


def row(name: str, title: str, equations: str, measure: str, domain: str, passed_on: str, dominated_by: str,
        **bounds: Bounds) -> Row:
    """A row, bounds last."""
    return Row(name, title, equations, measure, bounds, domain, passed_on, dominated_by)


WINDS = "w* 0 to 238.65, D 1 mm to inf"
DIRECTIONS = "to 89.9999 degrees, half beyond 80; U^2 + C^2 < 55"
SEAS = f"any sea ({WINDS}, sigma from 1e-3), {DIRECTIONS}"
CONFIGURED = "In float64 once for a sea, whatever type evaluates it."

GROUPS = [
    Group("Configuration", [
        row("wind", "wind speed", "1-2", "relative", "w* 0.05 to 238.65, heights 0.1 to 100 m",
            "(U^2 + C^2)/2 times", "the logarithm's argument", float64=(3e-16, 3e-15)),
        row("inverse", "w* of a wind speed", "1-2", "relative, of the speed that w* gives",
            "5 to 100 % of the highest speed, heights 0.1 to 100 m", "as a wind speed", "the last bit of Eq. 1",
            float64=(3e-16, 2e-15)),
        row("variances", "slope variances", "74-77", "relative", WINDS, "(U^2 + C^2)/2 times",
            "the power inside erfc, where erfc is small", float64=(3e-16, 2e-14)),
        row("skewness", "skewness", "78", "absolute", WINDS, "times up to U^3/6", "the wind", float64=(2e-16, 2e-15)),
        row("index", "refractive index", "table", "relative", "0.2 to 200 micrometres", "times 5 (n = 1.33)",
            "linear interpolation where water absorbs (3 and 6 micrometres); in the visible the table's three decimals, 4e-4",
            float64=(3e-16, 1e-15), approximation=(5e-4, 1e-2)),
        row("foam", "whitecaps: fraction", "51", "relative", "W10 0.01 to 40 m/s", "by the share of whitecaps",
            "the power", float64=(3e-16, 1e-15)),
        row("breaking", "whitecaps: probability", "53-54", "absolute", "w* 0 to 238.65, accelerations to 1000 cm/s^2",
            "by the share of whitecaps", "the quotient", float64=(1e-16, 3e-15)),
        row("foam_brdf", "whitecaps: f", "55", "relative", "0.2 to 20 micrometres", "by the share of whitecaps",
            "the exponent in the infrared", float64=(5e-16, 2e-14)),
    ]),
    Group("BRDF", [
        row("tilts", "half vector, tilts U, C", "59, 68-73", "relative to the tilt", SEAS, "U^2 + C^2 times",
            "rounding of the wind's azimuth, sigma_u of 1e-3 beside a wide sigma_c, and steep facets", float64=(5e-16, 5e-14)),
        row("gaussian", "Gaussian", "72", "relative = absolute in the exponent", SEAS, "as it is",
            "the tilts; in float32 the result's own rounding, all before being float64; in lanes the roundings after the tilts",
            float64=(1e-14, 2e-12), float32=(1e-7, 6e-7), lanes=(3e-7, 3e-6)),
        row("steep", "1/cos^4, steep bound", "56", "relative", "w* 60 to 238.65, tilts to 89.9999 degrees",
            "as it is", "the Gaussian far out", float64=(5e-15, 5e-12), float32=(1e-7, 6e-7)),
        row("gram_charlier", "Gram-Charlier p_ks", "78", "absolute, with U, C given",
            "U^2 + C^2 < 55, w* 0 to 238.65", "as it is, on the lobe without it",
            "cancelling powers of U and C, up to 130; so scalars form it in float64 always",
            float64=(5e-15, 1e-13), float32=(2e-6, 5e-5)),
        row("schlick", "Schlick's formula", "62-63", "relative", "n 1.1 to 2, to 89.9999 degrees", "as it is",
            "1 - cos, to the fifth power", float64=(5e-16, 3e-15), float32=(2e-7, 1.5e-6)),
        row("fresnel", "Fresnel's equations", "-", "relative", "n 1.1 to 2, to 89.9999 degrees", "as it is",
            "rounding of the quotients, squared", float64=(6e-16, 4e-15), float32=(3e-7, 3e-6)),
        row("absorbing", "Fresnel's equations, complex index", "-", "relative", "n 1.1 to 2, k 0.001 to 3, to 89.9999 degrees",
            "as it is", "n^2 - k^2 - sin^2 where n and k are alike", float64=(6e-16, 1e-14), float32=(3e-7, 3e-6)),
        row("schlick_choice", "Schlick against Fresnel", "63", "relative", "n 1.3 to 1.4, to 89.9999 degrees",
            "as it is; `fresnel = \"exact\"` has none of it", "the model's own choice", approximation=(3e-2, 0.3)),
        row("ierfc", "ierfc", "66", "over x + ierfc(x)/2", "0 to 9", "as it is, towards the horizon",
            "libm's erfc; in float32 the polynomial, not its rounding",
            float64=(3e-16, 3e-15), float32=(4e-7, 1e-6), approximation=(3e-7, 6e-7)),
        row("hidden", "hidden area cos F", "65-66", "over cos + hidden area", "to 89.9999 degrees, sigma 0.001 to 0.45",
            "at most as it is", "ierfc", float64=(1e-16, 2e-15), float32=(2e-7, 1e-6)),
        row("shadowing", "shadowing G, bound", "67", "relative, f with over f without", SEAS, "as it is",
            "ierfc and its argument", float64=(5e-16, 2e-14), float32=(3e-7, 2e-6)),
        row("f", "f", "56-79", "over the lobe without Gram-Charlier", SEAS + ", all switches, no whitecaps", "is f",
            "tilts times Gram-Charlier's polynomial; in float32 a few roundings of a result up to 130 times the lobe it is "
            "measured by", float64=(2e-14, 5e-11), float32=(1e-5, 1e-4)),
        row("f_itself", "f, relative to itself", "56-79", "relative", "the same, where p_ks > 0.1", "is f",
            "tilts; in float32 c21 and c03, where p_ks is small", float64=(5e-15, 5e-12), float32=(3e-7, 4e-6)),
        row("f_tilted", "f about tilted normals", "41, 56-79", "over the lobe without Gram-Charlier",
            "the same, waves' slopes to 0.6", "is f", "as f",
            float64=(3e-14, 1e-10), float32=(1e-5, 1e-4)),
        row("f_foamy", "f with whitecaps", "51-79", "over the lobe without Gram-Charlier", SEAS + ", all switches",
            "is f", "as f; above w* of 225 all is whitecaps", float64=(2e-15, 5e-11), float32=(1e-5, 1e-4)),
        row("rounded", "directions rounded to float32", "59, 68-73", "absolute, standard deviations of the tilt", SEAS,
            "times sqrt(U^2 + C^2), before anything is evaluated",
            "3e-8 over the length of V_s + V_r, small where both are near the horizon, and over sigma",
            float32=(1e-5, 1e1)),
    ]),
    Group("Draws", [
        row("pdf", "density of draws", "ours", "relative", SEAS, "weight of a sample", "the tilt; in float32 it is formed there",
            float64=(1e-14, 2e-12), float32=(5e-6, 2e-4)),
        row("draw", "drawn direction", "ours", "absolute, radians", "any sea, sources to 89.9999 degrees",
            "none: f and pdf are those of the direction drawn", "sine and cosine of the drawn azimuth",
            float64=(5e-16, 1e-14), float32=(3e-7, 3e-6)),
    ]),
    Group("Waves", [
        row("wave_numbers", "k0, k1, k2, k_min, k_max", "4-8, 21-22", "relative", "w* 0.5 to 238.65, fetch, depth",
            "amplitudes", "k1 where its two roots are close (w* near 8)", float64=(3e-16, 1e-11)),
        row("spectrum", "spectrum S", "9-17", "relative", "the same, k_min to k2", "half, on amplitudes",
            "exponentials below the peak and of fetch; powers p of Eq. 16", float64=(1e-15, 5e-13)),
        row("dispersion", "omega", "4", "relative", "the same", "phases, times t", "the root", float64=(2e-16, 1e-15)),
        row("component", "amplitude", "36-38", "relative", "the same", "slopes of waves", "S",
            float64=(1e-15, 1e-13)),
        row("sine", "sine and cosine", "31", "absolute", "angles to 2e8 rad", "amplitude times", "the polynomial",
            float64=(1e-16, 3e-16)),
        row("height", "height", "38", "over its standard deviation", "10 km and to 1 h from 0, M 3 to 20, D 1 cm to 1 m",
            "none", "the phase k x, 3e6 rad to 1e-16; in lanes sine and cosine", float64=(1e-11, 1e-9), lanes=(2e-7, 2e-6)),
        row("slope", "slope", "39-40", "over its standard deviation", "the same",
            "tilt over sigma", "the phase k x; in lanes sine and cosine", float64=(3e-11, 2e-9), lanes=(2e-7, 2e-6)),
        row("acceleration", "vertical acceleration", "52", "over its standard deviation", "the same",
            "probability of a whitecap", "the phase k x; in lanes sine and cosine", float64=(4e-11, 2e-9), lanes=(2e-7, 2e-6)),
        row("cast", "ray cast", "46-47", "absolute, m, from the exact root",
            "incidence to 89.5 degrees, lasers 20 m and 10 km above", "slope at the hit",
            "coordinates of 1e5 m; from 20 m it is 2e-14", float64=(2e-13, 1e-10)),
        row("mesh", "mesh: heights", "38", "absolute, m", "512 waves, to 10 km, t = 1 h", "none",
            "float32 of the vertex", float32=(2e-8, 3e-7)),
        row("mesh_normal", "mesh: normals", "41", "absolute", "the same", "tilt over sigma", "float32 of the vertex",
            float32=(5e-8, 2e-7)),
    ]),
    Group("Means", [
        row("exact", "exact statistics", "3-79", "relative, to another quadrature", "w* 8, 24, 56; incidence 30 to 60",
            "is the mean of f", "not told apart: the density's table, its sums, and the other quadrature", approximation=(2e-4, 5e-4)),
        row("ensemble", "from afar, to 60 degrees", "3-79", "relative, to the exact mean",
            "w* 4 to 56, incidence to 75, above 1 % of the peak", "is f cos", "five slopes for the shadowing",
            approximation=(1e-3, 1e-2)),
        row("ensemble_low", "from afar, to 85 degrees", "3-79", "relative, to the exact mean", "the same", "is f cos",
            "waves that turn away, by five slopes", approximation=(3e-3, 4e-2)),
        row("empirical", "empirical table", "83-90", "relative, to the exact mean",
            "w* 2 to 24, D 5 to 50 cm, in the plane to 55 degrees, where nothing is hidden", "is the mean of f",
            "cubics between nodes; corners in half precision; float32 against float64 of the same table",
            float32=(5e-6, 2e-5), approximation=(2e-3, 2e-2)),
    ]),
]
ROWS = [row for group in GROUPS for row in group.rows]
