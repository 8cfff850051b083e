"""Composes a vessel's effects into one compiled program that engine, twin and diagnosis share.

The composition is written out as Python source: the vessel's laws unrolled over its flat parameter array, then the
kernels of its freedoms. The file lies in the user's cache folder under a name made from its content and from the
content of every law in it, so that numba's cache can never return the number of a law edited since.
"""

import hashlib
import os
import re
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from inspect import getsourcefile
from pathlib import Path
from types import ModuleType

import numba
import numpy as np

from boatsim.errors import BadInput
from boatsim.files import replacing
from boatsim.physics.base import (
    Array,
    Channel,
    Effect,
    Flow,
    Force,
    Inertia,
    Measurement,
    Reaction,
    Release,
    Unsteady,
    alias_fields,
    angle_fields,
    fixed_fields,
)
from boatsim.physics.commands import taken_row
from boatsim.physics.content import address, module_at
from boatsim.physics.vessel import Vessel

KERNELS = Path(__file__).parent / "kernel"
FREE_IN = {  # freedoms -> kernel
    frozenset({"surge", "sway", "yaw"}): "planar",
    frozenset({"surge", "sway", "yaw", "roll"}): "heel",
    frozenset({"roll"}): "roll",
}
KEPT = 90 * 86400.0  # [s] after its last use that a composed program stays in the cache


@dataclass(frozen=True)
class Program:
    """The effects of a vessel, some of them optional, as compiled functions over one flat parameter array.

    `module` offers `constants, step_in_place, steps, forces, actuate_in_place, rollout` and, for the diagnosis, the
    filter; see `boatsim/physics/kernel/`.
    """

    vessel: Vessel
    suspects: tuple[Effect, ...] = ()  # those with a law act only where `on` says so
    effects: tuple[Effect, ...] = field(init=False)
    offsets: tuple[int, ...] = field(init=False)  # where each effect's parameters start

    def __post_init__(self) -> None:
        laws = (e for e in self.suspects if not isinstance(e, Release))  # a release has nothing to compile
        object.__setattr__(self, "effects", (*self.vessel.effects, *laws))
        sizes = [len(type(e).params()) for e in self.effects]
        object.__setattr__(self, "offsets", tuple(int(n) for n in np.cumsum([0, *sizes])[:-1]))

    def values(self) -> Array:
        """Parameters of all effects, flat."""
        return np.array([v for e in self.effects for v in e.values()], dtype=float)

    def switches(self, active: Sequence[str] = ()) -> Array:
        """`on` with the named suspects acting."""
        own = len(self.vessel.effects)
        return np.array([i < own or e.name() in active for i, e in enumerate(self.effects)], dtype=np.float64)

    def index(self, effect: str, parameter: str) -> int:
        """Position of one parameter in the flat array."""
        i = next(i for i, e in enumerate(self.effects) if e.name() == effect)
        return self.offsets[i] + list(type(self.effects[i]).params()).index(parameter)

    @cached_property
    def body(self) -> Array:
        """Rigid mass [kg], roll and yaw inertia [kg m^2]."""
        b = self.vessel.body
        return np.array([b.mass, b.roll_inertia, b.yaw_inertia])

    @cached_property
    def memory_size(self) -> int:
        """Floats that all channels together remember."""
        return sum(type(e).slots * len(self.targets(e)) for e in self.effects if isinstance(e, Channel)) or 1

    def targets(self, effect: Channel) -> list[str]:
        """Actuators a channel effect acts on."""
        return [a for a in self.vessel.actuators if type(effect).acts_on in ("", self.vessel.commands[a].family)]

    def command_array(self, commands: Mapping[str, float]) -> Array:
        """(C,) in force when these are sent, in the vessel's order; those not given are neutral. Raises BadInput."""
        return taken_row(self.vessel, commands)

    @cached_property
    def module(self) -> ModuleType:
        """The compiled program, from the cache if the same one was composed before."""
        source = _source(self)
        folder = _cache_folder()
        stamp = _stamp(self, source)
        path = folder / f"program_{stamp}.py"
        if path.exists():
            with suppress(OSError):
                os.utime(path)  # it is in use; numba goes by the content
        else:
            with replacing(path) as temporary:
                temporary.write_text(source)
            _prune(folder)
        return module_at(path, f"boatsim_program_{stamp}")


def _cache_folder() -> Path:
    """~/.cache/boatsim, or a folder of the user's own under the temporary one where home is not writable."""
    wanted = Path(os.environ.get("BOATSIM_CACHE") or Path(os.environ.get("XDG_CACHE_HOME", "~/.cache")) / "boatsim")
    for folder in (wanted.expanduser(), Path(tempfile.gettempdir()) / f"boatsim-{os.getuid()}"):
        try:
            folder.mkdir(parents=True, exist_ok=True)
            if os.access(folder, os.W_OK):
                return folder
        except OSError:
            continue
    raise BadInput(f"{wanted}: no folder to keep compiled programs in; set BOATSIM_CACHE to one that can be written")


