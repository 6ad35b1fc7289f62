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
 *   dofs       : (ne, nn)                 local number of a node's first component, -1: absent */
#include <Python.h>
#include <stdlib.h>
#include <string.h>

#ifdef __AVX512F__
#define W 8 /* doubles per vector */
#define MAXROWS 4
#define MAXPANEL 5
#define ZIP_LOW ((lanes){0, 8, 1, 9, 2, 10, 3, 11})
#define ZIP_HIGH ((lanes){4, 12, 5, 13, 6, 14, 7, 15})
#elif defined(__AVX__)
#define W 4
#define MAXROWS 3
#define MAXPANEL 4
#define ZIP_LOW ((lanes){0, 4, 1, 5})
#define ZIP_HIGH ((lanes){2, 6, 3, 7})
#else
#define W 2
#define MAXROWS 3
#define MAXPANEL 4
#define ZIP_LOW ((lanes){0, 2})
#define ZIP_HIGH ((lanes){1, 3})
#endif
#define GROUP 64 /* element matrices computed before they are scattered */
#define PAD(n) (((n) + W - 1) / W * W)
#define INLINE static inline __attribute__((always_inline))

typedef double vec __attribute__((vector_size(8 * W), aligned(8), may_alias));
typedef long long lanes __attribute__((vector_size(8 * W)));

