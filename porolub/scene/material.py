"""The layer and the fluid: skeleton, pores and lubricating film."""

import math
from typing import Annotated, Literal, Self

from pydantic import StrictBool, model_validator

from porolub.scene.base import Section, broken
from porolub.scene.units import (
    NUMBER,
    Compressibility,
    Density,
    Modulus,
    Permeability,
    PositiveLength,
    Quantity,
    Storage,
    Viscosity,
)

Biot = Annotated[float, Quantity(NUMBER, above=0, at_most=1)]
Porosity = Annotated[float, Quantity(NUMBER, above=0, at_most=1)]
PoissonRatio = Annotated[float, Quantity(NUMBER, above=-1, below=0.5)]

ROUNDING = 1e-12


class Solid(Section):
    """The drained skeleton: moduli in Pa, density in kg/m^3.

    Given by shear and bulk modulus, or by Young's modulus and Poisson's ratio, which are
    converted: ``shear_modulus`` and ``bulk_modulus`` always hold, the other two are then None.
    ``inertia`` adds density times acceleration to the momentum balance of a transient run.
    """

    law: Literal["linear", "neo-hookean"]
    shear_modulus: Modulus = math.nan
    bulk_modulus: Modulus = math.nan
    young_modulus: Modulus | None = None
    poisson_ratio: PoissonRatio | None = None
    base: Literal["sliding", "bonded"] = "sliding"
    density: Density | None = None
    inertia: StrictBool = False

    @model_validator(mode="after")
    def _one_pair_of_moduli(self) -> Self:
        pairs = ({"shear_modulus", "bulk_modulus"}, {"young_modulus", "poisson_ratio"})
        given = {k for pair in pairs for k in pair} & self.model_fields_set
        if given not in pairs:
            got = ", ".join(f"solid.{key}" for key in sorted(given)) or "none of them"
            raise broken(
                "solid.shear_modulus and solid.bulk_modulus are needed, or instead of them "
                f"solid.young_modulus and solid.poisson_ratio; given: {got}."
            )
        young, nu = self.young_modulus, self.poisson_ratio
        if young is not None and nu is not None:
            # the model is frozen; here it is still being built
            self.__dict__.update(
                shear_modulus=young / (2 * (1 + nu)),
                bulk_modulus=young / (3 * (1 - 2 * nu)),
                young_modulus=None,
                poisson_ratio=None,
            )
        return self


class Pores(Section):
    """The fluid in the pores: permeability in m^2, viscosity in Pa s, storage in 1/Pa.

    ``carry`` switches on the transport of pore volume with the rotating body, v . grad J;
    ``fluid_density`` (kg/m^3) turns volume flows into the mass flows that are reported.

    ``compressibility`` (1/Pa) lets the density follow the pressure, rho = rho_0 exp(chi p), in
    storage and in flow; None leaves it constant in both but for ``storage``. It needs the
    ``porosity`` of the undeformed layer, eps_0: the storage coefficient
    S = eps_0 chi + (1 - a)(a - eps_0)/K holds the fluid's own part already, so
    ``storage`` cannot be less than eps_0 chi.
    """

    biot: Biot
    permeability: Permeability
    viscosity: Viscosity
    storage: Storage = 0.0
    carry: StrictBool = False
    fluid_density: Density = 1000.0
    compressibility: Compressibility | None = None
    porosity: Porosity | None = None

    @model_validator(mode="after")
    def _compressible_fluid_fills_pores(self) -> Self:
        chi, porosity = self.compressibility, self.porosity
        if chi is None:
            return self
        if porosity is None:
            raise broken(
                "pores.compressibility needs pores.porosity, a number greater than 0 and at most 1."
            )
        own = porosity * chi
        if self.storage < own * (1 - ROUNDING):
            raise broken(
                f"pores.storage = {self.storage:g} 1/Pa must be at least pores.porosity * "
                f"pores.compressibility = {own:g} 1/Pa: it holds the fluid's own compression."
            )
        return self


class Film(Section):
    """The lubricating film: viscosity in Pa s, lengths in m.

    ``shear_film_min`` bounds the film thickness in the shear stress only (Eq. 19 of the paper);
    ``fluid_density`` is needed only without pores.
    """

    viscosity: Viscosity
    shear_film_min: PositiveLength = 1e-7
    squeeze: StrictBool = True
    fluid_density: Density | None = None
