"""What the report's figures are made of: tables from the command `prob-water`, which computes everything.

A table is a dictionary of columns of equal length. Angles are in degrees, lengths in metres, the friction
velocity in cm/s and the BRDF in 1/sr.
"""

import csv
import io
import json
import subprocess
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from validation.support.command import flags

Table = dict[str, np.ndarray]
Case = dict[str, Any]

#: The base scenario of section 8; `incidence` is geometry, the others are the command's parameters.
BASE: Case = {"friction_velocity": 8.0, "wind_direction": 0.0, "footprint": 0.15, "incidence": 30.0,
              "components": 5, "readings": "corrected", "whitecap_onset": "ramp", "seed": 0}
BASE_TEXT = ("Base scenario: w* = 8 cm/s, wind along x, D = 0.15 m, θi = 30°, M = 5, n = 1.33. Bands are standard "
             "errors.")
#: The report's N.
REPORT_INSTANCES = 50
#: The index that section 6.2 quotes for 1 micrometre.
OPTICS: Case = {"ior": 1.33, "wavelength": 1.0}
#: The friction velocities of section 3, Beaufort 0 to 6.
WINDS = [2.0, 4.0, 8.0, 16.0, 24.0, 40.0, 56.0]

IN_PLANE = np.arange(-87.5, 88, 2.5)
OUT_OF_PLANE = np.arange(-60, 60.1, 2.5)
#: What is added to a column's name in a file.
UNITS = {"friction_velocity": "cm_s", "wind_direction": "deg", "footprint": "m", "incidence": "deg", "angle": "deg",
         "mean": "per_sr", "std": "per_sr", "sem": "per_sr", "f": "per_sr", "centre": "deg", "width": "deg",
         "height": "m", "x": "m", "y": "m", "time": "s"}
LASER_DISTANCE, OBSERVER_DISTANCE = 1e4, 1e5


class CommandError(Exception):
    """The command is missing or refuses."""


class Command:
    """The command `prob-water` at a path."""

    def __init__(self, path: Path) -> None:
        self.path = path
        if not path.is_file():
            raise CommandError(f"{path} is missing: run `cargo build --release -p prob-water-cli`")

    def run(self, *arguments: str, parameters: Case | None = None, text: str | None = None) -> Table:
        """The table a subcommand prints; `text` is its standard input."""
        done = subprocess.run([self.path, *arguments, *flags(parameters or {})], input=text, capture_output=True, text=True)
        if done.returncode != 0:
            raise CommandError(done.stderr.strip())
        return parse(done.stdout)

    def version(self) -> str:
        """Its name and version."""
        return subprocess.run([self.path, "--version"], capture_output=True, text=True, check=True).stdout.strip()

    def scenario(self, case: Case, observers: np.ndarray, instances: int,
                 presence: str | None = "expected") -> Table:
        """Statistics for observers (unit vectors) of the base scenario changed by `case`; an empirical sea has no
        presence of whitecaps."""
        with tempfile.TemporaryDirectory() as directory:
            file = Path(directory, "scenario.toml")
            file.write_text(toml(case, observers, instances, presence))
            return self.run("scenario", str(file))

    def instances(self, case: Case, observers: np.ndarray, instances: int) -> Table:
        """A row for every observer and drawn instance."""
        with tempfile.TemporaryDirectory() as directory:
            file, rows = Path(directory, "scenario.toml"), Path(directory, "instances.csv")
            file.write_text(toml(case, observers, instances, "drawn"))
            self.run("scenario", str(file), "--instances-out", str(rows))
            return parse(rows.read_text())


def parse(text: str) -> Table:
    """Columns of a CSV text, numbers where all of a column are."""
    header, *rows = csv.reader(io.StringIO(text))
    return {name: column(values) for name, values in zip(header, zip(*rows, strict=True), strict=True)}


def column(values: Iterable[Any]) -> np.ndarray:
    """An array of numbers, or of texts."""
    values = list(values)
    try:
        return np.array(values, dtype=float)
    except ValueError:
        return np.array(values)


