"""All hard cases, in the order of the matrix."""

from tests.hard.case import Case
from tests.hard.rows_ends import ending_cases
from tests.hard.rows_meshes import mesh_cases
from tests.hard.rows_steady import steady_cases
from tests.hard.rows_transient import transient_cases


def all_cases() -> list[Case]:
    return [*steady_cases(), *mesh_cases(), *transient_cases(),
            *ending_cases()]
