"""Boundary element computation by Capytaine, run as a script in a process of its own.

    python capytaine_worker.py REQUEST.json

It imports nothing of boatsim, so that it starts quickly and the memory of the computation ends with
it. The request is a JSON object; results are appended to its file `results`, one JSON object a
line, so that an interrupted computation continues where it ended. Progress is printed, one line
`done COUNT OF TOTAL` a frequency. Axes and phases are those of Capytaine: z up, exp(-i w t).
"""

import json
import sys
from pathlib import Path
from typing import Any, NamedTuple

AXES = ("Surge", "Sway", "Heave", "Roll", "Pitch", "Yaw")
# Share of the hull's size, to the power of the quantity, by which the sides may differ. Half of a
# symmetric hull is computed
SYMMETRIC = 1e-4
SNAP = 1e-6  # vertices closer to the waterline than this share of the hull's size lie in it
INFINITE = "infinite"
# Product of wave number and depth above which the water is taken as deep: the waves then differ
# from those of deep water by less than 0.3 % in their group velocity. In water of a finite depth
# Capytaine's waves conserve energy less well the larger the product is
DEEP = 4.5
# Angles of a Kochin function beyond four times the wave number times the radius of the hull: its
# square has twice the order of the function, whose terms decay fast above that product
ANGLES = 48
# Share of the frequency of a wave below which its frequency of encounter counts as near zero. The
# scattered waves are then longer than a hundred waves of the sea, and the potential differs from
# that of a rigid surface by about a hundredth of what waves at the frequency of the sea change
NEAR_ZERO = 0.1
# Product of wave number and depth below which the scattered waves are taken as near zero too:
# Capytaine 3.0 has no Green function for water of finite depth below 0.139
SHALLOW = 0.15
# Relative difference up to which a frequency of encounter is that of the wave, as in beam waves,
# whose cosine is rounded. Their matrix is then the one of the radiation
SAME_FREQUENCY = 1e-12


class MetWave(NamedTuple):
    """A wave that a hull under way meets.

    Attributes:
        frequency: Frequency of the wave [rad/s].
        encounter: Frequency at which the hull meets it [rad/s], negative if the hull overtakes it.
        heading: Direction to which it runs, relative to the hull [rad].
        speed: Forward speed [m/s].
    """

    frequency: float
    encounter: float
    heading: float
    speed: float


def triangles_of(request: dict[str, Any]) -> tuple[Any, Any]:
    """Return vertices (V, 3) and triangles (F, 3) of the whole hull in the axes of the result.

    The waterline is z = 0, and the origin of motion is the origin.

    Args:
        request: Path of the mesh, draught and origin [m], and longest edge of a panel [m].
    """
    import numpy as np
    import trimesh

    mesh = trimesh.load(request["mesh"], force="mesh")
    vertices = np.array(mesh.vertices, dtype=float) * request["scale"]
    vertices[:, 2] -= vertices[:, 2].min() + request["draught"]
    vertices[:, 0] -= request["origin"]
    vertices[np.abs(vertices[:, 2]) < SNAP * np.ptp(vertices), 2] = 0.0
    vertices, faces = trimesh.intersections.slice_faces_plane(
        vertices, np.array(mesh.faces), (0.0, 0.0, -1.0), (0.0, 0.0, 0.0)
    )[:2]
    level = np.all(vertices[faces][:, :, 2] == 0.0, axis=1)  # a deck at the waterline is dry
    faces = faces[~level]
    return vertices, faces


