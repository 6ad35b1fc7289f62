/* Batched finite-element contractions: quadrature-point arrays in, dof arrays out.
 *
 * Physics stays in the laws and terms (pointwise arrays); what is here is the same for every
 * term, dimension and degree.  All of it is one small dense product per entity, C = A^T T, with
 * rows padded to whole vectors.  Conventions, all arrays C-contiguous:
 *   table   N  : (variants, nq, nn)       basis values
 *   table   dN : (variants, nq, dim, nn)  reference gradients
 *   variant    : (ne)                     which table rows an entity uses (its local face)
 *   invJ       : (ne, nq, dim, dim)       d(xi_r)/d(x_d)
 *   w          : (ne, nq)                 quadrature weight times measure
 *   dofs       : (ne, nn)                 local number of a node's first component, -1: absent
 * Element matrices are (test node, test component, trial component, trial node), each test
 * node's row padded to pl_padded(ci * cj * nj) numbers. */
#include <Python.h>
#include <stdlib.h>
#include <string.h>

#ifdef __AVX512F__
#define W 8 /* doubles per vector */
#define MAXROWS 4
#define MAXPANEL 5
#else
#define W 4
#define MAXROWS 3
#define MAXPANEL 4
#endif
#define PAD(n) (((n) + W - 1) / W * W)
#define INLINE static inline __attribute__((always_inline))

typedef double vec __attribute__((vector_size(8 * W), aligned(8), may_alias));

int pl_padded(int n) { return PAD(n); }

/* C (rows, panel vectors) = or += A^T T over k; all loops unroll, the sums stay in registers */
INLINE void tile(int rows, int panel, int nk, const double *A, int lda, const double *T, int ldt,
                 double *C, int ldc, int add)
{
    vec sum[MAXROWS][MAXPANEL];
#pragma GCC unroll 8
    for (int i = 0; i < rows; i++)
#pragma GCC unroll 8
        for (int p = 0; p < panel; p++)
            sum[i][p] = add ? *(const vec *)(C + i * ldc + p * W) : (vec){0};
    for (int k = 0; k < nk; k++) {
#pragma GCC unroll 8
        for (int p = 0; p < panel; p++) {
            const vec t = *(const vec *)(T + k * ldt + p * W);
#pragma GCC unroll 8
            for (int i = 0; i < rows; i++) sum[i][p] += A[k * lda + i] * t;
        }
    }
#pragma GCC unroll 8
    for (int i = 0; i < rows; i++)
#pragma GCC unroll 8
        for (int p = 0; p < panel; p++) *(vec *)(C + i * ldc + p * W) = sum[i][p];
}

/* C (m, n) = or += A^T T with A (nk, m), T (nk, n); rows of T and C are padded */
static void product(int nk, int m, int n, const double *A, int lda, const double *T, int ldt,
                    double *C, int ldc, int add)
{
    const int nv = PAD(n) / W;
    const int panels = (nv + MAXPANEL - 1) / MAXPANEL, panel = (nv + panels - 1) / panels;
    const int blocks = (m + MAXROWS - 1) / MAXROWS, block = (m + blocks - 1) / blocks;
#define TILE(r, p) \
    case (r) * 8 + (p): \
        tile(r, p, nk, A + i, lda, T + v * W, ldt, C + (size_t)i * ldc + v * W, ldc, add); \
        break;
#define TILES(r) TILE(r, 1) TILE(r, 2) TILE(r, 3) TILE(r, 4)
    for (int v = 0; v < nv; v += panel)
        for (int i = 0; i < m; i += block) {
            const int p = nv - v < panel ? nv - v : panel, r = m - i < block ? m - i : block;
            switch (r * 8 + p) {
                TILES(1) TILES(2) TILES(3)
#if MAXROWS > 3
                TILES(4) TILE(1, 5) TILE(2, 5) TILE(3, 5) TILE(4, 5)
#endif
            }
        }
}

/* rows of nn numbers, copied into rows of PAD(nn) with zeros behind */
static double *padded(size_t rows, int nn, const double *table)
{
    double *out = calloc(rows * PAD(nn) + W, sizeof(double));
    for (size_t k = 0; k < rows; k++) memcpy(out + k * PAD(nn), table + k * nn, nn * sizeof(double));
    return out;
}

