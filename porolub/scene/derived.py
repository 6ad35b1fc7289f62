"""Numbers that follow from a scene and tell a tribologist what to expect of it.

For the paper's weighting of the strain energy (W = a W_iso + (1 - a) W_vol, a = Biot coefficient; a
linear law is not weighted, G_eff = G and K_eff = K):

    G_eff = a G,  K_eff = (1 - a) K,  M = K_eff + 4/3 G_eff    (stiffness in confined compression)
    c = M kappa / (a^2 eta)                                     (consolidation coefficient)

A body that carries its fluid at the surface speed U past the contact has the Peclet number
U d / c over the thickness d, and an outlet boundary layer of thickness c / U.
"""

from dataclasses import dataclass

from porolub.scene.directions import unit_vector
from porolub.scene.geometry import Arc, Block
from porolub.scene.scene import Scene


@dataclass(frozen=True)
class Derived:
    """Derived numbers in SI units; None where the scene does not define them.

    ``element_length`` is the mean one along the lubricated surface.
    """

    surface_speed: float | None = None
    element_length: float | None = None
    confined_modulus: float | None = None
    consolidation: float | None = None
    peclet: float | None = None
    outlet_layer: float | None = None


def derived(scene: Scene) -> Derived:
    """Return the derived numbers of a scene at t = 0."""
    shape = scene.geometry
    speed = surface_speed(scene)
    length = None
    if isinstance(shape, Arc | Block):
        length = shape.surface_length / scene.mesh.along
    if scene.solid is None or scene.pores is None:
        return Derived(speed, length)
    a = scene.pores.biot
    isochoric, volumetric = (1.0, 1.0) if scene.solid.law == "linear" else (a, 1 - a)
    bulk, shear = volumetric * scene.solid.bulk_modulus, isochoric * scene.solid.shear_modulus
    modulus = bulk + 4 / 3 * shear
    c = modulus * scene.pores.permeability / (a**2 * scene.pores.viscosity)
    if not (scene.pores.carry and speed and isinstance(shape, Arc)):
        return Derived(speed, length, modulus, c)
    return Derived(speed, length, modulus, c, speed * shape.thickness / c, c / speed)


def surface_speed(scene: Scene) -> float | None:
    """Return how fast the surfaces slide past each other at t = 0, m/s, without sign."""
    if scene.motion is None:
        return None
    speed = abs(scene.motion.at(0.0))
    if scene.motion.kind == "sliding":
        return speed
    shape, motion = scene.geometry, scene.motion
    if not isinstance(shape, Arc) or motion.centre is not None:
        return None
    about_own_axis = abs(unit_vector(motion.axis, 3)[2]) > 1.0 - 1e-9
    return speed * shape.outer_radius if about_own_axis else None
