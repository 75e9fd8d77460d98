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

/* Transition, cruise, transition: how far one joint comes in a segment (segment.py). */
#include "reach.h"

#include "export.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { JOINTS = 3 };

double largest_change(const Law *law, double T)
{
    const double by_acceleration = T / law->slope;
    if (!(law->root > 0.0))
        return by_acceleration;
    const double by_jerk = (T / law->root) * (T / law->root);
    return by_jerk < by_acceleration ? by_jerk : by_acceleration;
}

double change_rate(const Law *law, double T)
{
    return largest_change(law, T) < T / law->slope ? 2.0 * T / (law->root * law->root)
        : 1.0 / law->slope;
}

/* How far the cruise is above the faster end: y >= 0 with t(y) + t(y + gap) = T. */
static double rise(const Law *law, double gap, double T)
{
    const double slope = law->slope, root = law->root;
    const double by_acceleration = 0.5 * (T / slope - gap);
    if (!(root > 0.0))
        return fmax(by_acceleration, 0.0);
    const double change = (root / slope) * (root / slope);  /* below it, jerk rules */
    if (by_acceleration >= change)
        return by_acceleration;
    const double over = fmax((T / root) * (T / root) - gap, 0.0) * root / (2.0 * T);
    const double by_jerk = over * over;
    if (by_jerk + gap <= change)
        return by_jerk;
    const double left = fmax(T - slope * gap, 0.0);
    const double mixed = 2.0 * left / (root + sqrt(root * root + 4.0 * slope * left));
    return mixed * mixed;
}

static double least_time(const Law *law, double u)
{
    return fmax(law->slope * u, law->root * sqrt(u));
}

/* Displacement with shortest transitions to and from a cruise that is not below either end. */
static double displacement(const Law *law, double cruise, double v0, double v1, double T)
{
    const double u0 = cruise - v0, u1 = cruise - v1;
    return cruise * T - 0.5 * (u0 * least_time(law, u0) + u1 * least_time(law, u1));
}

static double fastest_cruise(const Law *law, double v0, double v1, double T)
{
    return fmin(fmax(v0, v1) + rise(law, fabs(v1 - v0), T), law->max_velocity);
}

double reach(const Law *law, double v0, double v1, double T)
{
    return displacement(law, fastest_cruise(law, v0, v1, T), v0, v1, T);
}

typedef struct {
    double t, m, i, k;  /* of a transition by u: its duration t, m and i of transition_law.py; k is how i changes with u, times i */
} Transition;

static Transition transition(const Law *law, double u)
{
    const double by_acceleration = law->slope * u, by_jerk = law->root * sqrt(u);
    const Transition jerky = {by_jerk, 0.75, 2.0 * u / by_jerk, 2.0 / (law->root * law->root)};
    const Transition hard = {by_acceleration, 1.0, 1.0 / law->slope, 0.0};
    return by_jerk > by_acceleration ? jerky : hard;
}

ReachDerivatives reach_derivatives(const Law *law, double v0, double v1, double T)
{
    const double free = fmax(v0, v1) + rise(law, fabs(v1 - v0), T);
    const int capped = free >= law->max_velocity;
    const double cruise = capped ? law->max_velocity : free;
    const double u0 = cruise - v0, u1 = cruise - v1;
    const Transition a = transition(law, u0), b = transition(law, u1);
    const double q = capped ? 0.0 : 1.0 / (a.i + b.i), q3 = q * q * q;
    const double own0 = capped ? a.m / a.i : a.m * q, own1 = capped ? b.m / b.i : b.m * q;
    const double share = b.i * q, rest = a.i * q, by_T = share * a.i;
    const double left = capped ? 0.0 : T - a.m * a.t - b.m * b.t;
    const double skew = left * q3 * (a.i * b.k + b.i * a.k);
    const double skew_T = left * q3 * (a.i * a.i * b.k - b.i * b.i * a.k);
    const double more = (a.m - b.m) * q, with_T = 1.0 - a.m * share - b.m * rest;
    const double one_two = a.m * q - more * share - skew;
    const double one_T = (a.m + with_T) * share + skew_T;
    const double two_T = (b.m + with_T) * rest - skew_T;
    const ReachDerivatives found = {
        cruise * T - 0.5 * (u0 * a.t + u1 * b.t),
        {a.m * a.t + left * share, b.m * b.t + left * rest, cruise + left * by_T},
        {{-own0 + more * share + skew, one_two, one_T},
         {one_two, -own1 - more * rest + skew, two_T},
         {one_T, two_T, by_T * (1.0 + with_T)
              + left * q3 * (b.i * b.i * b.i * a.k + a.i * a.i * a.i * b.k)}}};
    return found;
}

/* See transition_law.py: of count cases with three joints each. */
EXPORTED void reach_at(int32_t count, const double *slope, const double *root,
                       const double *max_velocity, const double *v0, const double *v1,
                       const double *T, double *cruise, double *distance,
                       double (*gradient)[3], double (*hessian)[3][3])
{
    for (int i = 0; i < JOINTS * count; ++i) {
        const Law law = {slope[i % JOINTS], root[i % JOINTS], max_velocity[i % JOINTS]};
        cruise[i] = fastest_cruise(&law, v0[i], v1[i], T[i]);
        distance[i] = displacement(&law, cruise[i], v0[i], v1[i], T[i]);
        if (!gradient)
            continue;
        const ReachDerivatives at = reach_derivatives(&law, v0[i], v1[i], T[i]);
        memcpy(gradient[i], at.gradient, sizeof at.gradient);
        memcpy(hessian[i], at.hessian, sizeof at.hessian);
    }
}

/* The lowest cruises, from lowest up to given ones, that cover displacements D in durations T (count)
 * with shortest transitions; cruise has the given ones at first. */
EXPORTED void cruise_covering(int32_t count, int32_t bisections, const double *slope,
                              const double *root, const double *lowest, const double *v0,
                              const double *v1, const double *T, const double *D, double *cruise)
{
    for (int i = 0; i < JOINTS * count; ++i) {
        const Law law = {slope[i % JOINTS], root[i % JOINTS], INFINITY};
        double low = lowest[i], high = cruise[i];
        for (int k = 0; k < bisections; ++k) {
            const double middle = 0.5 * (low + high);
            if (displacement(&law, middle, v0[i], v1[i], T[i / JOINTS]) < D[i])
                low = middle;
            else
                high = middle;
        }
        cruise[i] = high;
    }
}
