"""What cannot be: refused by the scene (exit code 2) or failed with the reason (exit code 3)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from tests.hard.case import Case

OSCILLATING = ("load.force={mean='0.5 kN/m', amplitude='1.5 kN/m', frequency='1 Hz', "
               "shape='sine'}")
REFUSED = (
    ("Poisson ratio of 0.5", "solid={law='neo-hookean', young_modulus='1 MPa', poisson_ratio=0.5}",
     "solid.poisson_ratio"),
    ("no permeability", "pores.permeability=0 m^2", "pores.permeability"),
    ("no viscosity", "film.viscosity=0 Pa*s", "film.viscosity"),
    ("no load", "load.force=0 N/m", "load.force"),
    ("negative friction", "contact.friction=-0.1", "contact.friction"),
    ("a layer thicker than its radius", "geometry.thickness=100 mm", "geometry.thickness"),
    ("a step longer than the run", "time={end='1 ms', first_step='10 ms'}", "time.first_step"),
)


def ending_cases() -> list[Case]:
    return [*refused(), *failing()]


def refused() -> Iterator[Case]:
    for name, override, key in REFUSED:
        yield Case("refused", name, "The scene is refused in a sentence that names the key.",
                   "case1", (override,), refused=key)
    begin = Case("refused", "pulled in the steady state",
                 "The scene is refused, as no steady state carries a pull.", "case2",
                 ("load.force={times=['0 s', '1 s'], values=['-1 N/m', '1 N/m']}",),
                 refused="a steady state needs a load above 0")
    yield begin
    yield replace(begin, name="a pull and no film", overrides=(OSCILLATING, "film=none"),
                  stable="The scene is refused, as nothing but a film can hold the plane.",
                  refused="it must stay above 0 (unless there is a [film]")


def failing() -> Iterator[Case]:
    yield Case("no steady state", "friction drags a layer that slides on its base",
               "Exit code 3: what friction does to such a layer is said, and what to try.",
               "case1", ("motion.speed=0.01 rad/s", "load.force=3 kN/m",
                         "contact.friction_traction=true"), (24, 3),
               fails="friction drags a layer that slides on its base", slow=True)
