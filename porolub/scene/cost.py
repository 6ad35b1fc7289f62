"""What a scene costs: entries of the matrix, memory and time of a Newton step, by linear solver.

The entries are counted (see stencil), the factors of the direct solver likewise (see dissection).
The constants turn counts into bytes and seconds. They were fitted to runs of this program on one
core of the machine it was written on (3 GHz, AVX-512, one BLAS thread): Case 1 with 100 x 10,
300 x 30 and 600 x 30 elements and in triangles, joint3d.toml with 30 x 3 x 6 to 80 x 4 x 20
elements, and cubes of up to 14^3 elements, 10,000 to 200,000 unknowns. There the entries of the
matrix came out within 12 %, the factors within 11 %, memory within 14 % and time within 30 %.
On 2 to 8 ranks the fullest came within 40 %. Other machines and orderings, and many ranks, for
which it is extrapolated, make it a factor of 2.
"""

from dataclasses import dataclass

from porolub.scene.dissection import Factors, Fields, factors
from porolub.scene.geometry import MeshFile
from porolub.scene.scene import Scene
from porolub.scene.stencil import Parts, count_nonzeros, mesh_parts
from porolub.scene.unknowns import estimate_unknowns, node_counts

PROGRAM = 200e6  # bytes: Python, PETSc and the libraries, on every rank
MATRIX = 30.0  # bytes an entry: matrix, its pattern and the way of the values into it
ASSEMBLY = 25e-9  # s an entry: Jacobian and residual

# The direct solver: what MUMPS with its own ordering needs over the counted dissection, by
# dimension; bytes and seconds an entry of the matrix (its copy, assembly of the fronts) and an
# entry of the factors; operations a second in large fronts.
ENTRIES_OVER_COUNT = {2: 1.05, 3: 1.25}
OPERATIONS_OVER_COUNT = {2: 1.0, 3: 1.4}
DIRECT_BYTES = 15.0
DIRECT_SECONDS = {2: 90e-9, 3: 55e-9}
FACTOR_BYTES = 8.0
OPERATIONS_A_SECOND = 40e9
DIRECT_SPREAD = 1.4  # memory of the fullest rank over the mean, on more ranks than one

# The iterative solver, per entry of the matrix: bytes of the blocks and of their multigrid
# hierarchy, seconds of the set-up and of an iteration; iterations of a Newton step.
SPLIT_BYTES = 16.0
SPLIT_SECONDS = 80e-9
SPLIT_SECONDS_AN_ITERATION = 2.1e-9
SPLIT_ITERATIONS = 20
SPLIT_SPREAD = 1.5  # rows of the interface, and patterns that one rank's matrix shares

DIRECT_UP_TO = {2: 1_000_000, 3: 25_000}
"""Unknowns up to which solver.preset = "auto" factorises, by dimension."""


@dataclass(frozen=True)
class Solving:
    """With one linear solver: bytes and seconds of a Newton step on one rank."""

    memory: float
    seconds: float
    spread: float

    def memory_per_rank(self, ranks: int) -> float:
        """Return the bytes of the fullest of ``ranks`` ranks."""
        if ranks == 1:
            return self.memory
        return PROGRAM + (self.memory - PROGRAM) / ranks * self.spread


@dataclass(frozen=True)
class Cost:
    """``unknowns``, ``entries`` of the matrix, and what each linear solver makes of them."""

    unknowns: int
    entries: int
    direct: Solving
    fieldsplit: Solving


def expected_cost(scene: Scene) -> Cost:
    """Return what a scene costs, within a factor of 2.

    Raises SceneError if a mesh file cannot be read.
    """
    unknowns, entries = estimate_unknowns(scene)["total"], count_nonzeros(scene)
    lu = direct_factors(scene)
    base, assembly = PROGRAM + MATRIX * entries, ASSEMBLY * entries
    direct = Solving(
        base + DIRECT_BYTES * entries + FACTOR_BYTES * lu.entries,
        assembly + DIRECT_SECONDS[scene.dimension] * entries + lu.operations / OPERATIONS_A_SECOND,
        DIRECT_SPREAD,
    )
    iterating = SPLIT_SECONDS + SPLIT_ITERATIONS * SPLIT_SECONDS_AN_ITERATION
    split = Solving(base + SPLIT_BYTES * entries, assembly + iterating * entries, SPLIT_SPREAD)
    return Cost(unknowns, entries, direct, split)


def direct_factors(scene: Scene) -> Factors:
    """Return the entries of L and U and the operations to make them."""
    dim, mesh = scene.dimension, scene.mesh
    fields: Fields = ()
    if scene.solid is not None:
        velocity = scene.solid.inertia and scene.time is not None
        fields = ((dim * (2 if velocity else 1), mesh.degree),)
    if scene.pores is not None:
        fields += ((2 if scene.pores.carry else 1, mesh.pressure_degree),)
    bricks = _bricks(scene)
    if not fields:  # a film between rigid walls: its surface is all there is
        along = [n for n in bricks if n != min(bricks)] or list(bricks[:1])
        bricks, fields = tuple(along[: dim - 1]), ((1, mesh.pressure_degree),)
    count = factors(bricks, fields)
    return Factors(
        count.entries * ENTRIES_OVER_COUNT[dim], count.operations * OPERATIONS_OVER_COUNT[dim]
    )


def _bricks(scene: Scene) -> tuple[int, ...]:
    """Elements along each side of a brick like the layer."""
    mesh, dim = scene.mesh, scene.dimension
    if not isinstance(scene.geometry, MeshFile):
        return (mesh.along, mesh.across) if dim == 2 else (mesh.along, mesh.across, mesh.deep)
    elements = _as_bricks(mesh_parts(scene))
    _, surface = node_counts(scene)
    facing = max(1, surface(1))  # about as many vertices as elements
    across = max(1, round(elements / facing)) if surface(1) else round(elements ** (1 / dim))
    side = max(1, round((elements / across) ** (1 / (dim - 1))))
    return (across, *(side,) * (dim - 1))


def _as_bricks(parts: Parts) -> float:
    """Quadrilaterals or hexahedra with as many vertices as the elements of a mesh."""
    share = {"quad": 1.0, "triangle": 1 / 2, "hexahedron": 1.0, "tetra": 1 / 6}
    kinds = ("quad", "triangle") if parts.dimension == 2 else ("hexahedron", "tetra")
    return sum(parts.numbers.get(kind, 0) * share[kind] for kind in kinds)


def preset_used(asked: str, dimension: int, unknowns: int) -> str:
    """Return the solver preset that ``asked`` stands for in a scene of this size."""
    if asked != "auto":
        return asked
    return "direct" if unknowns <= DIRECT_UP_TO[dimension] else "fieldsplit"
