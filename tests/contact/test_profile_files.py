"""Readers of profiles: every format gives the same canonical points, whatever side and way up a file has."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from klingel.contact import Profile
from klingel.errors import InputError

Write = Callable[[Path, np.ndarray, np.ndarray], None]

WHEEL, RAIL = Profile.s1002(), Profile.rail_60e1()


def coarse(profile: Profile, step: int = 8) -> tuple[np.ndarray, np.ndarray]:
    """Points in millimetres, fewer of them."""
    return 1e3 * profile.y[::step], 1e3 * profile.z[::step]


def leaning() -> tuple[np.ndarray, np.ndarray]:
    """The right-hand rail leaning inwards by 1:40, its top at the origin, in millimetres."""
    y, z = coarse(RAIL)
    cos, sin = np.cos(np.arctan(1 / 40)), np.sin(np.arctan(1 / 40))
    y, z = y * cos + z * sin, z * cos - y * sin
    top = int(np.argmin(z))
    return y - y[top], z - z[top]


def same(read: Profile, y: np.ndarray, z: np.ndarray) -> None:
    """The read profile goes through the points [mm]; the height of a tape circle between them is off by 0.06 um."""
    inside = (1e-3 * y >= read.y[0]) & (1e-3 * y <= read.y[-1])
    assert inside.sum() > 0.9 * len(y)
    np.testing.assert_allclose(read.depth(1e-3 * y[inside]), 1e-3 * z[inside], rtol=0.0, atol=1e-7)


def simpack(y: np.ndarray, z: np.ndarray, *, kind: int, block: str = "", factor: str = "1.0e+03") -> str:
    """A file as SIMPACK writes it."""
    rows = "\n".join(f"{a:.9E}\t{b:.9E}\t1.0" for a, b in zip(y, z, strict=True))
    return f"""! profile
  header.begin
    version = 1 ! version
    type    = {kind} ! 0=rail, 1=wheel
  header.end
  spline.begin
    approx.smooth = +0.0
    comment = 'upright! and new' ! a comment
    bound.y.min = +1.0
    bound.y.max = +0.0
{block}
    units.len.f = {factor}
    point.begin
    ! y  z
{rows}
    point.end
  spline.end
