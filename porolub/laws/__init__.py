"""Pointwise physics: arrays in, arrays out, every value with its exact derivative.

Tensor arrays are (..., dim, dim); the leading axes are entities and quadrature points.
"""
