/* Tensor products at many points: the compiled half of tensors.py, where the formulas stand.
 *
 * Arrays are C-contiguous, one block per point: n points, tensors (dim, dim) or m numbers long.
 * A stride of 0 repeats one value at all points. */
#include <Python.h>

#define INLINE static inline __attribute__((always_inline))

/* out = a A + b B, each (n, m); coefficients and tensors may be the same at all points */
INLINE void combine(int n, int m, const double *a, int da, const double *restrict A, int dA,
                    const double *b, int db, const double *restrict B, int dB,
                    double *restrict out)
{
    for (int p = 0; p < n; p++, a += da, A += dA, b += db, B += dB, out += m)
        for (int i = 0; i < m; i++) out[i] = *a * A[i] + *b * B[i];
}

void pt_combine(int n, int m, const double *a, int da, const double *A, int dA, const double *b,
                int db, const double *B, int dB, double *out)
{
    switch (m) {
    case 2: combine(n, 2, a, da, A, dA, b, db, B, dB, out); break;
    case 4: combine(n, 4, a, da, A, dA, b, db, B, dB, out); break;
    case 8: combine(n, 8, a, da, A, dA, b, db, B, dB, out); break;
    case 9: combine(n, 9, a, da, A, dA, b, db, B, dB, out); break;
    case 16: combine(n, 16, a, da, A, dA, b, db, B, dB, out); break;
    default: combine(n, m, a, da, A, dA, b, db, B, dB, out);
    }
}

/* out_ij = A_i B_j, (n, ma, mb) */
INLINE void outer(int n, int ma, int mb, const double *restrict A, const double *restrict B,
                  double *restrict out)
{
    for (int p = 0; p < n; p++, A += ma, B += mb)
        for (int i = 0; i < ma; i++, out += mb)
            for (int j = 0; j < mb; j++) out[j] = A[i] * B[j];
}

void pt_outer(int n, int ma, int mb, const double *A, const double *B, double *out)
{
    if (ma == 2 && mb == 4) outer(n, 2, 4, A, B, out);
    else if (ma == 3 && mb == 9) outer(n, 3, 9, A, B, out);
    else outer(n, ma, mb, A, B, out);
}

/* out_i = A_ij B_j, (n, rows) */
INLINE void apply(int n, int rows, int cols, const double *restrict A, const double *restrict B,
                  double *restrict out)
{
    for (int p = 0; p < n; p++, B += cols)
        for (int i = 0; i < rows; i++, A += cols) {
            double s = 0.0;
            for (int j = 0; j < cols; j++) s += A[j] * B[j];
            *out++ = s;
        }
}

void pt_apply(int n, int rows, int cols, const double *A, const double *B, double *out)
{
    if (rows == 2 && cols == 2) apply(n, 2, 2, A, B, out);
    else if (rows == 3 && cols == 3) apply(n, 3, 3, A, B, out);
    else if (rows == 1 && cols == 4) apply(n, 1, 4, A, B, out);
    else apply(n, rows, cols, A, B, out);
}

/* J = det F, T = F^-T, cof = J T */
void pt_inverse(int n, int dim, const double *restrict F, double *restrict J, double *restrict T,
                double *restrict cof)
{
    const int m = dim * dim;
    for (int p = 0; p < n; p++, F += m, T += m, cof += m) {
        if (dim == 2) {
            cof[0] = F[3], cof[1] = -F[2], cof[2] = -F[1], cof[3] = F[0];
            J[p] = F[0] * F[3] - F[1] * F[2];
        } else {
            for (int i = 0; i < 3; i++) {
                const double *b = F + (i + 1) % 3 * 3, *c = F + (i + 2) % 3 * 3;
                cof[i * 3] = b[1] * c[2] - b[2] * c[1];
                cof[i * 3 + 1] = b[2] * c[0] - b[0] * c[2];
                cof[i * 3 + 2] = b[0] * c[1] - b[1] * c[0];
            }
            J[p] = F[0] * cof[0] + F[1] * cof[1] + F[2] * cof[2];
        }
        const double over = 1.0 / J[p];
        for (int i = 0; i < m; i++) T[i] = over * cof[i];
    }
}

/* one d_ik d_jl + mixed (F_ij T_kl + T_ij F_kl) + square T_ij T_kl + crossed T_il T_kj */
INLINE void tangent(int n, int dim, const double *restrict F, const double *restrict T,
                    const double *one, const double *mixed, const double *square,
                    const double *crossed, double *restrict out)
{
    const int m = dim * dim;
    for (int p = 0; p < n; p++, F += m, T += m)
        for (int i = 0; i < dim; i++)
            for (int j = 0; j < dim; j++, out += m) {
                const int ij = i * dim + j;
                const double byT = mixed[p] * F[ij] + square[p] * T[ij], byF = mixed[p] * T[ij];
                for (int k = 0; k < dim; k++) {
                    const double c = crossed[p] * T[k * dim + j];
                    for (int l = 0; l < dim; l++) {
                        const int kl = k * dim + l;
                        out[kl] = byT * T[kl] + byF * F[kl] + c * T[i * dim + l];
                    }
                }
                out[ij] += one[p];
            }
}

void pt_tangent(int n, int dim, const double *F, const double *T, const double *one,
                const double *mixed, const double *square, const double *crossed, double *out)
{
    if (dim == 2) tangent(n, 2, F, T, one, mixed, square, crossed, out);
    else tangent(n, 3, F, T, one, mixed, square, crossed, out);
}

/* M = J F^-1 F^-T; its product with g derived by F: (n, dim, dim, dim) */
INLINE void mobility(int n, int dim, const double *J, const double *restrict T,
                     double *restrict M)
{
    for (int p = 0; p < n; p++, T += dim * dim)
        for (int j = 0; j < dim; j++)
            for (int k = 0; k < dim; k++) {
                double s = 0.0;
                for (int i = 0; i < dim; i++) s += T[i * dim + j] * T[i * dim + k];
                *M++ = J[p] * s;
            }
}

void pt_mobility(int n, int dim, const double *J, const double *T, double *M)
{
    if (dim == 2) mobility(n, 2, J, T, M);
    else mobility(n, 3, J, T, M);
}

INLINE void mobility_flux(int n, int dim, const double *restrict T, const double *restrict M,
                          const double *restrict g, double *restrict out)
{
    for (int p = 0; p < n; p++, T += dim * dim, M += dim * dim, g += dim) {
        double Mg[3] = {0.0, 0.0, 0.0}, Tg[3] = {0.0, 0.0, 0.0};
        for (int j = 0; j < dim; j++)
            for (int k = 0; k < dim; k++) {
                Mg[j] += M[j * dim + k] * g[k];
                Tg[j] += T[j * dim + k] * g[k];
            }
        for (int j = 0; j < dim; j++)
            for (int k = 0; k < dim; k++)
                for (int l = 0; l < dim; l++)
                    *out++ = Mg[j] * T[k * dim + l] - T[k * dim + j] * Mg[l]
                             - M[j * dim + l] * Tg[k];
    }
}

void pt_mobility_flux(int n, int dim, const double *T, const double *M, const double *g,
                      double *out)
{
    if (dim == 2) mobility_flux(n, 2, T, M, g, out);
    else mobility_flux(n, 3, T, M, g, out);
}

static struct PyModuleDef module = {PyModuleDef_HEAD_INIT, "_tensors", NULL, -1, NULL};
PyMODINIT_FUNC PyInit__tensors(void) { return PyModule_Create(&module); }
