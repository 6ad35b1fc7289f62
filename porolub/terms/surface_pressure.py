"""Fluid pressure on the lubricated surface: total traction - b p B N on the layer.

With the traction -p_c m of the contact this makes the total surface traction p_c + b p:
b = 1 ("balanced": the load that is counted, p_c + p, is the load that acts) or b = Biot
coefficient ("paper": the skeleton carries p_c alone, de Boer et al. 2020, Table 1).
B N = cof F N follows the deformed surface (spatial frame) or stays N (material frame).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from porolub.fem.dofs import Field
from porolub.fem.points import GRAD, VALUE, Integrand, Points
from porolub.terms.term import Part


@dataclass(frozen=True)
class SurfacePressure:
    share: float
    spatial: bool
    boundary: str
    name: str = "surface pressure"

    def fields(self) -> list[Field]:
        return []

    def reads(self) -> list[str]:
        return ["u", "p"]

    def parts(self) -> list[Part]:
        blocks = [("u", "p")] + ([("u", "u")] if self.spatial else [])
        return [Part(f"facets:{self.boundary}", self.traction, blocks)]

    def traction(self, at: Points, out: Integrand) -> None:
        b, p, d, N = self.share, at.value("p"), at.deformation, at.normal
        BN = np.einsum("...ij,...j->...i", d.cof, N) if self.spatial else N
        out.residual("u", VALUE, b * p[..., None] * BN)
        if out.wants_jacobian:
            out.jacobian("u", VALUE, "p", VALUE, b * BN)
            if self.spatial and d.finite:
                dBN = np.einsum("...ijkl,...j->...ikl", d.dcof, N)
                out.jacobian("u", VALUE, "u", GRAD, b * p[..., None, None, None] * dBN)
