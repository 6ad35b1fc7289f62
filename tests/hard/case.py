"""What a hard case is: a scene, what stable means for it, and the bounds its checks go by."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from porolub.scene import Scene, load_scene

JOBS = Path(__file__).resolve().parents[2] / "jobs"
MESH = (60, 6)

CRITERIA = ("end", "J", "load", "fluid", "contact", "p along", "p across", "reference", "own",
            "restart", "time")
"""end: converged, or the failure or refusal that is asked for; J: lowest volume ratio, over all
steps; load, fluid: relative errors of the balances; contact: largest violation of p_c >= 0,
gap >= 0, p_c gap = 0; p along, p across: node-to-node oscillation of the pressure along the surface
and through the thickness, of the largest pressure; reference: largest difference from the refined
scene; own: what the statement says beside; restart: the same
steps when stopped in the middle; time: what it took (never a failure)."""


@dataclass(frozen=True)
class Bounds:
    """What the checks allow, all relative but ``lowest``.

    steady: largest change by one more iteration, in thicknesses and layer moduli.
    oscillation, across: of the pressure, see stable.sawtooth. Along the surface film and carry
    term are stabilised where elements are too long for them, and nothing goes up and down from
    node to node: 1e-3 is far below what a plot shows. Through the thickness it is plain Galerkin:
    fluid drains from a layer sqrt(c t) below the surface, t the time in the contact, which six
    elements across do not resolve from 1 rad/s on (0.6 % of ripple there, 3 % at 20 rad/s; on
    meshes twice and four times as fine nothing and 0.4 %).
    restart: what contacts and loads may differ by after a restart, of their largest values.
    """

    steady: float = 1e-8
    load: float = 1e-8
    fluid: float = 1e-8
    contact: float = 1e-6
    oscillation: float = 1e-3
    across: float = 0.05
    restart: float = 1e-7
    lowest: float = 0.0  # J


@dataclass(frozen=True)
class Case:
    """A scene made hard.

    job: shipped scene it is built on; overrides: in the language of --set; mesh: elements along and
    across, None for those of a file. stable: one sentence. fails, refused: part of the sentence
    with which the run must end, exit code 3 or 2; empty where it must converge. refined: overrides
    of the scene it is compared with, and within: largest difference; also: checks what is
    particular and returns a few words for the matrix. restart: the run is also stopped at the first
    of these times and restarted to the second, s. slow, slow_reference: left out of the fast suite.
    files: makes a file the scene needs (directory -> overrides).
    """

    group: str
    name: str
    stable: str
    job: str
    overrides: tuple[str, ...] = ()
    mesh: tuple[int, int] | None = MESH
    bounds: Bounds = Bounds()
    fails: str = ""
    refused: str = ""
    refined: tuple[str, ...] = ()
    within: float = 0.0
    also: Callable[[Any], str] | None = None
    restart: tuple[float, float] | None = None
    slow: bool = False
    slow_reference: bool = True
    files: Callable[[Path], Sequence[str]] | None = None
    petsc: str = ""

    @property
    def id(self) -> str:
        return f"{self.group}: {self.name}"

    def scene(self, directory: Path, *more: str) -> Scene:
        """Raises SceneError where the scene is refused."""
        counts = [] if self.mesh is None else [f"mesh.along={self.mesh[0]}",
                                               f"mesh.across={self.mesh[1]}"]
        made = self.files(directory) if self.files else ()
        return load_scene(JOBS / f"{self.job}.toml", [*counts, *self.overrides, *made, *more])


@dataclass(frozen=True)
class Verdict:
    """ok, and the value or the reason in a few words."""

    ok: bool
    text: str


Verdicts = dict[str, Verdict]
