"""Named presets of the linear solver: PETSc options, each with its reason.

``direct``      MUMPS on the whole matrix.
``fieldsplit``  flexible GMRES; contact, approach and what is projected eliminated exactly (see
                solve/condensed.py), then a Schur complement over displacement | pressure, the film
                being the pressure's trace on the surface.
``nested``      the same with the pressure split once more: layer | film.  Three blocks, so that
                the layer's may be given to multigrid where its factors are too large:
                -fieldsplit_p_fieldsplit_layer_pc_type hypre (in time; a steady state at a high
                Peclet number then takes hundreds of iterations).
``auto``        direct or fieldsplit, whichever is cheaper for this dimension and size.

Options by their usual PETSc names; what the user gives goes before.  With any other -pc_type the
matrix goes to PETSc as it is.
"""

from __future__ import annotations

DIRECT: dict[str, str] = {
    "ksp_type": "preonly",  # the factorisation is exact
    "pc_type": "lu",
    "pc_factor_mat_solver_type": "mumps",  # parallel, and pivots the zero blocks of contact
    "mat_mumps_icntl_14": "80",  # % of extra workspace: pivoting needs more than the estimate
}
"""The fastest in 2D, where its memory grows as n log n."""

_OUTER: dict[str, str] = {
    "ksp_type": "fgmres",  # flexible: the mass matrices inside are solved by iteration
    "ksp_rtol": "1e-5",  # Newton needs no more iterations than with 1e-8; 1e-3 costs some
    "ksp_max_it": "300",  # a failure: the preconditioner needs 10 to 60
    "ksp_gmres_restart": "100",  # beyond what is needed: a restart forgets the film's few modes
    "ksp_gmres_cgs_refinement_type": "refine_ifneeded",  # else it stalls at 1e-6: far from normal
    "pc_type": "fieldsplit",
    "pc_fieldsplit_type": "schur",
    "pc_fieldsplit_schur_fact_type": "upper",  # a lower factor saves no iteration worth its cost
    "pc_fieldsplit_schur_precondition": "user",  # fixed stress and Winkler, terms/fixed_stress.py
}

_DISPLACEMENT: dict[str, str] = {
    "fieldsplit_u_ksp_type": "preonly",
    "fieldsplit_u_pc_type": "mg",  # quadratic, then linear elements: see solve/vertices.py
    "fieldsplit_u_mg_levels_ksp_type": "chebyshev",
    "fieldsplit_u_mg_levels_ksp_max_it": "3",  # what 2 save in work they lose in iterations
    "fieldsplit_u_mg_levels_pc_type": "jacobi",  # sor needs as many iterations, at twice the cost
    "fieldsplit_u_mg_coarse_ksp_type": "gmres",  # linear elements cost a tenth: solve them well
    "fieldsplit_u_mg_coarse_ksp_max_it": "3",
    "fieldsplit_u_mg_coarse_ksp_norm_type": "none",  # always three, no test of convergence
    "fieldsplit_u_mg_coarse_pc_type": "gamg",  # keeps the rigid motions: half of hypre's iterations
    "fieldsplit_u_mg_coarse_mg_levels_ksp_max_it": "2",
}

_MASSES: dict[str, str] = {
    "fieldsplit_j_ksp_type": "cg",  # projected volume change: a mass matrix, a few iterations
    "fieldsplit_j_ksp_rtol": "1e-3",
    "fieldsplit_j_pc_type": "jacobi",
    "fieldsplit_w_ksp_type": "cg",  # velocity: likewise
    "fieldsplit_w_ksp_rtol": "1e-3",
    "fieldsplit_w_pc_type": "jacobi",
}

FIELDSPLIT: dict[str, str] = _OUTER | _DISPLACEMENT | _MASSES | {
    "fieldsplit_p_ksp_type": "preonly",
    "fieldsplit_p_pc_type": "lu",  # some 4 % of the unknowns; ten decades of film conductance
    "fieldsplit_p_pc_factor_mat_solver_type": "mumps",
}

NESTED: dict[str, str] = _OUTER | _DISPLACEMENT | _MASSES | {
    "fieldsplit_p_ksp_type": "preonly",
    "fieldsplit_p_pc_type": "fieldsplit",
    "fieldsplit_p_pc_fieldsplit_type": "symmetric_multiplicative",
    "fieldsplit_p_fieldsplit_layer_ksp_type": "preonly",
    "fieldsplit_p_fieldsplit_layer_pc_type": "lu",  # hypre, too, where storage outweighs transport
    "fieldsplit_p_fieldsplit_layer_pc_factor_mat_solver_type": "mumps",
    "fieldsplit_p_fieldsplit_film_ksp_type": "preonly",
    "fieldsplit_p_fieldsplit_film_pc_type": "lu",  # a surface: cheap, and the hard coefficients
    "fieldsplit_p_fieldsplit_film_pc_factor_mat_solver_type": "mumps",
}

PRESETS = {"direct": DIRECT, "fieldsplit": FIELDSPLIT, "nested": NESTED}