"""


def miniprof(y: np.ndarray, z: np.ndarray, *, columns: str = "X,Y,A", head: str = "") -> str:
    """A file as MiniProf writes it."""
    order = [name.strip() for name in columns.split(",")]
    rows = []
    for a, b in zip(y, z, strict=True):
        values = {"X": f"{a:.10f}", "Y": f"{b:.10f}"}
        rows.append("\t".join(values.get(name, "0.0") for name in order))
    body = "\n".join(rows)
    return f"ProgramName=MiniProf\nXYPoints={len(y)}\nColumnDef={columns}\n{head}\n\n{body}\n"


def written(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("header", ["y_m,z_m,dz_dy", "y_mm,z_mm"])
@pytest.mark.parametrize("falling", [False, True])
def test_csv(tmp_path: Path, header: str, falling: bool) -> None:
    y, z = coarse(WHEEL)
    scale = 1e-3 if "y_m," in header else 1.0
    order = slice(None, None, -1) if falling else slice(None)
    rows = "\n".join(f"{float(a * scale)!r},{float(b * scale)!r},0" for a, b in zip(y[order], z[order], strict=True))
    path = written(tmp_path / "wheel.csv", f"# measured\n  # twice\n{header}\n{rows}\n")
    same(Profile.read(path), y, z)


@pytest.mark.parametrize("turned", ["", "mirror.y = 1", "mirror.z = 1", "inversion = 1", "shift.y = 2.5"])
def test_simpack_wheel(tmp_path: Path, turned: str) -> None:
    y, z = coarse(WHEEL)
    # The file holds what its own step undoes.
    given_y, given_z = (-y if "mirror.y" in turned else y - 2.5 if "shift" in turned else y), z
    given_z = -z if "mirror.z" in turned else z
    path = written(tmp_path / "wheel.prw", simpack(given_y[::-1], given_z[::-1], kind=1, block=turned))
    same(Profile.read(path), y, z)


def test_simpack_left_wheel_is_mirrored(tmp_path: Path) -> None:
    y, z = coarse(WHEEL)
    same(Profile.read(written(tmp_path / "left.prw", simpack(-y, z, kind=1))), y, z)


def test_simpack_steps(tmp_path: Path) -> None:
    y, z = leaning()
    # Turned back upright by the file's rotation, cut by its bounds, in inches.
    block = "    rotate = 1.0\n    units.ang.f = 40.0083\n    bound.y.min = -1.72\n    bound.y.max = 1.3"
    text = simpack(y / 25.4, z / 25.4, kind=0, block=block, factor="39.37007874")
    read = Profile.read(written(tmp_path / "rail.prr", text))
    assert read.y[0] > -1.72 * 0.0254
    assert read.y[-1] < 1.3 * 0.0254
    slope = np.gradient(read.z, read.y)
    upright = np.interp(0.0, slope[np.abs(slope) < 0.1], read.y[np.abs(slope) < 0.1])
    # The rail's axis has turned about the origin of the file, its top: 300 mm / 40 beside it.
    assert upright == pytest.approx(-7.5e-3, abs=2e-4)


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("up", [-1.0, 1.0])
@pytest.mark.parametrize("columns", ["X,Y", "N,Y,X,C"])
def test_miniprof_wheel(tmp_path: Path, side: float, up: float, columns: str) -> None:
    y, z = coarse(WHEEL)
    path = written(tmp_path / "wheel.whl", miniprof(side * y, up * (z + 0.4), columns=columns))
    # The height of the tape circle is taken off.
    same(Profile.read(path), y, z)


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("head", ["", "WheelDiameterTaperline=69.0000"])
def test_miniprof_wheel_from_its_flange_back(tmp_path: Path, side: float, head: str) -> None:
    y, z = coarse(WHEEL)
    from_back = y + (69.0 if head else 70.0)
    same(Profile.read(written(tmp_path / "wheel.whl", miniprof(side * from_back[::-1], z[::-1], head=head))), y, z)


def test_miniprof_of_the_first_devices(tmp_path: Path) -> None:
    y, z = coarse(WHEEL)
    rows = "\n".join(f"{a:.7f}    {b:.7f}" for a, b in zip(y + 70.0, z, strict=True))
    head = '#MINIWHEELPROF\nwheel.whl\nMINIPROF 2020\nCar Number..:\n" 32.58 37.11 14.71\n(Sd/Sh/qR)'
    same(Profile.read(written(tmp_path / "wheel.whl", f"{head}\n\n{rows}\n")), y, z)


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("up", [-1.0, 1.0])
def test_miniprof_rail_leans_to_its_gauge_side(tmp_path: Path, side: float, up: float) -> None:
    y, z = leaning()
    path = written(tmp_path / "rail.ban", miniprof(side * y, up * z))
    same(Profile.read(path), y, z)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_miniprof_rail_with_one_face(tmp_path: Path, side: float) -> None:
    y, z = coarse(RAIL)
    kept = (y < 30.0) & (y > -38.0)
    same(Profile.read(written(tmp_path / "rail.ban", miniprof(side * y[kept], z[kept]))), y[kept], z[kept])


def test_miniprof_outline_ends_are_cut(tmp_path: Path) -> None:
    y, z = coarse(WHEEL)
    back = np.linspace(0.3, 6.0, 15)
    # The flange back leans over, the rim face stands upright, and a point is repeated.
    outline_y = np.concatenate([y[0] + 0.02 * back[::-1], y, [y[-1]], np.full(10, y[-1])])
    outline_z = np.concatenate([z[0] - back[::-1], z, [z[-1]], z[-1] - np.linspace(1.0, 20.0, 10)])
    text = miniprof(outline_y, outline_z).replace("0.0\n", '0.0\n" -1.0 9.0 0.0\n', 1)
    same(Profile.read(written(tmp_path / "wheel.whl", text)), y, z)


def test_the_code_page_of_the_device(tmp_path: Path) -> None:
    y, z = coarse(WHEEL)
    path = tmp_path / "wheel.whl"
    path.write_bytes(miniprof(y, z, head="Stock=Münster").encode("cp1252"))
    same(Profile.read(path), y, z)


def refused(path: Path, text: str, units: str | None = None) -> str:
    with pytest.raises(InputError) as caught:
        Profile.read(written(path, text), units=units)
    assert str(path) in str(caught.value)
    return str(caught.value)


def test_units_must_fit(tmp_path: Path) -> None:
    y, z = coarse(WHEEL)
    in_metres = simpack(1e-3 * y, 1e-3 * z, kind=1, factor="1000.0")
    assert "look like metres" in refused(tmp_path / "a.prw", in_metres)
    assert "look like millimetres" in refused(tmp_path / "b.prw", simpack(y, z, kind=1, factor="1.0"))
    assert "make them agree" in refused(tmp_path / "c.prw", simpack(y, z, kind=1), units="m")
    assert "look like metres" in refused(tmp_path / "d.whl", miniprof(1e-3 * y, 1e-3 * z))
    same(Profile.read(written(tmp_path / "e.whl", miniprof(1e-3 * y, 1e-3 * z)), units="m"), y, z)
    rows = "\n".join(f"{a},{b}" for a, b in zip(y, z, strict=True))
    assert "look like millimetres" in refused(tmp_path / "f.csv", f"y_m,z_m\n{rows}")
    assert "those of the file's header" in refused(tmp_path / "g.csv", f"y_mm,z_mm\n{rows}", units="m")
    same(Profile.read(written(tmp_path / "h.csv", f"y_mm,z_mm\n{rows}"), units="mm"), y, z)


def test_wheel_and_rail_are_not_mixed_up(tmp_path: Path) -> None:
    wheel, rail = coarse(WHEEL), coarse(RAIL)
    assert "is a rail, but the file is for a wheel" in refused(tmp_path / "a.whl", miniprof(*rail))
    assert "is a wheel, but the file is for a rail" in refused(tmp_path / "b.prr", simpack(*wheel, kind=0))
    assert "a wheel belongs into a .prw file" in refused(tmp_path / "c.prr", simpack(*wheel, kind=1))


def test_what_cannot_be_oriented_is_refused_with_its_reasons(tmp_path: Path) -> None:
    y, z = coarse(RAIL)
    worn = np.where(y > -30.0, z, z + 30.0 * (-30.0 - y) ** 2)
    assert "does not tell the gauge side" in refused(tmp_path / "worn.ban", miniprof(y, worn))
    shallow = np.abs(y) < 33.0
    message = refused(tmp_path / "flat.ban", miniprof(y[shallow], z[shallow]))
    assert "does not reach its gauge point" in message
    y, z = coarse(WHEEL)
    assert "as a wheel: flange" in refused(tmp_path / "tread.whl", miniprof(y[y > -25.0], z[y > -25.0]))
    moved = refused(tmp_path / "moved.prw", simpack(y + 35.0, z, kind=1))
    assert "as a wheel: flange" in moved
    rows = "\n".join(f"{a / 1e3},0.0" for a in y)
    both = refused(tmp_path / "line.csv", f"y_m,z_m\n{rows}")
    assert "as a wheel" in both
    assert "as a rail" in both


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("a.txt", "1 2\n3 4\n", "SIMPACK .prw and .prr"),
        ("b.prw", "spline.begin\npoint.begin\n1 x\npoint.end\nspline.end\n", "give two numbers"),
        ("c.prw", "spline.begin\npoint.begin\npoint.end\nspline.end\n", "no points are left"),
        ("d.prw", "header.begin\ntype = 3\nheader.end\nspline.begin\npoint.begin\n1 2\npoint.end", "0 for a rail"),
        ("e.prw", "spline.begin\nshift.y = a\npoint.begin\n1 2\npoint.end", "shift.y"),
        ("f.prw", "spline.begin\nunits.len.f = 0\npoint.begin\n1 2\npoint.end", "must be positive"),
        ("g.prw", "spline.begin\nheader.end\n", "closes no open block"),
        ("h.whl", "ColumnDef=X,A\n\n1 2\n", "has no X or no Y"),
        ("i.whl", "ColumnDef=X,Y\n", "there are none"),
        ("j.ban", "ColumnDef=A,X,Y\n\n1 2\n", "give two numbers"),
    ],
)
def test_broken_files(tmp_path: Path, name: str, text: str, said: str) -> None:
    assert said in refused(tmp_path / name, text)


def test_nan_and_turns_are_named_together(tmp_path: Path) -> None:
    y, z = coarse(WHEEL)
    assert "point 31" in refused(tmp_path / "nan.whl", miniprof(y, np.where(np.arange(len(z)) == 30, np.nan, z)))
    swapped = y.copy()
    swapped[[100, 101]] = swapped[[101, 100]]
    assert "y does not rise" in refused(tmp_path / "turn.whl", miniprof(swapped, z))
    assert "y does not rise" in refused(tmp_path / "turn.prw", simpack(swapped, z, kind=1))
    few = refused(tmp_path / "few.csv", "y_m,z_m\n" + "\n".join(f"{i},0" for i in range(5)))
    assert "too few" in few
    assert "outside 0.02 to 0.5 m" in few
