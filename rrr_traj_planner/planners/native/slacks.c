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

/* What all constraints have in common: their slacks, multipliers, and both along a step. */
#include "slacks.h"

#include "processor.h"

#include <math.h>

double log_sum(const double *slack, size_t size)
{
    double sum = 0.0, product = 1.0;
    size_t i = 0;
    for (; i + 8 <= size; i += 8) {
        product *= (slack[i] * slack[i + 1]) * (slack[i + 2] * slack[i + 3])
            * ((slack[i + 4] * slack[i + 5]) * (slack[i + 6] * slack[i + 7]));
        if (!(product > 1e-100 && product < 1e100)) {
            sum += log(product);
            product = 1.0;
        }
    }
    for (; i < size; ++i)
        sum += log(slack[i]);
    return sum + log(product);
}

BY_PROCESSOR void invert(const double *restrict slack, size_t size, double *restrict inverse)
{
    for (size_t i = 0; i < size; ++i)
        inverse[i] = 1.0 / slack[i];
}

BY_PROCESSOR void barrier_derivatives(const double *restrict dual, const double *restrict shift,
                                      const double *restrict inverse, size_t constraints,
                                      double barrier, double *restrict f, double *restrict weight)
{
    for (size_t c = 0; c < constraints && weight; ++c)
        weight[c] = dual[2 * c] * inverse[2 * c] + dual[2 * c + 1] * inverse[2 * c + 1];
    for (size_t c = 0; c < constraints && !shift; ++c)
        f[c] = barrier * inverse[2 * c] - barrier * inverse[2 * c + 1];
    for (size_t c = 0; c < constraints && shift; ++c)
        f[c] = (barrier + dual[2 * c] * shift[2 * c]) * inverse[2 * c]
            - (barrier + dual[2 * c + 1] * shift[2 * c + 1]) * inverse[2 * c + 1];
}

/* So many numbers from an array, or all that are left, then zeros. */
INLINE Lanes lanes_at(const double *from, size_t left)
{
    Lanes found = {0.0};
    if (left >= VECTOR)
        return *(const Lanes *)from;
    for (size_t k = 0; k < left; ++k)
        found[k] = from[k];
    return found;
}

INLINE double greatest(Lanes of)
{
    double found = of[0];
    for (int k = 1; k < VECTOR; ++k)
        found = of[k] > found ? of[k] : found;
    return found;
}

BY_PROCESSOR double largest_fall(const double *rate, const double *inverse, size_t size)
{
    Lanes worst = {0.0};
    for (size_t i = 0; i < size; i += VECTOR)
        worst = larger(-lanes_at(rate + i, size - i) * lanes_at(inverse + i, size - i), worst);
    return greatest(worst);
}

BY_PROCESSOR int all_retain(const double *slack, const double *moved, size_t size, double part)
{
    int64_t fewer = 0;
    for (size_t i = 0; i < size; ++i)
        fewer |= moved[i] >= part * slack[i] ? 0 : 1;
    return !fewer;
}

BY_PROCESSOR void step_duals(const double *restrict dual, const double *restrict rate,
                             const double *restrict inverse, size_t size, double barrier,
                             double to_boundary, double *restrict moved)
{
    Lanes worst = {0.0};
    for (size_t i = 0; i < size; ++i)
        moved[i] = (barrier - dual[i] * rate[i]) * inverse[i] - dual[i];
    for (size_t i = 0; i < size; i += VECTOR)
        worst = larger(-lanes_at(moved + i, size - i) / lanes_at(dual + i, size - i), worst);
    const double fall = greatest(worst), part = fall > to_boundary ? to_boundary / fall : 1.0;
    for (size_t i = 0; i < size; ++i)
        moved[i] = dual[i] + part * moved[i];
}

BY_PROCESSOR void confine_duals(double *restrict dual, const double *restrict slack, size_t size,
                                double barrier, double corridor)
{
    const double part = 1.0 / corridor;
    for (size_t i = 0; i < size; ++i) {
        const double central = barrier / slack[i], least = central * part;
        const double most = central * corridor, own = dual[i] < least ? least : dual[i];
        dual[i] = own > most ? most : own;
    }
}

BY_PROCESSOR int are_confined(const double *dual, const double *slack, size_t size, double barrier,
                              double corridor)
{
    const double least = 2.0 * barrier / corridor, most = 0.5 * barrier * corridor;
    int64_t outside = 0;
    for (size_t i = 0; i < size; ++i) {
        const double product = dual[i] * slack[i];
        outside |= product >= least && product <= most ? 0 : 1;
    }
    return !outside;
}
