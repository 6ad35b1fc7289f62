/* Batched finite-element contractions: quadrature-point arrays in, dof arrays out.
 *
 * Physics stays in Python (pointwise laws on arrays); what is here is the same for every
 * term, dimension and degree.  Conventions, all arrays C-contiguous doubles:
 *   table   N  : (variants, nq, nn)       basis values
 *   table   dN : (variants, nq, dim, nn)  reference gradients
 *   variant    : (ne)                     which table rows an entity uses (its local face)
 *   invJ       : (ne, nq, dim, dim)       d(xi_r)/d(x_d)
 *   w          : (ne, nq)                 quadrature weight times measure
 *   dofs       : (ne, nn)                 local number of a node's first component, -1: absent
 * Element matrices are laid out (test component, test node, trial component, trial node). */
#include <Python.h>
#include <string.h>

#define MAXNN 27
#define MAXDIM 3

/* basis at one point: value (1 row) or physical gradient (dim rows), row-major (row, node) */
static int basis(int grad, int dim, int nn, const double *tab, const double *iJ, double *B)
{
    if (!grad) {
        memcpy(B, tab, sizeof(double) * nn);
        return 1;
    }
    for (int d = 0; d < dim; d++) {
        double *row = B + d * nn;
        for (int i = 0; i < nn; i++) row[i] = 0.0;
        for (int r = 0; r < dim; r++) {
            const double s = iJ[r * dim + d];
            const double *t = tab + r * nn;
            for (int i = 0; i < nn; i++) row[i] += s * t[i];
        }
    }
    return dim;
}

/* out (ne, nq, nc[, dim]) = the field or its gradient at the points */
void pl_evaluate(int ne, int nq, int dim, int nn, int nc, int grad, const double *table,
                 const int *variant, const double *invJ, const int *dofs, const double *x,
                 double *out)
{
    const int rows_tab = grad ? dim : 1;
    double B[MAXDIM * MAXNN], xe[MAXDIM * MAXNN];
    for (int e = 0; e < ne; e++) {
        for (int i = 0; i < nn; i++) {
            const int k = dofs[(size_t)e * nn + i];
            for (int c = 0; c < nc; c++) xe[c * nn + i] = k < 0 ? 0.0 : x[k + c];
        }
        const double *tab = table + (size_t)variant[e] * nq * rows_tab * nn;
        for (int q = 0; q < nq; q++) {
            const size_t eq = (size_t)e * nq + q;
            const int rows = basis(grad, dim, nn, tab + (size_t)q * rows_tab * nn,
                                   invJ + eq * dim * dim, B);
            double *o = out + eq * nc * rows;
            for (int c = 0; c < nc; c++)
                for (int a = 0; a < rows; a++) {
                    double s = 0.0;
                    for (int i = 0; i < nn; i++) s += B[a * nn + i] * xe[c * nn + i];
                    o[c * rows + a] = s;
                }
        }
    }
}

/* r[dof] += sum_q w f . (test value or gradient);  f (ne, nq, nc[, dim]) */
void pl_residual(int ne, int nq, int dim, int nn, int nc, int grad, const double *table,
                 const int *variant, const double *invJ, const double *w, const double *f,
                 const int *dofs, double *r)
{
    const int rows_tab = grad ? dim : 1;
    double B[MAXDIM * MAXNN], re[MAXDIM * MAXNN];
    for (int e = 0; e < ne; e++) {
        for (int k = 0; k < nc * nn; k++) re[k] = 0.0;
        const double *tab = table + (size_t)variant[e] * nq * rows_tab * nn;
        for (int q = 0; q < nq; q++) {
            const size_t eq = (size_t)e * nq + q;
            const int rows = basis(grad, dim, nn, tab + (size_t)q * rows_tab * nn,
                                   invJ + eq * dim * dim, B);
            const double *fq = f + eq * nc * rows;
            for (int c = 0; c < nc; c++)
                for (int a = 0; a < rows; a++) {
                    const double s = w[eq] * fq[c * rows + a];
                    for (int i = 0; i < nn; i++) re[c * nn + i] += s * B[a * nn + i];
                }
        }
        for (int i = 0; i < nn; i++) {
            const int k = dofs[(size_t)e * nn + i];
            if (k < 0) continue;
            for (int c = 0; c < nc; c++) r[k + c] += re[c * nn + i];
        }
    }
}

/* K (ne, ci, ni, cj, nj) += sum_q w test g trial;  g (ne, nq, ci[, dim], cj[, dim]) */
void pl_matrix(int ne, int nq, int dim, int ni, int ci, int gi, const double *tabi, int nj,
               int cj, int gj, const double *tabj, const int *variant, const double *invJ,
               const double *w, const double *g, double *K)
{
    const int ti = gi ? dim : 1, tj = gj ? dim : 1;
    double Bi[MAXDIM * MAXNN], Bj[MAXDIM * MAXNN], t[MAXDIM * MAXNN];
    for (int e = 0; e < ne; e++) {
        double *Ke = K + (size_t)e * ci * ni * cj * nj;
        const double *ta = tabi + (size_t)variant[e] * nq * ti * ni;
        const double *tb = tabj + (size_t)variant[e] * nq * tj * nj;
        for (int q = 0; q < nq; q++) {
            const size_t eq = (size_t)e * nq + q;
            const double *iJ = invJ + eq * dim * dim;
            basis(gi, dim, ni, ta + (size_t)q * ti * ni, iJ, Bi);
            basis(gj, dim, nj, tb + (size_t)q * tj * nj, iJ, Bj);
            const double *gq = g + eq * ci * ti * cj * tj;
            const double ww = w[eq];
            for (int c = 0; c < ci; c++)
                for (int a = 0; a < ti; a++) {
                    for (int d = 0; d < cj; d++)
                        for (int j = 0; j < nj; j++) {
                            double s = 0.0;
                            for (int b = 0; b < tj; b++)
                                s += gq[((c * ti + a) * cj + d) * tj + b] * Bj[b * nj + j];
                            t[d * nj + j] = ww * s;
                        }
                    const int m = cj * nj;
                    for (int i = 0; i < ni; i++) {
                        const double s = Bi[a * ni + i];
                        if (s == 0.0) continue; /* off-face nodes of a facet's cell */
                        double *row = Ke + (size_t)(c * ni + i) * m;
                        for (int j = 0; j < m; j++) row[j] += s * t[j];
                    }
                }
        }
    }
}

static struct PyModuleDef module = {PyModuleDef_HEAD_INIT, "_kernels", NULL, -1, NULL};
PyMODINIT_FUNC PyInit__kernels(void) { return PyModule_Create(&module); }