def is_symmetric(vertices: Any, faces: Any) -> bool:
    """Return whether a hull is symmetric to port and starboard.

    Area, waterplane, volume and their moments of both sides are compared.

    Args:
        vertices: Corners (V, 3) [m].
        faces: Triangles (F, 3).
    """
    import numpy as np
    import trimesh

    sums = []
    for side in (1.0, -1.0):
        points, triangles = trimesh.intersections.slice_faces_plane(
            vertices, faces, (0.0, side, 0.0), (0.0, 0.0, 0.0)
        )[:2]
        a, b, c = (points[triangles][:, i] for i in range(3))
        normal = 0.5 * np.cross(b - a, c - a)
        area = np.linalg.norm(normal, axis=1)
        x, y, z = (a + b + c).T / 3.0
        y = y * side
        values = [area, area * x, area * y, area * z, area * x * x, area * y * y, area * z * z]
        values += [normal[:, 2], normal[:, 2] * x, normal[:, 2] * y, normal[:, 2] * z]
        sums.append([float(np.sum(value)) for value in values])
    port, starboard = np.array(sums)
    size = np.ptp(vertices) ** np.array([2, 3, 3, 3, 4, 4, 4, 2, 3, 3, 3])
    return bool(np.all(np.abs(port - starboard) < SYMMETRIC * size))


def refined(vertices: Any, faces: Any, request: dict[str, Any]) -> tuple[Any, Any]:
    """Return panels with edges of at most the requested length, halved as often as requested.

    Args:
        vertices: Corners (V, 3) [m].
        faces: Triangles (F, 3).
        request: The request.
    """
    import trimesh

    if request["panel"] > 0.0:
        vertices, faces = trimesh.remesh.subdivide_to_size(
            vertices, faces, request["panel"], max_iter=20
        )
    for _ in range(request.get("halvings", 0)):
        vertices, faces = trimesh.remesh.subdivide(vertices, faces)
    return vertices, faces


def floating_body(request: dict[str, Any]) -> Any:
    """Return the wetted hull with a lid against irregular frequencies.

    Args:
        request: The request.
    """
    import capytaine
    import numpy as np
    import trimesh

    vertices, faces = triangles_of(request)
    symmetric = is_symmetric(vertices, faces)
    if symmetric:
        vertices, faces = trimesh.intersections.slice_faces_plane(
            vertices, faces, (0.0, 1.0, 0.0), (0.0, 0.0, 0.0)
        )[:2]
        inside = np.all(np.abs(vertices[faces][:, :, 1]) < SNAP * np.ptp(vertices), axis=1)
        faces = faces[~inside]  # in the plane of symmetry
    vertices, faces = refined(vertices, faces, request)
    if len(faces) > request["most_panels"]:
        raise SystemExit(
            f"{len(faces)} panels; allowed are {request['most_panels']}: give a longer --panel"
        )
    mesh = capytaine.Mesh(vertices=vertices, faces=np.column_stack([faces, faces[:, 2]]))
    if symmetric:
        mesh = capytaine.ReflectionSymmetricMesh(half=mesh, plane="xOz")
    lid = mesh.generate_lid()
    motions = capytaine.rigid_body_dofs(rotation_center=(0.0, 0.0, 0.0))
    return capytaine.FloatingBody(mesh=mesh, lid_mesh=lid, dofs=motions)


def geometry(body: Any) -> dict[str, Any]:
    """Return panels, volume, waterplane and buoyancy of a body, by integrals over its panels.

    Args:
        body: The wetted hull.
    """
    import numpy as np

    mesh = body.mesh
    area, centre, normal = mesh.faces_areas, mesh.faces_centers, mesh.faces_normals
    x, y, z = centre.T
    plane = -area * normal[:, 2]  # [m^2] of the waterplane above each panel
    volume = float(np.sum(plane * -z))
    return {
        "panels": int(mesh.nb_faces),
        "volume": volume,
        "buoyancy": [
            float(np.sum(plane * -z * x)) / volume,
            float(np.sum(plane * -z * y)) / volume,
            float(np.sum(plane * -z * z)) / 2.0 / volume,
        ],
        "area": float(np.sum(plane)),
        "first": [float(np.sum(plane * x)), float(np.sum(plane * y))],
        "second": [float(np.sum(plane * x * x)), float(np.sum(plane * y * y))],
        "size": [float(np.ptp(mesh.vertices[:, i])) for i in range(3)],
    }


