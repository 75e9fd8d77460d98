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


/* Nodes of refined meshes, and jerks at them (solver/refinement.py), in one pass along each
 * segment's intervals. */
#include "export.h"

#include <stddef.h>
#include <stdint.h>

/* Parts (n) with equal shares of the integral of a monitor function, from those on which it is
 * constant. */
static void equal_shares(int n, const double *monitor, const double *parts, double *found)
{
    double whole = 0.0, share = 0.0, start = 0.0, before = 0.0;
    for (int i = 0; i < n; ++i)
        whole += monitor[i] * parts[i];
    for (int i = 0, at = 0; i < n; ++i) {  /* at: the interval with the end of part i */
        const double end = whole * (i + 1) / n;
        while (at < n - 1 && share + monitor[at] * parts[at] < end) {
            share += monitor[at] * parts[at];
            start += parts[at++];
        }
        const double node = i < n - 1 ? start + (end - share) / monitor[at] : 1.0;
        found[i] = node - before;
        before = node;
    }
}

/* Lengthen parts to the least, at the cost of the longer ones, until none is shorter. */
static void lengthen(int n, double least, double *parts)
{
    for (int is_short = 1; is_short;) {
        double longer = 0.0, spare = 1.0;
        is_short = 0;
        for (int i = 0; i < n; ++i) {
            is_short |= parts[i] < least;
            if (parts[i] > least)
                longer += parts[i];
            else
                spare -= least;
        }
        for (int i = 0; i < n && is_short; ++i)
            parts[i] = parts[i] > least ? parts[i] * spare / longer : least;
    }
}

/* Parts (N, n) of refined meshes, from monitor functions and parts (N, n): none shorter than the
 * least (N), which is below the mean one. */
EXPORTED void refined_parts(int32_t N, int32_t n, const double *monitor, const double *parts,
                            const double *least, double *found)
{
    for (int k = 0; k < N; ++k, monitor += n, parts += n, found += n) {
        double sum = 0.0;
        equal_shares(n, monitor, parts, found);
        lengthen(n, least[k], found);
        for (int i = 0; i < n; ++i)
            sum += found[i];
        for (int i = 0; i < n; ++i)
            found[i] /= sum;
    }
}

/* Jerks at the inner nodes (N, to_n - 1, J) of other meshes, linear between those at the nodes of
 * the present ones (N, n + 1, J). */
EXPORTED void jerks_on_mesh(int32_t J, int32_t N, int32_t n, const double *parts,
                            const double *jerk, int32_t to_n, const double *to_parts,
                            double *inner)
{
    for (int k = 0; k < N; ++k, parts += n, jerk += (size_t)(n + 1) * J, to_parts += to_n) {
        double start = 0.0, node = 0.0;
        for (int i = 0, at = 0; i < to_n - 1; ++i, inner += J) {
            node += to_parts[i];
            while (at < n - 1 && start + parts[at] < node)
                start += parts[at++];
            const double part = (node - start) / parts[at], *here = jerk + (size_t)at * J;
            for (int j = 0; j < J; ++j)
                inner[j] = here[j] + part * (here[J + j] - here[j]);
        }
    }
}
