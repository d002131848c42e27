"""The pictures that show the state of the project, in the order in which they are looked at."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Picture:
    """One picture: a scene, parameters where they differ from its defaults, and words to look at it with."""

    name: str
    scene: str
    title: str
    caption: str
    parameters: dict[str, float | str] = field(default_factory=dict)


PICTURES = [
    Picture(
        name="sun_glint_2",
        scene="scenes/sun_glint.xml",
        title="Sun glint, light air (2 m/s)",
        caption="Gentle slopes: a narrow, bright path with a soft edge. Away from it the water mirrors the "
        "low sky near the horizon and darkens towards the viewer, as Fresnel's reflectance does.",
        parameters={"wind_speed": 2},
    ),
    Picture(
        name="sun_glint",
        scene="scenes/sun_glint.xml",
        title="Sun glint, gentle breeze (5 m/s)",
        caption="The path is wider than at 2 m/s and dimmer towards the viewer, since the light is spread "
        "over more slopes. The wind blows from the sun to the camera.",
        parameters={"wind_speed": 5},
    ),
    Picture(
        name="sun_glint_12",
        scene="scenes/sun_glint.xml",
        title="Sun glint, strong breeze (12 m/s)",
        caption="The path covers half of the view and is dimmer still. Near the horizon the water is darker "
        "than at 2 m/s: the facets seen there lean towards the viewer and reflect a higher, darker sky, at a "
        "less grazing angle.",
        parameters={"wind_speed": 12},
    ),
    Picture(
        name="sun_glint_12_crosswind",
        scene="scenes/sun_glint.xml",
        title="Sun glint, strong breeze from the left (12 m/s)",
        caption="The same wind across the view. Slopes are steeper along the wind than across it, so the "
        "path is wider. To its left the facets that glitter face downwind, where the skewed density has its "
        "long tail; to its right they face the wind, and the path ends sooner.",
        parameters={"wind_speed": 12, "wind_direction": 90},
    ),
]
