"""Finite elements: reference elements, quadrature, integration domains, dofs, assembly."""
