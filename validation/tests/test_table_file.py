"""A table that the command builds, as NumPy reads it."""

import subprocess

import numpy as np

from validation.support.command import COMMAND

GRID = ("--friction-velocities 6,8,12 --footprints 0.1:0.2:2 --incidences 0,30,60 --wind-azimuths 0:180:3 "
        "--angles -80:80:17 --instances 64")


def test_numpy_reads_it_in_one_line(tmp_path) -> None:
    """Arrays by their names, without any code of ours."""
    subprocess.run([COMMAND, "table", "build", tmp_path / "table.npz", *GRID.split()], check=True)
    table = np.load(tmp_path / "table.npz")
    assert table["mean"].shape == (3, 2, 3, 3, 17)
    np.testing.assert_array_equal(table["footprint"], [0.1, 0.2])
    assert np.all(np.isfinite(table["mean"])) and table["mean"].max() > 0
