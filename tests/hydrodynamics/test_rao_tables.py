"""Response amplitude operators: conventions of each format against a body that follows the surface.

A body in long waves moves with the water at the surface and turns with its slope. Its motion is
written down in the axes of each program, and must arrive as the same motion in SNAME axes.
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat
from typer.testing import CliRunner

from boatsim.cli import app
from boatsim.errors import BadInput
from boatsim.hydrodynamics.mss import read_mss
from boatsim.hydrodynamics.rao_csv import read_rao_csv
from boatsim.hydrodynamics.rao_table import (
    Complex,
    RaoTable,
    at_origin,
    complete_table,
    opposite_axes,
)
from boatsim.hydrodynamics.veres import read_veres
from boatsim.hydrodynamics.wamit import OutputScale, read_wamit, read_wamit_operators
from boatsim.physics.base import AXES, Array
from boatsim.physics.coefficients.files import read_coefficients, read_wave_loads
from tests.physics.coefficients.test_output_files import write_wamit

OTTER = Path(__file__).parents[2] / "models" / "otter" / "hydrodynamics"
DIRECTIONS = np.arange(0.0, 181.0, 30.0)  # [deg]
FREQUENCIES = np.array([0.3, 0.4, 0.6])  # [rad/s]
LENGTH = 4.0  # [m] unit of WAMIT
WATER = OutputScale(LENGTH, 1025.0, 0.0, 0.0)


def follower_z_up(w: float, direction: float) -> Complex:
    """Motion of a body that follows the surface, in any axes with z up.

    The elevation exp(i (w t - k x cos b - k y sin b)) moves the water by -i along the direction b
    and by 1 upwards, and its gradient, -i k times the direction, turns the vertical about the axis
    to the left of it.

    Args:
        w: Frequency [rad/s].
        direction: Direction b to which the waves run [rad], counter-clockwise from x.
    """
    k, c, s = w * w / 9.81, np.cos(direction), np.sin(direction)
    return np.array([-1j * c, -1j * s, 1.0, -1j * k * s, 1j * k * c, 0.0])


def follower(w: float, direction: float) -> Complex:
    """The same in SNAME axes: the direction is clockwise, and z is down.

    The wave is to starboard of the bow: its crest, at the body at t = 0, comes from port, and later
    the rising slope to starboard rolls the body to port.
    """
    k, c, s = w * w / 9.81, np.cos(direction), np.sin(direction)
    return np.array([-1j * c, -1j * s, -1.0, 1j * k * s, -1j * k * c, 0.0])


def check_follower(found: RaoTable) -> None:
    """Check that a table has the motion of a body that follows the surface."""
    assert found.kind == "motion" and found.axes == AXES
    assert found.frequency == pytest.approx(FREQUENCIES, rel=1e-6)
    assert found.heading == pytest.approx(np.radians(DIRECTIONS), abs=1e-6)
    for i, w in enumerate(FREQUENCIES):
        for j, heading in enumerate(np.radians(DIRECTIONS)):
            assert np.abs(found.values[i, j] - follower(w, heading)).max() < 1e-6
    assert opposite_axes(found) == ()


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_motions_of_wamit(tmp_path: Path, side: float) -> None:
    lines = ["PERIOD BETA I MOD PHS REAL IMAG"]
    for w in FREQUENCIES:
        for degrees in side * DIRECTIONS:
            for i, x in enumerate(follower_z_up(w, np.radians(degrees))):
                x = x * LENGTH ** float(i > 2)
                polar = f"{abs(x):.8e} {np.degrees(np.angle(x)):.6f} {x.real:.8e} {x.imag:.8e}"
                lines.append(f" {2 * np.pi / w:.9e} {degrees:.3f} {i + 1} {polar}")
    (tmp_path / "ship.4").write_text("\n".join(lines))
    check_follower(read_wamit_operators(tmp_path / "ship.4", WATER, 0.0))


def test_loads_of_wamit_are_those_of_its_coefficients(tmp_path: Path) -> None:
    path = write_wamit(tmp_path)
    scale = OutputScale(2.0, 1025.0, 0.0, 0.134)
    whole = read_wamit(path, scale)
    for suffix in (".3", ".2"):
        path.with_suffix(".3").rename(path.with_suffix(suffix))
        found = read_wamit_operators(path.with_suffix(suffix), scale, 0.0)
        path.with_suffix(suffix).rename(path.with_suffix(".3"))
        assert found.kind == "load" and opposite_axes(found) == ()
        size = np.abs(whole.excitation).max()
        assert np.abs(found.values - whole.excitation).max() < 1e-6 * size


def write_veres(path: Path, aft: float = 3.0, above: float = 2.0) -> Path:
    """File of VERES for two speeds: x aft, y to starboard, z up, 0 deg from ahead."""
    lines = ["text"] * 6 + ["1025.0 9.81", "40.0 8.0 2.0", "3.0 2.5"]
    lines.append(f"2 {len(DIRECTIONS)} {len(FREQUENCIES)} 6")
    for speed in (0.0, 5.0):
        lines.append(f"{speed} 0.0 0.0 {aft} {above}")
        for degrees in DIRECTIONS:
            lines.append(f"{degrees}")
            for w in FREQUENCIES:
                lines.append(f"{w}")
                for i, x in enumerate(follower_z_up(w, np.radians(degrees))):
                    lines.append(f"{i + 1} {x.real:.8E} {x.imag:.8E}")
    path.write_text("\n".join(lines))
    return path


def test_motions_of_veres(tmp_path: Path) -> None:
    path = write_veres(tmp_path / "ship.re1")
    found = read_veres(path, 0.0, 0.0)
    check_follower(found)
    assert found.point == (0.0, 0.0)  # at the mass centre and in the waterplane
    assert read_veres(path, 0.0, 5.0).speed == 5.0
    # 1 m less aft and 0.5 m higher than the origin
    assert read_veres(write_veres(path, 2.0, 2.5), 0.0, 0.0).point == (1.0, -0.5)
    assert read_veres(path.rename(tmp_path / "ship.re8"), 0.0, 0.0).kind == "load"


def test_motions_of_mss(tmp_path: Path) -> None:
    headings = np.radians(np.arange(0.0, 360.0, 30.0))
    table = np.array([[follower(w, b) for b in headings] for w in FREQUENCIES])
    size = np.empty(6, dtype=object)
    phase = np.empty(6, dtype=object)
    for i in range(6):
        size[i], phase[i] = np.abs(table[:, :, i]), np.angle(table[:, :, i])
    operators = {"amp": size, "phase": phase, "w": FREQUENCIES}
    vessel = {"headings": headings, "velocities": 0.0, "motionRAO": operators}
    savemat(tmp_path / "ship.mat", {"vessel": vessel})
    check_follower(read_mss(tmp_path / "ship.mat", 0.0, 0.0))


def write_mss_of_both(path: Path, yaw_to_port: float = -1.0) -> Path:
    """Vessel structure of MSS with motions of a follower, ten times as large loads, and drift."""
    headings = np.radians(np.arange(0.0, 360.0, 30.0))
    table = np.array([[follower(w, b) for b in headings] for w in FREQUENCIES])
    parts: dict[str, object] = {"headings": headings, "velocities": 0.0}
    for name, factor in (("motionRAO", 1.0), ("forceRAO", 10.0)):
        size, phase = np.empty(6, dtype=object), np.empty(6, dtype=object)
        for i in range(6):
            size[i], phase[i] = factor * np.abs(table[:, :, i]), np.angle(table[:, :, i])
        parts[name] = {"amp": size, "phase": phase, "w": FREQUENCIES}
    # linear in the frequency, at other frequencies than the operators
    own, drift = np.array([0.2, 0.5, 0.7]), np.empty(6, dtype=object)
    side = np.where(np.sin(headings) < -1e-9, yaw_to_port, 1.0)
    yaw = np.abs(np.sin(2.0 * headings)) * side
    for i, over_heading in enumerate((np.cos(headings), np.sin(headings), yaw)):
        drift[i] = np.outer(own, over_heading)
    for i in range(3, 6):
        drift[i] = np.zeros((3, len(headings)))
    savemat(path, {"vessel": {**parts, "driftfrc": {"amp": drift, "w": own}}})
    return path


@pytest.mark.parametrize("yaw_to_port", [-1.0, 1.0])
def test_loads_and_mean_drift_of_mss(tmp_path: Path, yaw_to_port: float) -> None:
    path = write_mss_of_both(tmp_path / "ship.mat", yaw_to_port)
    check_follower(read_mss(path, 0.0, 0.0))
    found = read_mss(path, 0.0, 0.0, "load")
    assert found.kind == "load"
    assert found.values[1, 2] == pytest.approx(10.0 * follower(0.4, np.radians(60.0)))
    assert found.drift is not None
    # waves that run to starboard count, whatever the other side of the file has
    angle = np.radians(DIRECTIONS)
    expected = np.stack([np.cos(angle), np.sin(angle), np.abs(np.sin(2.0 * angle))], axis=-1)
    assert found.drift == pytest.approx(FREQUENCIES[:, None, None] * expected)


def test_a_structure_of_mss_without_a_vessel_gives_its_loads_and_drift(tmp_path: Path) -> None:
    path = write_mss_of_both(tmp_path / "ship.mat")
    done = CliRunner().invoke(app, ["hydrodynamics", str(path), "--out", str(tmp_path / "loads")])
    assert done.exit_code == 0, done.output
    assert "loads of MSS, ship.mat" in done.output and "yaw, and mean drift" in done.output
    written = read_wave_loads(tmp_path / "loads")
    assert written.drift is not None
    assert written.drift[2, 0, 0] == pytest.approx(0.6)


def drift_of_mss(path: Path, part: object) -> Array | None:
    """Write a structure with motions of a follower and a part `driftfrc`; read its mean drift."""
    table = np.array([[follower(w, b) for b in np.radians(DIRECTIONS)] for w in FREQUENCIES])
    size, phase = np.empty(6, dtype=object), np.empty(6, dtype=object)
    for i in range(6):
        size[i], phase[i] = np.abs(table[:, :, i]), np.angle(table[:, :, i])
    vessel: dict[str, object] = {"headings": np.radians(DIRECTIONS), "velocities": 0.0}
    vessel["motionRAO"] = {"amp": size, "phase": phase, "w": FREQUENCIES}
    savemat(path, {"vessel": {**vessel, "driftfrc": part}})
    found = read_mss(path, 0.0, 0.0)
    check_follower(found)
    return found.drift


def linear_drift(frequency: Array, headings: int = len(DIRECTIONS)) -> dict[str, object]:
    """Mean drift of MSS that is equal to the frequency in surge, sway and yaw at all headings."""
    size = np.empty(3, dtype=object)
    for i in range(3):
        size[i] = np.outer(frequency, np.ones(headings))
    return {"amp": size, "w": frequency}


def test_a_structure_of_mss_with_an_empty_drift_gives_its_motions(tmp_path: Path) -> None:
    none = np.zeros((0, 0))
    assert drift_of_mss(tmp_path / "ship.mat", none) is None
    assert drift_of_mss(tmp_path / "ship.mat", {"amp": none, "w": none}) is None


def test_frequencies_of_the_drift_of_mss_may_decrease(tmp_path: Path) -> None:
    found = drift_of_mss(tmp_path / "ship.mat", linear_drift(np.array([0.7, 0.5, 0.2])))
    assert found is not None
    assert found == pytest.approx(np.broadcast_to(FREQUENCIES[:, None, None], found.shape))


def test_incomplete_drift_of_mss_is_refused_by_its_name(tmp_path: Path) -> None:
    frequency = np.array([0.2, 0.5, 0.7])
    with pytest.raises(BadInput, match="driftfrc needs .* at each of the headings"):
        drift_of_mss(tmp_path / "ship.mat", linear_drift(frequency, len(DIRECTIONS) - 2))
    with pytest.raises(BadInput, match="a number of driftfrc is not finite"):
        drift_of_mss(tmp_path / "ship.mat", linear_drift(np.array([0.2, 0.5, np.nan])))


def test_mean_drift_of_mss_that_lacks_an_axis_is_refused(tmp_path: Path) -> None:
    size = np.empty(2, dtype=object)
    size[0] = size[1] = np.ones((len(FREQUENCIES), len(DIRECTIONS)))
    loads = np.empty(6, dtype=object)
    for i in range(6):
        loads[i] = size[0]
    operators = {"amp": loads, "phase": loads, "w": FREQUENCIES}
    vessel = {"headings": np.radians(DIRECTIONS), "velocities": 0.0, "forceRAO": operators}
    vessel["driftfrc"] = {"amp": size, "w": FREQUENCIES}
    savemat(tmp_path / "ship.mat", {"vessel": vessel})
    with pytest.raises(BadInput, match="driftfrc needs w, and amp of surge, sway and yaw"):
        read_mss(tmp_path / "ship.mat", 0.0, 0.0)


def write_csv(
    path: Path, motion: Callable[[float, float], Complex], head: str = "", turn: float = 0.0
) -> Path:
    """Plain table of motions in degrees, over periods and directions to which the waves run."""
    names = "surge_m,sway_m,heave_m,roll_deg,pitch_deg,yaw_deg".split(",")
    columns = ["direction_deg", "period_s"]
    columns += [f"{name}_per_m,{name.split('_')[0]}_phase_deg" for name in names]
    lines = [head + ",".join(columns)]
    for degrees in DIRECTIONS:
        for w in FREQUENCIES:
            row = [f"{degrees + turn:.9g}", f"{2 * np.pi / w:.9g}"]
            for i, x in enumerate(motion(w, np.radians(degrees))):
                factor = np.degrees(1.0) ** float(i > 2)
                row.append(f"{abs(x) * factor:.9g},{np.degrees(np.angle(x)):.9g}")
            lines.append(",".join(row))
    path.write_text("\n".join(lines) + "\n")
    return path


def test_motions_of_a_plain_table(tmp_path: Path) -> None:
    path = tmp_path / "ship.csv"
    check_follower(read_rao_csv(write_csv(path, follower), 0.0))
    head = "# a remark\n# axes = z-up\n"
    check_follower(read_rao_csv(write_csv(path, follower_z_up, head), 0.0))
    lagging = write_csv(path, lambda w, b: np.conj(follower(w, b)), "# phase = lag\n")
    check_follower(read_rao_csv(lagging, 0.0))
    coming = write_csv(path, follower, "# direction = from\n", 180.0)
    check_follower(read_rao_csv(coming, 0.0))
    moving = read_rao_csv(write_csv(path, follower, "# speed = 2.5\n# x = 1\n# z = -2\n"), 0.0)
    assert moving.speed == 2.5 and moving.point == (1.0, -2.0)


def test_wrong_conventions_are_noticed_in_long_waves(tmp_path: Path) -> None:
    path = tmp_path / "ship.csv"
    lagging = read_rao_csv(write_csv(path, follower, "# phase = lag\n"), 0.0)
    assert opposite_axes(lagging) == ("surge", "sway", "roll", "pitch")
    upward = read_rao_csv(write_csv(path, follower_z_up), 0.0)
    assert "heave" in opposite_axes(upward)


def test_a_rigid_body_has_one_motion_at_all_of_its_points() -> None:
    x, z, w, heading = 2.0, -1.5, 0.5, np.array([0.0, 1.0, 2.5, np.pi])
    frequency = np.array([w, 2.0 * w, 3.0 * w])
    rng = np.random.default_rng(3)
    own = rng.normal(size=(3, 4, 6)) + 1j * rng.normal(size=(3, 4, 6))
    rotation = own[..., 3:]
    arm = np.array([x, 0.0, z])
    moved = own.copy()
    moved[..., :3] += np.cross(rotation, arm)
    # the wave reaches the point later than the origin
    k = frequency**2 / 9.81
    moved *= np.exp(1j * x * np.outer(k, np.cos(heading)))[..., None]
    there = RaoTable("there", "motion", frequency, heading, moved, point=(x, z))
    assert at_origin(there).values == pytest.approx(own)
    force = own.copy()  # the same load about the point, in the phase of the wave there
    force[..., 3:] -= np.cross(arm, own[..., :3])
    force *= np.exp(1j * x * np.outer(k, np.cos(heading)))[..., None]
    loads = RaoTable("there", "load", frequency, heading, force, point=(x, z))
    assert at_origin(loads).values == pytest.approx(own)


def test_heave_elsewhere_needs_pitch() -> None:
    values = np.full((3, 2, 6), np.nan + 0j)
    values[..., 2] = -1.0
    frequency, heading = np.array([1.0, 2.0, 3.0]), np.array([0.0, np.pi])
    above = RaoTable("a.csv", "motion", frequency, heading, values, point=(0.0, -1.0))
    assert at_origin(above).axes == ("heave",)
    ahead = RaoTable("a.csv", "motion", frequency, heading, values, point=(1.0, 0.0))
    with pytest.raises(BadInput, match="heave at the vessel's origin, -1 m ahead"):
        at_origin(ahead)


LINE = "0,5,1,0\n90,5,1,0\n0,6,1,0\n90,6,1,0\n0,7,1,0\n90,7,1,0\n"
HEAD = "direction_deg,period_s,heave_m_per_m,heave_phase_deg\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "there are no rows"),
        ("# axes = up\n" + HEAD + LINE, "ship.csv:1: axes = 'up'; allowed are sname, z-up"),
        ("# phse = lag\n" + HEAD + LINE, "did you mean 'phase'"),
        ("# speed = fast\n" + HEAD + LINE, "speed = 'fast'; a number is required"),
        (HEAD + "0,5,x,0\n", "ship.csv:2: heave_m_per_m = 'x'; a number is required"),
        (HEAD + "0,5,nan,0\n", "heave_m_per_m = 'nan'; a number is required"),
        ("# speed of the ship = 3\n" + HEAD + LINE, "convention 'speed of the ship' does not"),
        ("# speed = -3\n" + HEAD + LINE, "ship.csv: speed = -3 m/s; allowed is 0 and above"),
        (HEAD + "0,5," + "1" * 1_100_000 + ",0\n", "ship.csv: no CSV file"),
        (HEAD + "0,5\n", "ship.csv:2: 2 columns; 4 are required"),
        (HEAD + LINE + "0,8,1,0\n", "0.7854 rad/s lacks 90 deg"),
        (HEAD + "0,5,1,0\n0,6,1,0\n", "at least three frequencies"),
        (HEAD.replace("deg,period", "deg,time") + LINE, "frequency_radps or period_s is required"),
        (HEAD.replace("direction", "angle") + LINE, "direction_rad or direction_deg is required"),
        (HEAD.replace("heave_phase", "phase") + LINE, "heave_phase_rad or heave_phase_deg"),
        (HEAD.replace("heave_m_per", "heave_ft_per") + LINE, "a column such as heave_m_per_m"),
        (HEAD + LINE.replace("0,5,", "0,0,"), "period_s must be above 0"),
        (
            HEAD.replace("\n", ",surge_N_per_m,surge_phase_rad\n") + LINE.replace("\n", ",1,0\n"),
            "heave_m_per_m is a motion and surge_N_per_m a load",
        ),
    ],
)
def test_a_table_of_another_form_is_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "ship.csv"
    path.write_text(text)
    with pytest.raises(BadInput) as caught:
        read_rao_csv(path, 0.0)
    assert message in str(caught.value) and "\n" not in str(caught.value)


def test_remarks_with_an_equals_sign_are_no_conventions(tmp_path: Path) -> None:
    head = "# made with dt = 0.1\n# dt = 0.1\n# x forward, w = omega\n# = 5\n# x = 1\n"
    found = read_rao_csv(write_csv(tmp_path / "ship.csv", follower, head), 0.0)
    assert found.point == (1.0, 0.0)


def waves_of_follower() -> tuple[Array, Complex]:
    """Rows of a complete table: frequency and direction (R, 2), and motions (R, 6)."""
    waves, rows = [], []
    for w in FREQUENCIES:
        for heading in np.radians(DIRECTIONS):
            waves.append((w, heading))
            rows.append(follower(w, heading))
    return np.array(waves), np.array(rows)


def test_an_axis_with_holes_is_refused() -> None:
    waves, rows = waves_of_follower()
    rows[:, 5] = np.nan  # an axis that the table does not have
    _, _, values = complete_table(waves, rows, Path("ship.4"))
    assert np.isnan(values[..., 5]).all() and np.isfinite(values[..., :5]).all()
    for hole in (np.nan, np.inf):
        rows[9, 2] = hole
        words = "ship.4: heave has no finite value at 0.4 rad/s and 60 deg"
        with pytest.raises(BadInput, match=words):
            complete_table(waves, rows, Path("ship.4"))
    waves[3, 1] = np.nan
    with pytest.raises(BadInput, match=r"ship.4: a frequency or a direction is not a number"):
        complete_table(waves, rows, Path("ship.4"))


def test_a_number_that_overflows_its_columns_is_refused(tmp_path: Path) -> None:
    lines = []
    for period in (4, 5, 6):
        for direction in (0, 45, 90, 135, 180):
            lines.append(f"{period} {direction} 3 1.0 0.1 0.5 0.5")
    path = tmp_path / "ship.4"
    path.write_text("\n".join(lines))
    assert read_wamit_operators(path, WATER, 0.0).axes == ("heave",)
    lines[4] = "4 180 3 ******* 0.1 ******* 0.5"
    path.write_text("\n".join(lines))
    with pytest.raises(BadInput, match=r"ship.4:5: .* a value is no number"):
        read_wamit_operators(path, WATER, 0.0)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("2 7 3 6", "2 0 3 6", "0 headings; allowed is a whole number from 1 on"),
        ("2 7 3 6", "2 7 2.5 6", "2.5 frequencies; allowed is a whole number from 1 on"),
        ("2 7 3 6", "inf 7 3 6", "ship.re1:10: 'inf' is not a number"),
        ("3.0 2.5", "nan 2.5", "ship.re1:9: 'nan' is not a number"),
    ],
)
def test_damaged_output_of_veres_is_refused(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    path = write_veres(tmp_path / "ship.re1")
    path.write_text(path.read_text().replace(old, new, 1))
    with pytest.raises(BadInput, match=message):
        read_veres(path, 0.0, 0.0)


def write_mss(path: Path, phases: int = 6, velocities: tuple[float, ...] = (0.0,)) -> Path:
    """Vessel structure of MSS whose arrays have one speed."""
    size, phase = np.empty(6, dtype=object), np.empty(phases, dtype=object)
    for tables in (size, phase):
        for i in range(len(tables)):
            tables[i] = np.ones((len(FREQUENCIES), len(DIRECTIONS)))
    operators = {"amp": size, "phase": phase, "w": FREQUENCIES}
    vessel = {"headings": np.radians(DIRECTIONS), "motionRAO": operators}
    savemat(path, {"vessel": {**vessel, "velocities": velocities}}, do_compression=True)
    return path


def test_damaged_files_of_mss_are_refused(tmp_path: Path) -> None:
    path = write_mss(tmp_path / "ship.mat")
    assert read_mss(path, 0.0, 0.0).axes == AXES
    whole = path.read_bytes()
    middle = len(whole) // 2
    for part in (b"", whole[:100], whole[:150], whole[:-30], whole[:middle] + whole[middle + 9 :]):
        path.write_bytes(part)
        with pytest.raises(BadInput, match="ship.mat: there is no structure `vessel`"):
            read_mss(path, 0.0, 0.0)
    write_mss(path, phases=3)
    with pytest.raises(BadInput, match="ship.mat: 6 axes of amp and 3 of phase"):
        read_mss(path, 0.0, 0.0)
    write_mss(path, velocities=(0.0, 5.0))
    with pytest.raises(BadInput, match="amp of surge has 1 of the 2 velocities"):
        read_mss(path, 0.0, 5.0)


def test_output_of_another_form_is_refused(tmp_path: Path) -> None:
    path = write_veres(tmp_path / "ship.re1")
    with pytest.raises(BadInput, match=r"--speed = 3 m/s; the table has 0, 5 m/s"):
        read_veres(path, 0.0, 3.0)
    path.write_text("\n".join(path.read_text().splitlines()[:40]))
    with pytest.raises(BadInput, match="the file ends early"):
        read_veres(path, 0.0, 0.0)
    path.write_text("text\n" * 7)
    with pytest.raises(BadInput, match="ship.re1:7: 'text' is not a number"):
        read_veres(path, 0.0, 0.0)
    savemat(tmp_path / "ship.mat", {"boat": 1.0})
    with pytest.raises(BadInput, match="there is no structure `vessel` of MSS"):
        read_mss(tmp_path / "ship.mat", 0.0, 0.0)
    (tmp_path / "ship.mat").write_text("text")
    with pytest.raises(BadInput, match="there is no structure `vessel` of MSS"):
        read_mss(tmp_path / "ship.mat", 0.0, 0.0)
    (tmp_path / "ship.4").write_text("5.0 0.0 3 1.0 0.0\n")
    with pytest.raises(BadInput, match="a row has 5 columns; 7 are required"):
        read_wamit_operators(tmp_path / "ship.4", WATER, 0.0)
    for read in (read_mss, read_veres):
        with pytest.raises(BadInput, match="there is no such file"):
            read(tmp_path / "none.re1", 0.0, 0.0)


def invoked(*words: str) -> tuple[int, str]:
    """Exit code and output of `boatsim hydrodynamics`."""
    done = CliRunner().invoke(app, ["hydrodynamics", *words], catch_exceptions=False)
    return done.exit_code, " ".join(done.output.split())


def test_the_command_writes_loads_that_the_effect_reads(tmp_path: Path) -> None:
    path = str(write_csv(tmp_path / "ship.csv", follower))
    code, printed = invoked(path, "--vessel", "otter")
    assert code == 0 and "motions of ship.csv for otter" in printed
    assert "3 frequencies from 0.3 to 0.6 rad/s, 7 headings" in printed
    found = read_wave_loads(tmp_path / "hydrodynamics")
    assert found.drift is None and found.excitation.shape == (3, 7, 6)
    with pytest.raises(BadInput, match=r"radiation.csv: the file is missing"):
        read_coefficients(tmp_path / "hydrodynamics")
    (tmp_path / "hydrodynamics" / "drift_pairs.csv").write_text("of another program")
    code, printed = invoked(path, "--vessel", "otter")
    assert code == 0 and "renamed to drift_pairs.csv.old" in printed


def test_loads_of_a_table_keep_its_speed_and_those_of_motions_belong_to_the_vessel(
    tmp_path: Path,
) -> None:
    moving = str(write_csv(tmp_path / "ship.csv", follower, "# speed = 1.5\n"))
    lines = (tmp_path / "ship.csv").read_text()
    (tmp_path / "load.csv").write_text(
        lines.replace("_m_per_m", "_N_per_m").replace("_deg_per_m", "_Nm_per_m")
    )
    code, printed = invoked(moving, "--vessel", "otter", "--out", str(tmp_path / "motions"))
    assert code == 0, printed
    assert read_wave_loads(tmp_path / "motions").speed == 0.0
    code, printed = invoked(str(tmp_path / "load.csv"), "--out", str(tmp_path / "loads"))
    assert code == 0, printed
    assert read_wave_loads(tmp_path / "loads").speed == 1.5


def test_the_command_notes_what_it_does_not_use(tmp_path: Path) -> None:
    path = str(write_csv(tmp_path / "ship.csv", follower, "# phase = lag\n"))
    code, printed = invoked(path, "--vessel", "osv")
    assert code == 0 and "osv is not free in heave, roll, pitch; not used" in printed
    assert "surge, sway, roll, pitch of the longest waves, 0.3 rad/s, oppose" in printed


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["{path}"], "a table of motions needs --vessel"),
        (["{path}", "--vessel", "ottr"], "did you mean 'otter'"),
        (["{path}", "--vessel", "otter", "--speed", "2"], "--speed = 2 m/s; the table has 0 m/s"),
        (["{path}", "--vessel", "otter", "--out", str(OTTER)], "contains the coefficients of a"),
        (["{load}", "--vessel", "otter"], "--vessel and --load apply to tables of motions"),
        (
            ["{mesh}", "--vessel", "otter", "--draught", "1"],
            "--vessel and --load apply to tables",
        ),
        (["{mesh}", "--draught", "1", "--speed", "1"], "--speed applies to meshes (.stl, .obj"),
        (["{mesh}", "--draught", "1", "--speed", "-1"], "--speed"),
        (["{mesh}"], "--draught is required for a mesh"),
        (["{other}", "--draught", "1"], "tables of response amplitude operators (.2, .3, .4"),
    ],
)
def test_bad_input_is_one_line(tmp_path: Path, words: list[str], message: str) -> None:
    path = write_csv(tmp_path / "ship.csv", follower)
    (tmp_path / "load.csv").write_text(HEAD.replace("heave_m_", "heave_N_") + LINE)
    names = {"path": path, "load": tmp_path / "load.csv", "mesh": tmp_path / "ship.1"}
    names["other"] = tmp_path / "ship.txt"
    code, printed = invoked(*(word.format(**names) for word in words))
    assert code == 2 and message in printed