def _prune(folder: Path) -> None:
    """Remove programs that nobody has used for long, with numba's files of them.

    Safe beside other processes: one that has loaded a program needs its files no more, one that finds them gone writes
    them anew.
    """
    for old in folder.glob("program_*.py"):
        with suppress(OSError):  # another process may be as quick
            if time.time() - old.stat().st_mtime > KEPT:
                for file in (*folder.glob(f"__pycache__/{old.stem}.*"), old):
                    file.unlink(missing_ok=True)


def _stamp(program: Program, source: str) -> str:
    """Name of a composition: its source, the source of every law in it, and what compiles it."""
    files = {getsourcefile(type(e)) for e in program.effects}
    files |= {str(p) for p in [*(Path(__file__).parent / "effects").glob("*.py"), Path(__file__).parent / "base.py"]}
    digest = hashlib.sha256(source.encode())
    for name in sorted(f for f in files if f):
        digest.update(Path(name).read_bytes())
    digest.update(f"{numba.__version__} {sys.version}".encode())
    return digest.hexdigest()[:16]


def _kernel(name: str) -> str:
    """Source of a kernel without its imports of other kernels, whose text stands above it."""
    text = (KERNELS / f"{name}.py").read_text()
    return re.sub(r"^from boatsim\.physics\.kernel\S* import (\([^)]*\)|.*)\n", "", text, flags=re.MULTILINE)


def _source(program: Program) -> str:
    """The whole program as Python source."""
    kernel = FREE_IN.get(frozenset(program.vessel.freedoms))
    if kernel is None:
        found = ", ".join(program.vessel.freedoms)
        allowed = "surge, sway, yaw, with or without roll, or roll alone"
        raise BadInput(f"{program.vessel.name}: freedoms = {found}; allowed are {allowed}")
    kernels = [_kernel(name) for name in (kernel, "common", "filter", "callback")]
    return "\n\n".join([_kernel("compiling"), _composition(program), *kernels])


def _call(i: int, effect: Effect, offset: int) -> str:
    """`V3(p[7], p[8])`: an effect's parameters as its law receives them."""
    return f"V{i}({', '.join(f'p[{offset + j}]' for j in range(len(type(effect).params())))})"


def _guarded(program: Program, i: int, lines: list[str]) -> list[str]:
    """Indented lines, behind the switch of an effect that is optional."""
    if i < len(program.vessel.effects):
        return [f"    {line}" for line in lines]
    return [f"    if on[{i}] != 0.0:", *(f"        {line}" for line in lines)]


