// Copyright 2026 rrr_traj_planner developers
//
// Licensed under the Apache License, Version 2.0 (the "License");
// you may not use this file except in compliance with the License.
// You may obtain a copy of the License at
//
//     http://www.apache.org/licenses/LICENSE-2.0
//
// Unless required by applicable law or agreed to in writing, software
// distributed under the License is distributed on an "AS IS" BASIS,
// WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
// See the License for the specific language governing permissions and
// limitations under the License.

/* Roots of real trigonometric polynomials of degree 2, as the roots of z^2 f(z), z = exp(i angle),
 * by Aberth's simultaneous iteration (Mathematics of Computation 27, 1973). */
#include "inverse.h"

#include <complex.h>
#include <float.h>

typedef double complex Complex;

enum { ROOTS = 4, MOST_ITERATIONS = 60 };

static const double SMALL = 1e-13;    /* part of the largest coefficient that is rounding */
static const double ON_CIRCLE = 1e-5; /* |r - 1| that rounding may give to a double root */

static double squared(Complex z)
{
    return creal(z) * creal(z) + cimag(z) * cimag(z);
}

static Complex inverse_of(Complex z)
{
    return conj(z) / squared(z);
}

/* Aberth's step of root i of the polynomial b, highest power first; 0 where p(z) is rounding. */
static Complex step(const Complex *b, const Complex *z, int i)
{
    Complex p = b[0], slope = 0.0, others = 0.0;
    double r = sqrt(squared(z[i])), bound = sqrt(squared(b[0]));
    for (int k = 1; k <= ROOTS; ++k) {
        slope = slope * z[i] + p;
        p = p * z[i] + b[k];
        bound = bound * r + sqrt(squared(b[k]));
    }
    if (squared(p) <= 4.0 * DBL_EPSILON * DBL_EPSILON * bound * bound)
        return 0.0;
    for (int j = 0; j < ROOTS; ++j)
        if (j != i && z[j] != z[i])
            others += inverse_of(z[i] - z[j]);
    const Complex denominator = slope - p * others;
    return squared(denominator) > 0.0 ? p * inverse_of(denominator) : 0.1 * z[i] + 0.01;
}

/* All roots of the quartic b, b[0] not 0; first guesses at the moduli of its coefficients. */
static void quartic_roots(const Complex *b, Complex *z)
{
    const double ratio = sqrt(squared(b[1]) / squared(b[0])), far = ratio > 1.0 ? ratio : 1.0;
    const double radius[ROOTS] = {1.1 * far, 0.9, 0.95 / far, 1.05};
    for (int i = 0; i < ROOTS; ++i)
        z[i] = radius[i] * cexp(I * (0.7 + 1.5 * i));
    for (int n = 0; n < MOST_ITERATIONS; ++n) {
        double largest = 0.0;
        for (int i = 0; i < ROOTS; ++i) {
            const Complex d = step(b, z, i);
            z[i] -= d;
            largest = fmax(largest, squared(d) / squared(z[i]));
        }
        if (largest <= 1e-28)
            return;
    }
}

/* The roots where degree 1 is left, or, where there is none, the angle nearest to one. */
static int roots_of_degree_1(const double *f, double *angle, double *off)
{
    const double amplitude = hypot(f[1], f[2]), middle = atan2(f[2], f[1]);
    const double cosine = -f[0] / amplitude, turn = acos(fmax(-1.0, fmin(1.0, cosine)));
    for (int i = 0; i < 2; ++i) {
        angle[i] = middle + (i ? -turn : turn);
        off[i] = fmax(0.0, fabs(cosine) - 1.0);
    }
    return 2;
}

int circle_roots(const double *f, double *angle, double *off)
{
    const double second = hypot(f[3], f[4]), first = hypot(f[1], f[2]);
    const double rounding = SMALL * fmax(fabs(f[0]), fmax(first, second));
    if (second <= rounding)
        return first > rounding ? roots_of_degree_1(f, angle, off) : 0;
    const Complex b1 = 0.5 * (f[1] - I * f[2]), b2 = 0.5 * (f[3] - I * f[4]);
    const Complex b[ROOTS + 1] = {b2, b1, f[0], conj(b1), conj(b2)};
    Complex z[ROOTS];
    int count = 0;
    quartic_roots(b, z);
    for (int i = 0; i < ROOTS; ++i) {
        const double r = sqrt(squared(z[i]));
        if (r < 1.0 - ON_CIRCLE)
            continue;
        angle[count] = carg(z[i]), off[count++] = fabs(r - 1.0);
    }
    return count;
}
