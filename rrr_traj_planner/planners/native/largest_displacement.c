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

/* The largest displacement of one joint in a segment of transition, cruise and transition
 * (transitions/largest_displacement.py, transitions/transition_law.py). */
#include "largest_displacement.h"

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

/* By how much the cruise is above the faster end velocity: y >= 0 with t(y) + t(y + gap) = T. */
static double rise(const Law *law, double gap, double T)
{
    const double slope = law->slope, root = law->root;
    const double by_acceleration = 0.5 * (T / slope - gap);
    if (!(root > 0.0))
        return fmax(by_acceleration, 0.0);
    const double change = (root / slope) * (root / slope);  /* below it the jerk limit is active */
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

/* TransitionLaw of transitions/transition_law.py, for count cases of three joints each. */
EXPORTED void least_transition_times(int32_t count, const double *slope, const double *root,
                                     const double *change, double *T)
{
    for (int i = 0; i < JOINTS * count; ++i) {
        const Law law = {slope[i % JOINTS], root[i % JOINTS], INFINITY};
        T[i] = least_time(&law, fabs(change[i]));
    }
}

EXPORTED void largest_velocity_changes(int32_t count, const double *slope, const double *root,
                                       const double *T, double *change)
{
    for (int i = 0; i < JOINTS * count; ++i) {
        const Law law = {slope[i % JOINTS], root[i % JOINTS], INFINITY};
        change[i] = largest_change(&law, T[i]);
    }
}

/* The displacement with shortest transitions to and from a cruise not below either end velocity.
 */
static double displacement(const Law *law, double cruise, double v0, double v1, double T)
{
    const double u0 = cruise - v0, u1 = cruise - v1;
    return cruise * T - 0.5 * (u0 * least_time(law, u0) + u1 * least_time(law, u1));
}

static double fastest_cruise(const Law *law, double v0, double v1, double T)
{
    return fmin(fmax(v0, v1) + rise(law, fabs(v1 - v0), T), law->max_velocity);
}

double largest_displacement(const Law *law, double v0, double v1, double T)
{
    return displacement(law, fastest_cruise(law, v0, v1, T), v0, v1, T);
}

/* A shortest transition, which changes the velocity by u; see `derivatives` in
 * transitions/largest_displacement.py. */
typedef struct {
    double t;  /* its duration t(u) [s] */
    double m;  /* d(u t / 2) / du = m t: 1 where acceleration limits it, 3 / 4 where jerk does */
    double i;  /* du / dt, by how much u rises with the duration: 1 / t'(u) [rad/s^2] */
    double k;  /* d2u / dt2, likewise: i di / du [rad/s^3] */
} Transition;

static Transition transition(const Law *law, double u)
{
    const double by_acceleration = law->slope * u, by_jerk = law->root * sqrt(u);
    const Transition jerk_limited = {by_jerk, 0.75, 2.0 * u / by_jerk,
                                     2.0 / (law->root * law->root)};
    const Transition acceleration_limited = {by_acceleration, 1.0, 1.0 / law->slope, 0.0};
    return by_jerk > by_acceleration ? jerk_limited : acceleration_limited;
}

/* The cruise c follows from t(c - v0) + t(c - v1) = T, or is the velocity limit; its derivatives
 * by v0, v1 and T, and the displacement's by c, give the others by the chain rule. */
DisplacementDerivatives displacement_derivatives(const Law *law, double v0, double v1, double T)
{
    const double free = fmax(v0, v1) + rise(law, fabs(v1 - v0), T);
    const int capped = free >= law->max_velocity;
    const double cruise = capped ? law->max_velocity : free;
    const double u0 = cruise - v0, u1 = cruise - v1;
    const Transition a = transition(law, u0), b = transition(law, u1);
    const double q = capped ? 0.0 : 1.0 / (a.i + b.i), q3 = q * q * q;
    /* d below: the partial derivative by the motion's v0, v1 or T; dx / dc = by_cruise */
    const double own0 = capped ? a.m / a.i : a.m * q;  /* -d(m0 t0) / dv0 */
    const double own1 = capped ? b.m / b.i : b.m * q;  /* -d(m1 t1) / dv1 */
    const double c_v0 = b.i * q, c_v1 = a.i * q, c_T = c_v0 * a.i;  /* dc / dv0, dv1, dT */
    const double by_cruise = capped ? 0.0 : T - a.m * a.t - b.m * b.t;
    /* by_cruise d(dc / dv0) / dv0, and by_cruise d(dc / dv0) / dT: */
    const double skew = by_cruise * q3 * (a.i * b.k + b.i * a.k);
    const double skew_T = by_cruise * q3 * (a.i * a.i * b.k - b.i * b.i * a.k);
    const double more = (a.m - b.m) * q;  /* d by_cruise / dv0 = -d by_cruise / dv1 */
    const double with_T = 1.0 - a.m * c_v0 - b.m * c_v1;  /* d by_cruise / dT */
    const double one_two = a.m * q - more * c_v0 - skew;  /* d2x / (dv0 dv1) */
    const double one_T = (a.m + with_T) * c_v0 + skew_T;  /* d2x / (dv0 dT) */
    const double two_T = (b.m + with_T) * c_v1 - skew_T;  /* d2x / (dv1 dT) */
    const DisplacementDerivatives found = {
        cruise * T - 0.5 * (u0 * a.t + u1 * b.t),
        {a.m * a.t + by_cruise * c_v0, b.m * b.t + by_cruise * c_v1, cruise + by_cruise * c_T},
        {{-own0 + more * c_v0 + skew, one_two, one_T},
         {one_two, -own1 - more * c_v1 + skew, two_T},
         {one_T, two_T, c_T * (1.0 + with_T)
              + by_cruise * q3 * (b.i * b.i * b.i * a.k + a.i * a.i * a.i * b.k)}}};
    return found;
}

/* `_evaluated` of transitions/largest_displacement.py, for count cases of three joints each. */
EXPORTED void largest_displacement_at(int32_t count, const double *slope, const double *root,
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
        const DisplacementDerivatives at = displacement_derivatives(&law, v0[i], v1[i], T[i]);
        memcpy(gradient[i], at.gradient, sizeof at.gradient);
        memcpy(hessian[i], at.hessian, sizeof at.hessian);
    }
}

/* The least cruise velocities between lowest and cruise with which shortest transitions cover the
 * displacements D in durations T (count), by bisection; they replace the upper bounds in cruise.
 */
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
