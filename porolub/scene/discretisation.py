"""How the layer is cut into elements and which polynomials live on them."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from porolub.scene.base import Section, Whole, broken
from porolub.scene.units import PositiveLength

Count = Annotated[int, Field(ge=1), Whole]
Degree = Annotated[Literal[1, 2], Whole]


class Mesh(Section):
    """Element counts of a structured mesh and the degrees of displacement and pressure.

    ``along`` counts elements along the lubricated surface, ``across`` through the thickness,
    ``deep`` along the third axis. A count is 0 where it does not apply (mesh from a file; ``deep``
    in two dimensions). ``edge_size`` is the smallest element at a contact edge in m; None lets
    the program choose it.
    """

    along: Count = 0
    across: Count = 0
    deep: Count = 0
    degree: Degree = 2
    pressure_degree: Degree = 1
    grading: Literal["none", "contact"] = "none"
    edge_size: PositiveLength | None = None
    element: Literal["quad", "triangle"] = "quad"

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if self.pressure_degree > self.degree:
            raise broken(
                f"mesh.pressure_degree = {self.pressure_degree} must not be greater than "
                f"mesh.degree = {self.degree}."
            )
        if self.edge_size is not None and self.grading == "none":
            raise broken('mesh.edge_size is given, so mesh.grading must be "contact".')
        return self
