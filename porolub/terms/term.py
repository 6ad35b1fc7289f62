"""What a term is.

A term declares the fields it adds and reads and, for each integration domain, the matrix blocks
it may fill and the function that adds its pointwise contributions.  Terms are summed; none knows
another, but for those that multiply others' fluxes (``compressibility``).  All numbers inside
terms are scaled (see ``porolub.solve.scales``).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

from porolub.fem.dofs import Field
from porolub.fem.points import Integrand, Points

Block = tuple[str, str]


@dataclass(frozen=True)
class Part:
    """A term's share on one domain (``cells``, ``facets:NAME``, ``nodes:NAME``)."""

    domain: str
    add: Callable[[Points, Integrand], None]
    blocks: list[Block] = field(default_factory=list)


class Term(Protocol):
    """An effect of the scene."""

    @property
    def name(self) -> str:
        """What it is called in errors and where terms are picked out."""

    def fields(self) -> list[Field]:
        """Unknowns this term adds."""

    def reads(self) -> list[str]:
        """Unknowns of other terms it cannot do without."""

    def parts(self) -> list[Part]:
        """Its integrals."""


@runtime_checkable
class Stores(Term, Protocol):
    """An effect that keeps something over time: its rows hold d/dt of the contents.

    What is stored is integrated, not its rate, so that any time scheme built on differences of
    contents conserves it exactly.  In a steady solve contents cost nothing.
    """

    def contents(self) -> list[Part]:
        """Integrals of what is stored, tested like the rows they belong to."""
