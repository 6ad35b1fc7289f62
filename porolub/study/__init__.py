"""Sweeps over MPI ranks, accuracy against time."""
