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

/* Symmetric banded systems, solved by Cholesky's method (Golub & Van Loan, Matrix Computations,
 * 4.3.5). */
#include "band_cholesky.h"

#include "processor.h"

#include <math.h>
#include <stddef.h>

BY_PROCESSOR int solve_band(double *band, double *right, int m, int w, int sides)
{
    for (int c = 0; c < m; ++c) {
        double *column = band + (size_t)c * w, *own = right + (size_t)c * sides;
        if (!(column[0] > 0.0) || !isfinite(column[0]))
            return 1;
        const double inverse = 1.0 / sqrt(column[0]);
        const int below = c + w < m ? w : m - c;
        column[0] = inverse;
        for (int i = 1; i < below; ++i)
            column[i] *= inverse;
        for (int i = 1; i < below; ++i) {
            double *restrict other = column + i * w;
            const double *restrict rest = column + i, factor = column[i];
            for (int k = 0; k < below - i; ++k)
                other[k] -= factor * rest[k];
        }
        for (int s = 0; s < sides; ++s) {
            own[s] *= inverse;
            for (int i = 1; i < below; ++i)
                own[i * sides + s] -= column[i] * own[s];
        }
    }
    for (int c = m - 1; c >= 0; --c) {
        const double *column = band + (size_t)c * w;
        const int below = c + w < m ? w : m - c;
        double *own = right + (size_t)c * sides;
        for (int s = 0; s < sides; ++s) {
            for (int i = 1; i < below; ++i)
                own[s] -= column[i] * own[i * sides + s];
            own[s] *= column[0];
        }
    }
    return 0;
}
