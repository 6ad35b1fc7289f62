"""From terms to a solution: system, constraints, Newton, continuation, outcome."""
