"""How accurate a run is to be: the program chooses mesh and tolerance for it."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Self

from pydantic import Field, model_validator

from porolub.scene.base import Section, Whole, broken
from porolub.scene.geometry import MeshFile
from porolub.scene.units import NUMBER, Quantity

if TYPE_CHECKING:
    from porolub.scene.scene import Scene

Share = Annotated[float, Quantity(NUMBER, at_least=1e-4, at_most=0.5)]

TARGETS = {
    "friction": ("friction_coefficient",),
    "load": ("load_solid", "load_fluid"),
    "approach": ("approach",),
    "contact": ("contact_length",),
}
"""Keys of the section, and the numbers of a summary that they are about."""


class Accuracy(Section):
    """Relative errors that are allowed, such as "1 %": of the ``friction`` coefficient, of the
    ``load`` by the solid and by the fluid, of the ``approach`` and of the length of ``contact``.

    ``elements``: along the lubricated surface, at most.
    """

    friction: Share | None = None
    load: Share | None = None
    approach: Share | None = None
    contact: Share | None = None
    elements: Annotated[int, Field(ge=100), Whole] = 2400

    def wanted(self) -> dict[str, float]:
        """Return the relative error allowed for each number of a summary that has one."""
        return {
            number: share
            for key, numbers in TARGETS.items()
            if (share := getattr(self, key)) is not None
            for number in numbers
        }

    @model_validator(mode="after")
    def _asks_for_something(self) -> Self:
        if not self.wanted():
            raise broken(
                f'[accuracy] asks for nothing: give one of {", ".join(TARGETS)}, such as "1 %".'
            )
        return self


def accuracy_violations(scene: "Scene") -> Iterator[str]:
    """Yield one sentence per broken rule."""
    if scene.accuracy is None:
        return
    if isinstance(scene.geometry, MeshFile):
        yield '[accuracy] needs a built shape: geometry.shape = "file" brings its own elements.'
    if scene.film is None and scene.contact is None:
        yield "[accuracy] needs [contact] or [film]: its errors are those of a lubricated surface."
    if scene.time is not None and scene.time.start != "steady":
        yield (
            f'time.start = "{scene.time.start}" does not go with [accuracy], which chooses the '
            'mesh by the steady state at t = 0; allowed with it: "steady".'
        )