def _composition(program: Program) -> str:
    """The vessel's own `sees, wrench, flow, inertias, actuate`."""
    actuators = program.vessel.actuators
    angles = angle_fields(actuators)
    held = [f"act[{i}]" for i in range(len(actuators) + len(angles))]
    aliases = [f"act[{actuators.index(own)}]" for own in alias_fields(actuators).values()]
    seen = [*held, *map(repr, fixed_fields(actuators).values()), *aliases]
    head = [
        '"""Effects of a vessel, composed by boatsim.program; not meant to be edited."""',
        "from math import cos, sin",
        "import numpy as np",
        "from boatsim.physics.base import Shown, Swell, Wrench, motion_type",
        "from boatsim.physics.program import classes_of",
        f"E = classes_of({[address(type(e)) for e in program.effects]!r})",
        f"Seen = motion_type({actuators!r})",
        f"HELD, MEMORY = {max(len(held), 1)}, {program.memory_size}",
        f"PAUSES = {any(isinstance(e, Channel) and type(e).pause is not None for e in program.effects)}",
        f"SWELLS = {any(isinstance(e, Unsteady) for e in program.effects)}",
    ]
    wrench = ["    X = Y = K = N = 0.0"]
    flow = ["    north = east = 0.0"]
    inertias = ["    pass"]
    shown, late, swell = ["    pass"], ["    seconds = 0.0"], ["    w = Swell(0.0, 0.0, 0.0, 0.0, 0.0, 1.0)"]
    for i, (effect, offset) in enumerate(zip(program.effects, program.offsets, strict=True)):
        head.append(f"V{i} = E[{i}].values_type()")
        if isinstance(effect, Force):
            head.append(f"law{i} = E[{i}].law")
            lines = [f"w = law{i}(m, {_call(i, effect, offset)})", "X += w.X; Y += w.Y; K += w.K; N += w.N"]
            wrench += _guarded(program, i, lines)
        if isinstance(effect, Reaction):
            head.append(f"reaction{i} = E[{i}].reaction")
            lines = [f"w = reaction{i}(m, Wrench(X, Y, K, N), {_call(i, effect, offset)})"]
            wrench += _guarded(program, i, [*lines, "X += w.X; Y += w.Y; K += w.K; N += w.N"])
        if isinstance(effect, Flow):
            head.append(f"flow{i} = E[{i}].flow")
            flow += _guarded(program, i, [f"a, b = flow{i}({_call(i, effect, offset)})", "north += a; east += b"])
        if isinstance(effect, Inertia):
            head.append(f"inertia{i} = E[{i}].inertia")
            into = type(effect).moves_with
            lines = [f"g = inertia{i}({_call(i, effect, offset)})", f"for j in range(7): {into}[j] += g[j]"]
            inertias += _guarded(program, i, lines)
        if isinstance(effect, Measurement) and type(effect).shown is not None:
            head.append(f"shown{i} = E[{i}].shown")
            shown += _guarded(program, i, [f"m = shown{i}(m, {_call(i, effect, offset)})"])
        if isinstance(effect, Measurement) and type(effect).late is not None:
            head.append(f"late{i} = E[{i}].late")
            late += _guarded(program, i, [f"seconds += late{i}({_call(i, effect, offset)})"])
        if isinstance(effect, Unsteady):
            head.append(f"swell{i} = E[{i}].swell")
            swell += _guarded(program, i, [f"w = swell{i}({_call(i, effect, offset)})"])
        if isinstance(effect, Channel):
            head.append(f"channel{i} = E[{i}].channel")
            if type(effect).pause is not None:
                head.append(f"pause{i} = E[{i}].pause")
    return "\n".join(
        [
            *head,
            "",
            "@inlined",
            "def sees(t, x, y, psi, phi, u, v, p, r, ur, vr, c, s, act):",
            f"    return Seen({', '.join(['t, x, y, psi, phi, u, v, p, r, ur, vr, c, s', *seen])})",
            "",
            "@merged",
            "def wrench(m, p, on):",
            *wrench,
            "    return Wrench(X, Y, K, N)",
            "",
            "@inlined",
            "def flow(p, on):",
            *flow,
            "    return north, east",
            "",
            "@inlined",
            "def inertias(p, on, water, hull):",
            *inertias,
            "",
            "@inlined",
            "def actuate(commands, memory, dt, p, on, act):",
            *_actuate(program),
            "",
            "@inlined",
            "def pause(commands, memory, p, on):",
            *_pause(program),
            "",
            "@inlined",
            "def shown(m, p, on):",
            *shown,
            "    return m",
            "",
            "@inlined",
            "def distorted(on):",
            f"    return {_distorted(program)}",
            "",
            "@inlined",
            "def late(p, on):",
            *late,
            "    return seconds",
            "",
            "@inlined",
            "def swell(p, on):",
            *swell,
            "    return w",
        ]
    )


def _actuate(program: Program) -> list[str]:
    """Body of `actuate`: every actuator through its channels in the vessel's order, then cosines and sines."""
    lines, at = ["    pass"], 0
    order = list(program.vessel.commands)
    for k, name in enumerate(program.vessel.actuators):
        command = program.vessel.commands[name]
        lines.append(f"    x = commands[{order.index(name)}]")
        for i, effect in enumerate(program.effects):
            if not isinstance(effect, Channel) or name not in program.targets(effect):
                continue
            kind = type(effect)
            other = program.vessel.beside(name, kind.source_family) if kind.source_family else None
            source = f"commands[{order.index(other)}]" if other else "0.0"
            given = f"x, {float(command.side)}, {source}, memory, np.int64({at}), dt"  # plain integers count as types
            lines += _guarded(program, i, [f"x = channel{i}({given}, {_call(i, effect, program.offsets[i])})"])
            at += kind.slots
        lines.append(f"    act[{k}] = x")
    for k, name in enumerate(angle_fields(program.vessel.actuators)):
        part, angle = name.split("_", 1)
        at = program.vessel.actuators.index(angle)
        lines.append(f"    act[{len(program.vessel.actuators) + k}] = {part}(act[{at}])")
    return lines


def _pause(program: Program) -> list[str]:
    """Body of `pause`: the shortest time until a channel's signal jumps while its command is held."""
    lines, at, order = ["    left = np.inf"], 0, list(program.vessel.commands)
    for name in program.vessel.actuators:
        for i, effect in enumerate(program.effects):
            if not isinstance(effect, Channel) or name not in program.targets(effect):
                continue
            if type(effect).pause is not None:
                given = f"commands[{order.index(name)}], memory, np.int64({at}), {_call(i, effect, program.offsets[i])}"
                lines += _guarded(program, i, [f"left = min(left, pause{i}({given}))"])
            at += type(effect).slots
    return [*lines, "    return left"]


def _distorted(program: Program) -> str:
    """Condition under which an effect changes what the recording shows."""
    own = len(program.vessel.effects)
    acting = [i for i, e in enumerate(program.effects) if isinstance(e, Measurement) and type(e).shown is not None]
    return "True" if any(i < own for i in acting) else " or ".join(f"on[{i}] != 0.0" for i in acting) or "False"


def classes_of(addresses: Sequence[str]) -> list[type[Effect]]:
    """Effect classes of a composed program, for the program's own use."""
    from boatsim.physics.content import load_class

    return [load_class("effect", a) for a in addresses]
