"""How the linear systems are solved; changes no result, only time and memory."""

from typing import Literal

from porolub.scene.base import Section


class Solver(Section):
    """``preset``: a named set of PETSc options.

    ``direct`` factorises the whole matrix (MUMPS); ``fieldsplit`` iterates on displacement and
    pressure (multigrid and a Schur complement); ``nested`` splits the pressure into layer and
    film, too; ``auto`` takes direct or fieldsplit, whichever is cheaper for the size.
    """

    preset: Literal["auto", "direct", "fieldsplit", "nested"] = "auto"
