"""Hard cases of the mesh: needles, leaning elements, triangles, steep gradings."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from tests.hard.case import MESH, Case
from tests.hard.judge import Steady, difference_of_states, steady_of
from tests.hard.meshes import lean_of, skewed_sector
from tests.hard.rows_steady import BASES

BONDED = ("solid.base=bonded", "contact.friction_traction=true", "conventions.entering=fresh")


def mesh_cases() -> list[Case]:
    return [*needles(), *gradings(), *skewed(), *triangles()]


def needles() -> Iterator[Case]:
    for base, job in BASES.items():
        yield Case("elements", f"0.7 mm x 7 um, {base}",
                   "Flat needles, 1:100: the answer of the same mesh with stout elements.",
                   job, (), (24, 138), refined=("mesh.across=6",), within=0.02,
                   slow=True)


def gradings() -> Iterator[Case]:
    """Upright needles, 167 um high, at the edges of the contact."""
    for base, job, along in (("sliding", BASES["sliding"], 240), ("bonded", BASES["bonded"], 120)):
        yield Case("elements", f"graded on {along}, {base}",
                   "A steady state, within 2 % of edges of 10 um on twice the elements across.",
                   job, ("mesh.grading=contact", "mesh.edge_size=1 um"), (along, 6),
                   refined=("mesh.edge_size=10 um", "mesh.along=240", "mesh.across=12"),
                   within=0.02, slow=True)
    yield Case("elements", "graded on 240, bonded",
               "Exit code 3: at 1 um the nodes at the edge of the contact open and close in turn.",
               BASES["bonded"], ("mesh.grading=contact", "mesh.edge_size=1 um"), (240, 6),
               fails="the contact pressure still changes", slow=True)


def skewed() -> Iterator[Case]:
    for degrees in (15, 30, 45, -30):
        for base, overrides in (("sliding", ()), ("bonded", BONDED)):
            def build(directory: Path, degrees: int = degrees) -> Sequence[str]:
                path = skewed_sector(directory / "skewed.msh", *MESH, degrees)
                assert abs(lean_of(path) - abs(degrees)) < 1.0
                return [f"geometry.path={path}"]

            yield Case("elements", f"leaning by {degrees} degrees, {base}",
                       "Loads and approach within 2 % of the upright elements of the same size.",
                       "case1_file", overrides, None, files=build, also=as_upright(base),
                       slow=degrees != 30 or base == "sliding")


def as_upright(base: str) -> Callable[[Steady], str]:
    def check(found: Steady) -> str:
        upright = steady_of(Case("", "", "", BASES[base]).scene(Path()))
        name, worst = max(difference_of_states(found, upright).items(), key=lambda item: item[1])
        assert worst < 0.02, f"{worst:.1%} {name} from upright elements"
        return f"{worst:.1%} {name} from upright"

    return check


def triangles() -> Iterator[Case]:
    for base, job in BASES.items():
        yield Case("elements", f"triangles, {base}",
                   "Loads, friction and approach within 3 % of quads.", job,
                   ("mesh.element=triangle",), refined=("mesh.element=quad",), within=0.03,
                   slow=True)
