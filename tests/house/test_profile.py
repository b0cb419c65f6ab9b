"""Profiles in Python: standard shapes against published points, readers and their refusals."""

from pathlib import Path

import numpy as np
import pytest

from klingel.contact import Profile
from klingel.errors import InputError

# Points of public files, millimetres: S1002 of CONTACT's MBench example (Apache-2.0); the arcs of 60E1, which are
# rounded to 1e-5 mm where the flank has a slope of 20.
S1002_POINTS = {-55.0: 28.0, 0.0: 0.0, -69.9: 11.54163, 60.0: -2.63564}
RAIL_POINTS = {0.0: 0.0, 10.228: 0.17440, 26.0265: 2.30252, 35.99981: 14.29996}


@pytest.mark.parametrize(("y", "z"), S1002_POINTS.items())
def test_s1002(y: float, z: float) -> None:
    assert float(Profile.s1002().depth(y * 1e-3)) * 1e3 == pytest.approx(z, abs=2e-4)


@pytest.mark.parametrize(("y", "z"), RAIL_POINTS.items())
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_rail_60e1(y: float, z: float, side: float) -> None:
    assert float(Profile.rail_60e1().depth(side * y * 1e-3)) * 1e3 == pytest.approx(z, abs=5e-4)


@pytest.mark.parametrize(("header", "scale"), [("y_m,z_m", 1.0), ("y_mm,z_mm", 1e3)])
def test_read_csv(tmp_path: Path, header: str, scale: float) -> None:
    wheel = Profile.s1002()
    rows = "\n".join(f"{y * scale},{z * scale},0" for y, z in zip(wheel.y, wheel.z, strict=True))
    path = tmp_path / "wheel.csv"
    path.write_text(f"# measured\n{header},more\n{rows}\n")
    read = Profile.read(path)
    np.testing.assert_allclose(read.y, wheel.y, rtol=1e-12)
    np.testing.assert_allclose(read.z, wheel.z, rtol=1e-12, atol=1e-15)


def points(n: int = 30) -> list[tuple[object, object]]:
    return [(i * 1e-3, 0.0) for i in range(n)]


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        (points(5), "too few"),
        ([*points(), (0.001, 0.0)], "y does not rise"),
        ([*points(), ("x", 0.0)], "is no point"),
        ([*points(), (float("nan"), 0.0)], "not all finite"),
        ([(float(i), 0.0) for i in range(30)], "look like millimetres"),
    ],
)
def test_bad_points(tmp_path: Path, rows: list[tuple[object, object]], said: str) -> None:
    path = tmp_path / "bad.csv"
    path.write_text("y_m,z_m\n" + "\n".join(f"{y},{z}" for y, z in rows))
    with pytest.raises(InputError, match=said):
        Profile.read(path)


def test_bad_files_and_places(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such file"):
        Profile.read(tmp_path / "none.csv")
    path = tmp_path / "head.csv"
    path.write_text("a,b\n1,2\n")
    with pytest.raises(InputError, match="use y_m,z_m"):
        Profile.read(path)
    with pytest.raises(InputError, match="outside the profile"):
        Profile.s1002().depth(0.1)
