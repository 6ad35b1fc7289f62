"""A made-up state of a transient run to go on from."""

import numpy as np

from porolub.solve.report import Resume, StateData


def made_up(nodes: int, states: int, number: int = 0) -> Resume:
    """Fields u, p on every second node and the scalar v0; the same for the same ``number``."""
    rng = np.random.default_rng(number)
    places = rng.normal(size=(nodes, 2))
    every, second = np.arange(nodes), np.arange(0, nodes, 2)
    units = {"u": "m", "p": "Pa", "v0": "m"}
    known = tuple(
        StateData(
            time=1.0 - 0.01 * k / 3,
            fields={
                "u": (every, rng.normal(size=(nodes, 2))),
                "p": (second, rng.normal(size=(len(second), 1))),
                "v0": (np.zeros(0, dtype=np.int64), rng.normal(size=(1, 1))),
            },
            units=units,
            mesh_nodes=places,
        )
        for k in range(states)
    )
    return Resume(
        states=known,
        orders=tuple(min(states - k, 2) for k in range(states)),
        step=1 / 300,
        frame=17 + number,
        edges=(-4e-3 / 3, 4.1e-3),
        totals={"time_steps": 212.0, "wall_time": 71.3, "gained 0": 1e-300},
    )