def toml(case: Case, observers: np.ndarray, instances: int, presence: str | None) -> str:
    """The scenario file: the laser 10 km away, the observers 100 km, the beam aimed at the origin (Eq. 80)."""
    model = BASE | OPTICS | {"instances": instances} | case
    laser = LASER_DISTANCE * incident(model.pop("incidence"))
    engagement = {"laser": laser.tolist(), "target": [0.0, 0.0, 0.0],
                  "observers": (OBSERVER_DISTANCE * observers).tolist()}
    asked = {"whitecap_presence": presence} if presence else {}
    parts = [*assignments(asked), "[model]", *assignments(model),
             "[[engagement]]", *assignments(engagement)]
    return "\n".join(parts) + "\n"


def assignments(values: Case) -> list[str]:
    """Lines of TOML; its numbers, texts and lists are JSON's."""
    return [f"{name} = {json.dumps(value)}" for name, value in values.items()]


def incident(incidence: float) -> np.ndarray:
    """Eq. 80: the direction to the laser."""
    angle = np.radians(incidence)
    return np.array([-np.sin(angle), 0.0, np.cos(angle)])


def in_plane(angles: np.ndarray) -> np.ndarray:
    """Eq. 81: directions to observers in the plane of incidence."""
    angles = np.radians(angles)
    return np.stack([np.sin(angles), np.zeros_like(angles), np.cos(angles)], axis=-1)


def out_of_plane(incidence: float, angles: np.ndarray) -> np.ndarray:
    """Eq. 82, its y read as sin phi_r: directions in the plane across it through the specular direction."""
    incidence, angles = np.radians(incidence), np.radians(angles)
    return np.stack([np.sin(incidence) * np.cos(angles), np.sin(angles),
                     np.cos(incidence) * np.cos(angles)], axis=-1)


def observers_of(incidence: float) -> tuple[np.ndarray, Table]:
    """Directions to all observers of a figure, in-plane and out-of-plane, with their planes and angles."""
    directions = np.concatenate([in_plane(IN_PLANE), out_of_plane(incidence, OUT_OF_PLANE)])
    planes = np.array(["in"] * len(IN_PLANE) + ["out"] * len(OUT_OF_PLANE))
    return directions, {"plane": planes, "angle": np.concatenate([IN_PLANE, OUT_OF_PLANE])}


def sweep(command: Command, cases: Iterable[Case], instances: int) -> Table:
    """Averages in-plane and out-of-plane for each change of the base scenario; whitecaps by expectation."""
    return stack(averages(command, case, instances) for case in cases)


def averages(command: Command, case: Case, instances: int, presence: str = "expected") -> Table:
    """Averages in-plane and out-of-plane, with the scenario's values in every row."""
    scenario = BASE | case | {"instances": instances}
    directions, labels = observers_of(scenario["incidence"])
    found = command.scenario(case, directions, instances, presence)
    constant = {name: column([value] * len(directions)) for name, value in scenario.items()}
    return constant | labels | {name: found[name] for name in ("mean", "std", "sem", "obscured", "whitecap")}


def flat_wave(command: Command) -> Table:
    """The BRDF of the base scenario without waves."""
    directions, labels = observers_of(BASE["incidence"])
    source = incident(BASE["incidence"])
    rows = [",".join(map(repr, [*source.tolist(), *direction.tolist()])) for direction in directions]
    names = ("friction_velocity", "wind_direction", "footprint", "readings")
    parameters = {name: BASE[name] for name in names} | OPTICS
    found = command.run("brdf", parameters=parameters, text="\n".join(["ix,iy,iz,ox,oy,oz", *rows]) + "\n")
    return labels | {"f": found["f"]}


def stack(tables: Iterable[Table]) -> Table:
    """Tables of the same columns, one after the other."""
    tables = list(tables)
    return {name: np.concatenate([table[name] for table in tables]) for name in tables[0]}


def select(table: Table, **wanted: Any) -> Table:
    """The rows in which every column named has the value given."""
    keep = np.ones(len(next(iter(table.values()))), dtype=bool)
    for name, value in wanted.items():
        keep &= table[name] == value
    return {name: values[keep] for name, values in table.items()}


def write(table: Table, target: Path) -> None:
    """The table as a CSV file, numbers to nine digits, with units in the names."""
    with target.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow("_".join([name, UNITS[name]]) if name in UNITS else name for name in table)
        numbers = [values.dtype.kind in "fiu" for values in table.values()]
        for row in zip(*table.values(), strict=True):
            writer.writerow([f"{value:.9g}" if number else value
                             for value, number in zip(row, numbers, strict=True)])