/* out (ne, nq, nc[, dim]) = the field or its gradient at the points */
void pl_evaluate(int ne, int nq, int dim, int variants, int nn, int nc, int grad,
                 const double *table, const int *variant, const double *invJ, const int *dofs,
                 const double *x, double *out)
{
    const int rows = grad ? dim : 1, n = nq * rows, ld = PAD(n);
    double *turned = calloc((size_t)variants * nn * ld, sizeof(double)); /* (variant, node, point) */
    double *at = malloc((nc * ld + nn * nc) * sizeof(double)), *xe = at + nc * ld;
    for (int v = 0; v < variants; v++)
        for (int k = 0; k < n; k++)
            for (int i = 0; i < nn; i++)
                turned[((size_t)v * nn + i) * ld + k] = table[((size_t)v * n + k) * nn + i];
    for (int e = 0; e < ne; e++) {
        for (int i = 0; i < nn; i++) {
            const int k = dofs[(size_t)e * nn + i];
            for (int c = 0; c < nc; c++) xe[i * nc + c] = k < 0 ? 0.0 : x[k + c];
        }
        product(nn, nc, n, xe, nc, turned + (size_t)variant[e] * nn * ld, ld, at, ld, 0);
        for (int q = 0; q < nq; q++) {
            const size_t eq = (size_t)e * nq + q;
            const double *iJ = invJ + eq * dim * dim;
            double *o = out + eq * nc * rows;
            for (int c = 0; c < nc; c++) {
                const double *h = at + c * ld + q * rows;
                if (!grad) o[c] = h[0];
                else if (dim == 2)
                    for (int d = 0; d < 2; d++) o[c * 2 + d] = h[0] * iJ[d] + h[1] * iJ[2 + d];
                else
                    for (int d = 0; d < 3; d++)
                        o[c * 3 + d] = h[0] * iJ[d] + h[1] * iJ[3 + d] + h[2] * iJ[6 + d];
            }
        }
    }
    free(turned);
    free(at);
}

/* r[dof] += sum_q w f . (test value or gradient);  f (ne, nq, nc[, dim]) */
void pl_residual(int ne, int nq, int dim, int variants, int nn, int nc, int grad,
                 const double *table, const int *variant, const double *invJ, const double *w,
                 const double *f, const int *dofs, double *r)
{
    const int rows = grad ? dim : 1, nk = nq * rows, ld = PAD(nn);
    double *tab = padded((size_t)variants * nk, nn, table);
    double *fref = malloc((nk * nc + nc * ld) * sizeof(double)), *re = fref + nk * nc;
    for (int e = 0; e < ne; e++) {
        for (int q = 0; q < nq; q++) {
            const size_t eq = (size_t)e * nq + q;
            const double *fq = f + eq * nc * rows, *iJ = invJ + eq * dim * dim;
            double *o = fref + q * rows * nc;
            for (int c = 0; c < nc; c++) {
                if (!grad) o[c] = w[eq] * fq[c];
                else
                    for (int k = 0; k < dim; k++) {
                        double s = 0.0;
                        for (int d = 0; d < dim; d++) s += iJ[k * dim + d] * fq[c * dim + d];
                        o[k * nc + c] = w[eq] * s;
                    }
            }
        }
        product(nk, nc, nn, fref, nc, tab + (size_t)variant[e] * nk * ld, ld, re, ld, 0);
        for (int i = 0; i < nn; i++) {
            const int k = dofs[(size_t)e * nn + i];
            if (k < 0) continue;
            for (int c = 0; c < nc; c++) r[k + c] += re[c * ld + i];
        }
    }
    free(tab);
    free(fref);
}

/* physical basis rows at the points of an entity: (nq, rows, ld), from the padded table */
INLINE void basis(int nq, int dim, int ld, const double *tab, const double *invJ, double *B)
{
    for (int q = 0; q < nq; q++, tab += dim * ld, B += dim * ld, invJ += dim * dim)
        for (int d = 0; d < dim; d++)
            for (int v = 0; v < ld; v += W) {
                vec s = invJ[d] * *(const vec *)(tab + v);
                for (int k = 1; k < dim; k++)
                    s += invJ[k * dim + d] * *(const vec *)(tab + k * ld + v);
                *(vec *)(B + d * ld + v) = s;
            }
}

/* T (nq, ti, ci, cj, nj) = w g . trial; whole vectors, each overwritten by its successor's start */
INLINE void flux_of_trial(int nq, int ti, int ci, int cj, int tj, int nj, int ld, int ldt,
                          const double *w, const double *g, const double *B, double *T)
{
    for (int q = 0; q < nq; q++, B += tj * ld, g += ci * ti * cj * tj)
        for (int a = 0; a < ti; a++, T += ldt)
            for (int c = 0; c < ci; c++)
                for (int d = 0; d < cj; d++) {
                    const double *s = g + ((c * ti + a) * cj + d) * tj;
                    double *t = T + (c * cj + d) * nj;
                    for (int v = 0; v < ld; v += W) {
                        vec y = w[q] * s[0] * *(const vec *)(B + v);
                        for (int b = 1; b < tj; b++)
                            y += w[q] * s[b] * *(const vec *)(B + b * ld + v);
                        *(vec *)(t + v) = y;
                    }
                }
}