def kochin_function(problem: Any, result: Any) -> list[list[float]]:
    """Return the Kochin function of a solution at equally spaced directions, from 0 on (T,).

    It is the amplitude of the waves far from the body,
    H(theta) = integral of (phi_n - phi d/dn) E over the hull / (4 pi),
    E = cosh k (z + h) / cosh k h exp(-i k (x cos theta + y sin theta)), with the normal into the
    water (J. N. Newman, J. Ship Research 11(1), 1967). The method of sources has the same function.

    Args:
        problem: Problem of Capytaine.
        result: Its solution.
    """
    import numpy as np

    mesh, k, depth = problem.body.mesh, problem.wavenumber, problem.water_depth
    x, y, z = mesh.faces_centers.T
    along, aside, up = mesh.faces_normals.T
    count = 2 * int(2.0 * k * np.hypot(x, y).max() + 0.5 * ANGLES)
    theta = 2.0 * np.pi / count * np.arange(count)[:, None]
    if np.isinf(depth):
        level = np.exp(k * z)
        slope = level
    else:
        near, far = np.exp(k * z), np.exp(-k * (z + 2.0 * depth))
        level = (near + far) / (1.0 + np.exp(-2.0 * k * depth))
        slope = (near - far) / (1.0 + np.exp(-2.0 * k * depth))
    wave = np.exp(-1j * k * (x * np.cos(theta) + y * np.sin(theta)))
    outward = np.cos(theta) * along + np.sin(theta) * aside
    gradient = k * wave * (slope * up - 1j * level * outward)
    hull = problem.body.hull_mask
    flux = problem.boundary_condition[hull] * wave * level - result.potential[hull] * gradient
    return complex_pairs(flux @ mesh.faces_areas / (4.0 * np.pi))


def radiation(solver: Any, body: Any, frequency: float, water: dict[str, Any]) -> Any:
    """Return added mass and damping (6, 6) and Kochin functions (6, T) at one frequency.

    At infinite frequency there are no waves, and no Kochin functions.

    Args:
        solver: Capytaine's solver.
        body: The wetted hull.
        frequency: Angular frequency [rad/s], or infinity.
        water: Depth, density and gravity as Capytaine takes them.
    """
    import capytaine
    import numpy as np

    added, damping, kochin = [], [], []
    for motion in AXES:
        problem = capytaine.RadiationProblem(
            body=body, radiating_dof=motion, omega=frequency, **water
        )
        result = solver.solve(problem)
        added.append([float(result.added_masses[axis]) for axis in AXES])
        damping.append([float(result.radiation_dampings[axis]) for axis in AXES])
        if not np.isinf(frequency):
            kochin.append(kochin_function(problem, result))
    return added, damping, kochin


def complex_pairs(values: Any) -> list[list[float]]:
    """Return complex numbers as pairs of real and imaginary part."""
    return [[float(value.real), float(value.imag)] for value in values]


def excitation(
    solver: Any, body: Any, frequency: float, headings: list[float], water: dict[str, Any]
) -> Any:
    """Return excitation (H, 6) and Kochin functions (H, T) of waves of unit amplitude.

    Args:
        solver: Capytaine's solver.
        body: The wetted hull.
        frequency: Angular frequency [rad/s].
        headings: Directions to which the waves run, counter-clockwise from x [rad].
        water: Depth, density and gravity as Capytaine takes them.
    """
    import capytaine
    from capytaine.bem.airy_waves import froude_krylov_force

    found, kochin = [], []
    for heading in headings:
        problem = capytaine.DiffractionProblem(
            body=body, wave_direction=heading, omega=frequency, **water
        )
        result = solver.solve(problem)
        pressure = froude_krylov_force(problem)
        found.append(complex_pairs([result.forces[axis] + pressure[axis] for axis in AXES]))
        kochin.append(kochin_function(problem, result))
    return found, kochin


def encounter_frequency(wave: MetWave, number: float) -> float:
    """Return the frequency at which a hull under way meets a wave [rad/s], w - k U cos beta.

    Args:
        wave: The wave; its field `encounter` is not used.
        number: Wave number [rad/m].
    """
    import numpy as np

    change = number * wave.speed * np.cos(wave.heading)
    if abs(change) < SAME_FREQUENCY * wave.frequency:
        return wave.frequency
    return float(wave.frequency - change)


