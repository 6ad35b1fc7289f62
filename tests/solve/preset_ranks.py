"""Run by test_preset_ranks.py: a scene with every effect by presets; prints a summary of each.

Arguments: job, presets joined by commas, overrides.
"""

import json
import sys

from mpi4py import MPI

from porolub.scene import load_scene
from porolub.solve.derived import scalars
from porolub.solve.options import set_options
from porolub.solve.steady import SteadySolver
from tests.solve.models import JOBS

job, presets, *overrides = sys.argv[1:]
for preset in presets.split(","):
    set_options("")
    scene = load_scene(JOBS / f"{job}.toml", [f"solver.preset={preset}", *overrides])
    outcome = SteadySolver(scene, MPI.COMM_WORLD).solve()
    found = scalars(outcome.model, outcome.x)
    found |= {"converged": outcome.converged, "newton": outcome.newton_iterations,
              "linear": outcome.linear_iterations}
    if MPI.COMM_WORLD.rank == 0:
        print("FOUND", preset, json.dumps(found), flush=True)