/* K = or += sum_q w test g trial;  g (ne, nq, ci[, dim], cj[, dim]) */
void pl_matrix(int ne, int nq, int dim, int variants, int ni, int ci, int gi, const double *tabi,
               int nj, int cj, int gj, const double *tabj, const int *variant,
               const double *invJ, const double *w, const double *g, int add, double *K)
{
    const int ti = gi ? dim : 1, tj = gj ? dim : 1, n = ci * cj * nj;
    const int li = PAD(ni), lj = PAD(nj), ldt = PAD(n);
    double *pi = padded((size_t)variants * nq * ti, ni, tabi);
    double *pj = padded((size_t)variants * nq * tj, nj, tabj);
    double *T = calloc(nq * (ti * ldt + ti * li + tj * lj) + W, sizeof(double));
    double *Bi = T + nq * ti * ldt + W, *Bj = Bi + nq * ti * li;
    for (int e = 0; e < ne; e++) {
        const double *iJ = invJ + (size_t)e * nq * dim * dim, *we = w + (size_t)e * nq;
        const double *ge = g + (size_t)e * nq * ci * ti * cj * tj;
        const double *test = pi + (size_t)variant[e] * nq * ti * li;
        const double *trial = pj + (size_t)variant[e] * nq * tj * lj;
#define SPECIAL(D, LD) if (dim == D && ld == LD) basis(nq, D, LD, tab, iJ, B)
#define BASIS(grad, tab_, ld_, B_) \
    if (grad) { \
        const double *tab = tab_; const int ld = ld_; double *B = B_; \
        SPECIAL(2, W); else SPECIAL(2, 2 * W); else SPECIAL(3, W); else basis(nq, dim, ld, tab, iJ, B); \
        tab_ = B; \
    }
        BASIS(gi, test, li, Bi)
        BASIS(gj, trial, lj, Bj)
        if (gi && gj && dim == 2 && cj == 2 && lj == 2 * W)
            flux_of_trial(nq, 2, ci, 2, 2, nj, 2 * W, ldt, we, ge, trial, T);
        else if (gj && dim == 2 && lj == W)
            flux_of_trial(nq, ti, ci, cj, 2, nj, W, ldt, we, ge, trial, T);
        else if (!gj && lj == W)
            flux_of_trial(nq, ti, ci, cj, 1, nj, W, ldt, we, ge, trial, T);
        else
            flux_of_trial(nq, ti, ci, cj, tj, nj, lj, ldt, we, ge, trial, T);
        product(nq * ti, ni, n, test, li, T, ldt, K + (size_t)e * ni * ldt, ldt, add);
    }
    free(pi);
    free(pj);
    free(T);
}

/* K <- R^T K (test side) or K R (trial side) at nodes stored in a rotated frame.
 * entities (count): which of the batch; frame_of (count, nn): frame number of a node, or -1. */
void pl_rotate(int count, const int *entities, int dim, const int *frame_of, const double *frames,
               int trial, int ni, int ci, int cj, int nj, double *K)
{
    const int ld = PAD(ci * cj * nj), nn = trial ? nj : ni;
    const int step = trial ? nj : cj * nj; /* between components of the rotated side */
    const int others = trial ? ni * ci : cj * nj;
    for (int n = 0; n < count; n++)
        for (int i = 0; i < nn; i++) {
            const int f = frame_of[(size_t)n * nn + i];
            if (f < 0) continue;
            const double *R = frames + (size_t)f * dim * dim;
            double *Ke = K + (size_t)entities[n] * ni * ld;
            for (int o = 0; o < others; o++) {
                double *k = trial ? Ke + (o / ci) * ld + (o % ci) * cj * nj + i : Ke + i * ld + o;
                double s[3] = {0.0, 0.0, 0.0};
                for (int a = 0; a < dim; a++)
                    for (int b = 0; b < dim; b++) s[b] += R[a * dim + b] * k[a * step];
                for (int b = 0; b < dim; b++) k[b * step] = s[b];
            }
        }
}

/* values[slot] += K; slots (ne, ni, n), -1: dropped */
void pl_scatter(int ne, int ni, int n, const double *K, const int *slots, double *values)
{
    const int ld = PAD(n);
    for (size_t row = 0; row < (size_t)ne * ni; row++) {
        const double *k = K + row * ld;
        const int *s = slots + row * n;
        for (int j = 0; j < n; j++)
            if (s[j] >= 0) values[s[j]] += k[j];
    }
}

/* slots (ne, nr, nc): where each (row, column) of an entity stands in the sorted CSR pattern */
void pl_slots(int ne, int nr, int nc, const int *rows, const int *cols, const int *indptr,
              const int *indices, int *slots)
{
    for (size_t er = 0; er < (size_t)ne * nr; er++) {
        const int row = rows[er], *c = cols + er / nr * nc;
        for (int j = 0; j < nc; j++) {
            int at = -1;
            if (row >= 0 && c[j] >= 0) {
                int low = indptr[row], high = indptr[row + 1];
                while (high - low > 1) {
                    const int middle = (low + high) / 2;
                    if (indices[middle] <= c[j]) low = middle;
                    else high = middle;
                }
                at = low;
            }
            slots[er * nc + j] = at;
        }
    }
}

static struct PyModuleDef module = {PyModuleDef_HEAD_INIT, "_kernels", NULL, -1, NULL};
PyMODINIT_FUNC PyInit__kernels(void) { return PyModule_Create(&module); }