def waves_at_speed(
    body: Any, frequency: float, headings: list[float], speed: float, water: dict[str, Any]
) -> list[MetWave]:
    """Return the waves of one frequency as a hull under way meets them.

    Args:
        body: The wetted hull.
        frequency: Angular frequency of the waves [rad/s].
        headings: Directions to which they run, counter-clockwise from x [rad].
        speed: Forward speed [m/s].
        water: Depth, density and gravity as Capytaine takes them.
    """
    import capytaine

    own = water_of_waves(frequency, water)
    number = capytaine.DiffractionProblem(body=body, omega=frequency, **own).wavenumber
    found = []
    for heading in headings:
        wave = MetWave(frequency, frequency, heading, speed)
        found.append(wave._replace(encounter=encounter_frequency(wave, number)))
    return found


def least_encounter(frequency: float, water: dict[str, Any]) -> float:
    """Return the frequency of encounter below which the scattered waves are interpolated [rad/s].

    Args:
        frequency: Frequency of the wave [rad/s].
        water: Depth, density and gravity as Capytaine takes them.
    """
    import numpy as np

    shallow = float(np.sqrt(water["g"] / water["water_depth"] * SHALLOW * np.tanh(SHALLOW)))
    return min(max(NEAR_ZERO * frequency, shallow), frequency)


def scattered_impulse(
    solver: Any, body: Any, condition: Any, encounter: float, water: dict[str, Any]
) -> Any:
    """Return the impulse J (6,) of scattered waves, whose force is -i w_e J, without speed [N s].

    At a negative frequency of encounter the potential is the complex conjugate of that of the
    conjugate condition at the positive frequency: the waves run away from the hull in both.

    Args:
        solver: Capytaine's solver.
        body: The wetted hull.
        condition: Normal velocity on the panels of hull and lid.
        encounter: Frequency of encounter [rad/s], not zero.
        water: Depth, density and gravity as Capytaine takes them.
    """
    import numpy as np
    from capytaine.bem.problems_and_results import LinearPotentialFlowProblem

    frequency = abs(encounter)
    if encounter < 0.0:
        condition = np.conj(condition)
    problem = LinearPotentialFlowProblem(
        body=body,
        omega=frequency,
        boundary_condition=condition,
        **water_of_waves(frequency, water),
    )
    forces = solver.solve(problem).forces
    impulse = np.array([forces[axis] for axis in AXES]) / (-1j * frequency)
    if encounter < 0.0:
        return np.conj(impulse)
    return impulse


def met_excitation(solver: Any, body: Any, wave: MetWave, water: dict[str, Any]) -> Any:
    """Return the excitation (6,) of a wave of unit amplitude on a hull under way [N/m, N].

    The waves that the hull scatters oscillate at the frequency of encounter, while the wave keeps
    its length. Their surface condition is that at zero speed, and their impulse J adds the moments
    -U J_z in pitch and U J_y in yaw (N. Salvesen, E. O. Tuck and O. Faltinsen, Ship motions and sea
    loads, Transactions of SNAME 78, 1970). The impulse is finite where the frequency of encounter
    is zero. Near zero it is interpolated between the solutions at both signs of `least_encounter`,
    so that it is continuous.

    Args:
        solver: Capytaine's solver.
        body: The wetted hull.
        wave: The wave.
        water: Depth, density and gravity as Capytaine takes them.
    """
    import capytaine
    import numpy as np
    from capytaine.bem.airy_waves import froude_krylov_force

    undisturbed = capytaine.DiffractionProblem(
        body=body,
        wave_direction=wave.heading,
        omega=wave.frequency,
        **water_of_waves(wave.frequency, water),
    )
    condition = undisturbed.boundary_condition
    least = least_encounter(wave.frequency, water)
    if abs(wave.encounter) >= least:
        impulse = scattered_impulse(solver, body, condition, wave.encounter, water)
    else:
        met, overtaken = (
            scattered_impulse(solver, body, condition, sign * least, water) for sign in (1.0, -1.0)
        )
        share = 0.5 + 0.5 * wave.encounter / least
        impulse = share * met + (1.0 - share) * overtaken
    pressure = froude_krylov_force(undisturbed)
    force = np.array([pressure[axis] for axis in AXES]) - 1j * wave.encounter * impulse
    force[AXES.index("Pitch")] -= wave.speed * impulse[AXES.index("Heave")]
    force[AXES.index("Yaw")] += wave.speed * impulse[AXES.index("Sway")]
    return force


