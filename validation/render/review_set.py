"""The pictures that show the state of the project, in the order in which they are looked at."""

from dataclasses import dataclass, field

from validation.render.tone import EXPOSURE


@dataclass(frozen=True)
class Picture:
    """One picture: a scene, parameters where they differ from its defaults, and words to look at it with."""

    name: str
    scene: str
    title: str
    caption: str
    parameters: dict[str, float | str] = field(default_factory=dict)
    exposure: float = EXPOSURE


@dataclass(frozen=True)
class Comparison:
    """Two pictures that should agree once they are smoothed over a share of their width."""

    name: str
    first: str
    second: str
    title: str
    caption: str
    blur: float


@dataclass(frozen=True)
class Chart:
    """A drawing beside the pictures."""

    name: str
    title: str
    caption: str


BEAUFORT = [
    ("calm", "Hardly any wind (w* = 2 cm/s): ripples too low to show, and one soft image of the sun, as wide as Cox and "
     "Munk's law leaves the slopes."),
    ("light air", "Ripples without crests. The path is narrow, and breaks into glints near the camera, where single waves are "
     "seen."),
    ("light breeze", "The path reaches from the horizon to the camera and is wider. Short waves tell near from far."),
    ("gentle breeze", "Slopes spread the light; glints leave the path at its sides."),
    ("moderate breeze", "Longer waves: whole slopes lie in or out of the sun. Far away the path is a smooth road."),
    ("fresh breeze", "The path covers a third of the view. First whitecaps."),
    ("strong breeze", "Waves of several metres; the camera stands 8 m high. The path dissolves into bright slopes."),
]

PICTURES = [
    *(
        Picture(
            name=f"beaufort_{number}",
            scene="scenes/open_sea.xml",
            title=f"Open sea, Beaufort {number}: {name}",
            caption=caption,
            parameters={"beaufort": number},
        )
        for number, (name, caption) in enumerate(BEAUFORT)
    ),
    Picture(
        name="low_sun",
        scene="scenes/open_sea.xml",
        title="Low sun over open sea, Beaufort 4",
        caption="The sun 6 degrees high: a path from the horizon to the camera, and crests that stand dark before it.",
        parameters={"beaufort": 4, "sun_direction": "0.9945, 0, 0.1045", "height_above_sea": 5, "target_height": 1},
    ),
    Picture(
        name="gale",
        scene="scenes/gale.xml",
        title="Whitecapped gale, Beaufort 8",
        caption="Whitecaps stand on crests, where the water falls fastest, and cover 11 % of the sea. By the report they "
        "reflect 22 % of the light, like wet sand, so they are not as white as foam in a photograph.",
        exposure=8.0,
    ),
    Picture(
        name="close_up",
        scene="scenes/close_up.xml",
        title="Close-up, 4 m/s",
        caption="Single waves from metres down to a few centimetres; each glint is a piece of a wave that mirrors the sun.",
    ),
    Picture(
        name="laser_spot",
        scene="scenes/laser_spot.xml",
        title="A laser spot seen from a ship, Beaufort 3",
        caption="A green beam of 1.2 degrees meets the sea 40 m from the laser. Of the spot one sees the slopes that mirror "
        "the laser to the ship; dark holes are slopes that do not.",
    ),
    Picture(
        name="moonlit_lake",
        scene="scenes/moonlit_lake.xml",
        title="A lake by moonlight, 2.5 m/s",
        caption="Fresh water and a light wind; hills on the far shore.",
    ),
    Picture(
        name="sun_glint",
        scene="scenes/sun_glint.xml",
        title="Flat sea, all waves in the material (5 m/s)",
        caption="No wave is modelled: the mean over a patch of sea larger than any of them, on one rectangle. The glitter is "
        "smooth.",
        parameters={"wind_speed": 5},
    ),
    Picture(
        name="sun_glint_12_crosswind",
        scene="scenes/sun_glint.xml",
        title="Flat sea, strong breeze from the left (12 m/s)",
        caption="Slopes are steeper along the wind than across it, so the path is wider than with the wind from the sun. To "
        "its left the facets that glitter face downwind, where the skewed density has its long tail; to its right they "
        "face the wind, and the path ends sooner.",
        parameters={"wind_speed": 12, "wind_direction": 90},
    ),
    Picture(
        name="from_above",
        scene="scenes/from_above.xml",
        title="Glitter from above: waves as geometry",
        caption="A disk of sea, 300 m across, from 120 m up; w* = 12 cm/s, the sun 25 degrees from the zenith.",
        exposure=20.0,
    ),
    Picture(
        name="from_above_instance",
        scene="scenes/from_above_afar.xml",
        title="Glitter from above: one drawn sea on a level rectangle",
        caption="surface = instance: the waves are normals only.",
        parameters={"surface": "instance"},
        exposure=20.0,
    ),
    Picture(
        name="from_above_ensemble",
        scene="scenes/from_above_afar.xml",
        title="Glitter from above: the mean over all drawn seas",
        caption="surface = ensemble, on the same rectangle: what both pictures above are on average.",
        exposure=20.0,
    ),
]

COMPARISONS = [
    Comparison(
        name="waves_less_ensemble",
        first="from_above",
        second="from_above_ensemble",
        title="Waves as geometry, less their ensemble",
        caption="Smoothed, so that single waves do not count. What is left are the long waves of this one sea. The left is even: "
        "too little light to compare.",
        blur=0.05,
    ),
    Comparison(
        name="instance_less_ensemble",
        first="from_above_instance",
        second="from_above_ensemble",
        title="One drawn sea as normals, less the ensemble",
        caption="The same for surface = instance.",
        blur=0.05,
    ),
]

WIDTHS = Chart(
    name="glitter_width",
    title="The path widens with the wind as the slopes do",
    caption="Root mean square of the azimuth of the glitter, as rendered from drawn waves and as the core's slope density has "
    "it; the sun 25 degrees high, looks 18 to 32 degrees down from 30 m.",
)