/* C (rows, panel vectors) = A^T T over k; all loops unroll, the sums stay in registers */
INLINE void tile(int rows, int panel, int nk, const double *A, int lda, const double *T, int ldt,
                 double *C, int ldc)
{
    vec sum[MAXROWS][MAXPANEL];
#pragma GCC unroll 8
    for (int i = 0; i < rows; i++)
#pragma GCC unroll 8
        for (int p = 0; p < panel; p++)
            sum[i][p] = (vec){0};
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

/* C (m, n) = A^T T with A (nk, m), T (nk, n); rows of T and C are padded */
static void product(int nk, int m, int n, const double *A, int lda, const double *T, int ldt,
                    double *C, int ldc)
{
    const int nv = PAD(n) / W;
    const int panels = (nv + MAXPANEL - 1) / MAXPANEL, panel = (nv + panels - 1) / panels;
    const int blocks = (m + MAXROWS - 1) / MAXROWS, block = (m + blocks - 1) / blocks;
#define TILE(r, p) \
    case (r) * 8 + (p): \
        tile(r, p, nk, A + i, lda, T + v * W, ldt, C + (size_t)i * ldc + v * W, ldc); \
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
    for (size_t k = 0; k < rows; k++)
        memcpy(out + k * PAD(nn), table + k * nn, nn * sizeof(double));
    return out;
}

/* physical gradients out (nq, nc, dim) of an entity from reference ones h (nc, nq, dim), ld */
INLINE void pushed_forward(int nq, int dim, int nc, int ld, const double *invJ, const double *h,
                           double *out)
{
    for (int q = 0; q < nq; q++, invJ += dim * dim, h += dim)
        for (int c = 0; c < nc; c++)
            for (int d = 0; d < dim; d++) {
                double s = 0.0;
                for (int k = 0; k < dim; k++) s += h[c * ld + k] * invJ[k * dim + d];
                *out++ = s;
            }
}

/* out (ne, nq, nc[, dim]) = the field or its gradient at the points */
void pl_evaluate(int ne, int nq, int dim, int variants, int nn, int nc, int grad,
                 const double *table, const int *variant, const double *invJ, const int *dofs,
                 const double *x, double *out)
{
    const int rows = grad ? dim : 1, n = nq * rows, ld = PAD(n);
    /* the table as (variant, node, point) */
    double *turned = calloc((size_t)variants * nn * ld, sizeof(double));
    double *h = malloc((nc * ld + nn * nc) * sizeof(double)), *xe = h + nc * ld;
    for (int v = 0; v < variants; v++)
        for (int k = 0; k < n; k++)
            for (int i = 0; i < nn; i++)
                turned[((size_t)v * nn + i) * ld + k] = table[((size_t)v * n + k) * nn + i];
    for (int e = 0; e < ne; e++, invJ += nq * dim * dim, out += n * nc, dofs += nn) {
        for (int i = 0; i < nn; i++)
            for (int c = 0; c < nc; c++) xe[i * nc + c] = dofs[i] < 0 ? 0.0 : x[dofs[i] + c];
        product(nn, nc, n, xe, nc, turned + (size_t)variant[e] * nn * ld, ld, h, ld);
        if (!grad)
            for (int q = 0; q < nq; q++)
                for (int c = 0; c < nc; c++) out[q * nc + c] = h[c * ld + q];
        else if (dim == 2 && nc == 2) pushed_forward(nq, 2, 2, ld, invJ, h, out);
        else if (dim == 2 && nc == 1) pushed_forward(nq, 2, 1, ld, invJ, h, out);
        else pushed_forward(nq, dim, nc, ld, invJ, h, out);
    }
    free(turned);
    free(h);
}

/* out (nq, rows, nc) = w invJ f at the points of an entity (w f for values), f (nq, nc[, dim]) */
INLINE void pulled_back(int nq, int dim, int nc, const double *invJ, const double *w,
                        const double *f, double *out)
{
    for (int q = 0; q < nq; q++, invJ += dim * dim, f += nc * dim)
        for (int k = 0; k < dim; k++)
            for (int c = 0; c < nc; c++) {
                double s = 0.0;
                for (int d = 0; d < dim; d++) s += invJ[k * dim + d] * f[c * dim + d];
                *out++ = w[q] * s;
            }
}

/* r[dof] += sum_q w f . (test value or gradient);  f (ne, nq, nc[, dim]) */
void pl_residual(int ne, int nq, int dim, int variants, int nn, int nc, int grad,
                 const double *table, const int *variant, const double *invJ, const double *w,
                 const double *f, const int *dofs, double *r)
{
    const int rows = grad ? dim : 1, nk = nq * rows, ld = PAD(nn);
    double *tab = padded((size_t)variants * nk, nn, table);
    double *fe = malloc((nk * nc + nc * ld) * sizeof(double)), *re = fe + nk * nc;
    for (int e = 0; e < ne; e++, f += nk * nc, w += nq, invJ += nq * dim * dim) {
        if (!grad)
            for (int k = 0; k < nq * nc; k++) fe[k] = w[k / nc] * f[k];
        else if (dim == 2 && nc == 2) pulled_back(nq, 2, 2, invJ, w, f, fe);
        else if (dim == 2 && nc == 1) pulled_back(nq, 2, 1, invJ, w, f, fe);
        else pulled_back(nq, dim, nc, invJ, w, f, fe);
        product(nk, nc, nn, fe, nc, tab + (size_t)variant[e] * nk * ld, ld, re, ld);
        for (int i = 0; i < nn; i++) {
            const int k = dofs[(size_t)e * nn + i];
            for (int c = 0; c < nc && k >= 0; c++) r[k + c] += re[c * ld + i];
        }
    }
    free(tab);
    free(fe);
}

/* physical basis rows (nq, rows, ld) at the points of an entity, times w if given */
INLINE void gradients(int nq, int dim, int ld, const double *tab, const double *invJ,
                      const double *w, double *B)
{
    for (int q = 0; q < nq; q++, tab += dim * ld, B += dim * ld, invJ += dim * dim)
        for (int d = 0; d < dim; d++)
            for (int v = 0; v < ld; v += W) {
                vec s = (w ? w[q] : 1.0) * invJ[d] * *(const vec *)(tab + v);
                for (int k = 1; k < dim; k++)
                    s += (w ? w[q] : 1.0) * invJ[k * dim + d] * *(const vec *)(tab + k * ld + v);
                *(vec *)(B + d * ld + v) = s;
            }
}

/* basis rows of one side: gradients or values, in room B, or the table where it serves as it is */
static const double *basis(int grad, int nq, int dim, int ld, const double *tab,
                           const double *invJ, const double *w, double *B)
{
    if (!grad && !w) return tab;
    if (!grad)
        for (int q = 0; q < nq; q++)
            for (int v = 0; v < ld; v += W)
                *(vec *)(B + q * ld + v) = w[q] * *(const vec *)(tab + q * ld + v);
    else if (dim == 2 && ld == W) gradients(nq, 2, W, tab, invJ, w, B);
    else if (dim == 2 && ld == 2 * W) gradients(nq, 2, 2 * W, tab, invJ, w, B);
    else gradients(nq, dim, ld, tab, invJ, w, B);
    return B;
}

/* T (nq, ti, ci, nj, cj) = g . B; whole vectors, what is beyond a row is overwritten by the next */
INLINE void flux_of_trial(int nq, int ti, int ci, int cj, int tj, int nj, int ld, int ldt,
                          const double *g, const double *B, double *T)
{
    vec y[3];
    for (int q = 0; q < nq; q++, B += tj * ld, g += ci * ti * cj * tj)
        for (int a = 0; a < ti; a++, T += ldt)
            for (int c = 0; c < ci; c++)
                for (int v = 0; v < ld; v += W) {
                    double *t = T + (c * nj + v) * cj;
                    for (int d = 0; d < cj; d++) {
                        const double *s = g + ((c * ti + a) * cj + d) * tj;
                        y[d] = s[0] * *(const vec *)(B + v);
                        for (int b = 1; b < tj; b++) y[d] += s[b] * *(const vec *)(B + b * ld + v);
                    }
                    if (cj == 1) *(vec *)t = y[0];
                    else if (cj == 2) {
                        *(vec *)t = __builtin_shuffle(y[0], y[1], ZIP_LOW);
                        if (v + W / 2 < nj)
                            *(vec *)(t + W) = __builtin_shuffle(y[0], y[1], ZIP_HIGH);
                    } else
                        for (int k = 0; k < W && v + k < nj; k++)
                            for (int d = 0; d < cj; d++) t[k * cj + d] = y[d][k];
                }
}

/* K <- R^T K (test side) or K R (trial side) at nodes with a frame number >= 0 */
static void rotate(int dim, const int *frame_of, const double *frames, int trial, int ni, int ci,
                   int cj, int nj, int ld, double *K)
{
    const int step = trial ? 1 : nj * cj; /* between components of the rotated side */
    const int others = trial ? ni * ci : nj * cj;
    for (int i = 0; i < (trial ? nj : ni); i++) {
        if (frame_of[i] < 0) continue;
        const double *R = frames + (size_t)frame_of[i] * dim * dim;
        for (int o = 0; o < others; o++) {
            double *k = trial ? K + o / ci * ld + (o % ci * nj + i) * cj : K + i * ld + o;
            double s[3] = {0.0, 0.0, 0.0};
            for (int a = 0; a < dim; a++)
                for (int b = 0; b < dim; b++) s[b] += R[a * dim + b] * k[a * step];
            for (int b = 0; b < dim; b++) k[b * step] = s[b];
        }
    }
}

/* values[slot + component] += K; rows of n trial nodes with cj components each */
INLINE void scatter(int rows, int ci, int n, int cj, int ld, const double *K, const int *slots,
                    double *values)
{
    for (int i = 0; i < rows; i++, K += ld)
        for (int j = 0; j < ci * n; j++, slots++)
            if (*slots >= 0)
                for (int d = 0; d < cj; d++) values[*slots + d] += K[j * cj + d];
}

/* values[slots] += sum_q w test g trial;  g (ne, nq, ci[, dim], cj[, dim])
 * Element matrices are (test node, test component, trial node, trial component); slots (ne, ni,
 * ci, nj) say where the first trial component goes, its others follow; -1: dropped.
 * The `turned` entities have nodes in rotated frames: frame_i (turned, ni), frame_j (turned, nj)
 * number the frames, -1: none; NULL: no such side. */
void pl_matrix(int ne, int nq, int dim, int variants, int ni, int ci, int gi, const double *tabi,
               int nj, int cj, int gj, const double *tabj, const int *variant,
               const double *invJ, const double *w, const double *g, int turned,
               const int *entities, const int *frame_i, const int *frame_j, const double *frames,
               const int *slots, double *values)
{
    const int ti = gi ? dim : 1, tj = gj ? dim : 1, n = ci * cj * nj;
    const int li = PAD(ni), lj = PAD(nj), ldt = PAD(n);
    double *pi = padded((size_t)variants * nq * ti, ni, tabi);
    double *pj = padded((size_t)variants * nq * tj, nj, tabj);
    double *T = calloc(nq * (ti * ldt + ti * li + tj * lj) + 3 * W + GROUP * ni * ldt,
                       sizeof(double));
    double *Bi = T + nq * ti * ldt + 3 * W, *Bj = Bi + nq * ti * li, *K = Bj + nq * tj * lj;
    for (int e = 0; e < ne; e++) {
        const double *iJ = invJ + (size_t)e * nq * dim * dim;
        const double *ge = g + (size_t)e * nq * ci * ti * cj * tj;
        const double *test = pi + (size_t)variant[e] * nq * ti * li;
        const double *trial = pj + (size_t)variant[e] * nq * tj * lj;
        for (int k = 0; k < ni * ci * nj; k += 2) /* memory may fetch what the group adds to */
            __builtin_prefetch(values + slots[e % GROUP * ni * ci * nj + k], 1, 2);
        test = basis(gi, nq, dim, li, test, iJ, NULL, Bi);
        basis(gj, nq, dim, lj, trial, iJ, w + (size_t)e * nq, Bj);
#define FLUX(ti, ci, cj, tj, ld) flux_of_trial(nq, ti, ci, cj, tj, nj, ld, ldt, ge, Bj, T)
#define IF_FLUX(ti_, ci_, cj_, tj_, ld_) \
    if (ti == ti_ && ci == ci_ && cj == cj_ && tj == tj_ && lj == ld_) FLUX(ti_, ci_, cj_, tj_, ld_)
        IF_FLUX(2, 2, 2, 2, 2 * W); /* the blocks of plane strain with trip counts known */
        else IF_FLUX(2, 2, 1, 1, W);
        else IF_FLUX(2, 1, 2, 2, 2 * W);
        else IF_FLUX(2, 1, 1, 2, W);
        else IF_FLUX(1, 1, 2, 2, 2 * W);
        else IF_FLUX(1, 1, 1, 1, W);
        else FLUX(ti, ci, cj, tj, lj);
        product(nq * ti, ni, n, test, li, T, ldt, K, ldt);
        if (turned && *entities == e) {
            if (frame_i) rotate(dim, frame_i, frames, 0, ni, ci, cj, nj, ldt, K);
            if (frame_j) rotate(dim, frame_j, frames, 1, ni, ci, cj, nj, ldt, K);
            turned--, entities++;
            if (frame_i) frame_i += ni;
            if (frame_j) frame_j += nj;
        }
        K += ni * ldt;
        if ((e + 1) % GROUP == 0 || e + 1 == ne) {
            const int rows = (e % GROUP + 1) * ni;
            K -= rows * ldt;
            if (cj == 1) scatter(rows, ci, nj, 1, ldt, K, slots, values);
            else if (cj == 2) scatter(rows, ci, nj, 2, ldt, K, slots, values);
            else scatter(rows, ci, nj, 3, ldt, K, slots, values);
            slots += (size_t)rows * ci * nj;
        }
    }
    free(pi);
    free(pj);
    free(T);
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