def excitation_at_speed(
    solver: Any, body: Any, waves: list[MetWave], water: dict[str, Any]
) -> list[list[list[float]]]:
    """Return the excitation (H, 6) of waves on a hull under way, as pairs of numbers.

    Waves of equal frequency of encounter follow each other, because the solver keeps the matrix of
    the last one. The first ones are those of the frequency of the wave, at which it has computed
    the radiation.

    Args:
        solver: Capytaine's solver.
        body: The wetted hull.
        waves: Waves of one frequency.
        water: Depth, density and gravity as Capytaine takes them.
    """
    found: list[Any] = [None] * len(waves)

    def order(place: int) -> tuple[bool, float]:
        wave = waves[place]
        return wave.encounter != wave.frequency, abs(wave.encounter)

    for place in sorted(range(len(waves)), key=order):
        found[place] = complex_pairs(met_excitation(solver, body, waves[place], water))
    return found


def water_of_waves(frequency: float, water: dict[str, Any]) -> dict[str, Any]:
    """Return the water with the depth that waves of a frequency feel.

    Args:
        frequency: Angular frequency [rad/s].
        water: Depth, density and gravity as Capytaine takes them.
    """
    if frequency * frequency * water["water_depth"] / water["g"] > DEEP:
        return water | {"water_depth": float("inf")}
    return water


def main(path: str) -> None:
    """Compute all frequencies of a request that its results lack.

    Args:
        path: Path of the request.
    """
    import capytaine
    import numpy as np

    request = json.loads(Path(path).read_text(encoding="utf-8"))
    results = Path(request["results"])
    done = set()
    if results.exists():
        for line in results.read_text(encoding="utf-8").splitlines():
            done.add(json.loads(line)["frequency"])
    capytaine.set_logging("ERROR")
    body = floating_body(request)
    # the indirect method is 3 to 5 % too large for a hemisphere of some hundred panels
    solver = capytaine.BEMSolver(method="direct")
    water = {"water_depth": np.inf, "rho": request["density"], "g": request["gravity"]}
    if request["depth"] > 0.0:
        water["water_depth"] = request["depth"]
    frequencies = [*request["frequencies"], INFINITE]
    if "geometry" not in done:
        append_line(results, {"frequency": "geometry", **geometry(body)})
    for number, frequency in enumerate(frequencies, 1):
        if frequency not in done:
            row: dict[str, Any] = {"frequency": frequency}
            if frequency == INFINITE:
                row["added_mass"], _, _ = radiation(solver, body, np.inf, water)
            else:
                own = water_of_waves(frequency, water)
                found = radiation(solver, body, frequency, own)
                row["added_mass"], row["damping"], row["radiation_kochin"] = found
                waves = excitation(solver, body, frequency, request["headings"], own)
                row["excitation"], row["diffraction_kochin"] = waves
                if request["speed"] > 0.0:
                    met = waves_at_speed(
                        body, frequency, request["headings"], request["speed"], water
                    )
                    row["excitation_at_speed"] = excitation_at_speed(solver, body, met, water)
            append_line(results, row)
        print(f"done {number} of {len(frequencies)}", flush=True)


def append_line(path: Path, row: dict[str, Any]) -> None:
    """Append one JSON object to a file, as one line."""
    with path.open("a", encoding="utf-8") as file:
        file.write(json.dumps(row) + "\n")


if __name__ == "__main__":
    main(sys.argv[1])
