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

/* Functions for processors with vector instructions. */
#ifndef RRR_TRAJ_PLANNER_PROCESSOR_H
#define RRR_TRAJ_PLANNER_PROCESSOR_H

#include <stdint.h>  /* defines __GLIBC__ where that is the C library */

enum { VECTOR = 4 };  /* doubles that a processor adds at once, with AVX2 */

/* Functions that are compiled for processors with AVX2 too, of which one is chosen when the
 * library is loaded; they round alike. What they call is compiled with them. */
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__)
#define BY_PROCESSOR __attribute__((target_clones("avx2", "default")))
#else
#define BY_PROCESSOR
#endif
#define INLINE static inline __attribute__((always_inline))

/* So many doubles, which need not be aligned in memory. */
typedef double Lanes __attribute__((vector_size(VECTOR * sizeof(double)), aligned(8)));
typedef int64_t LaneFlags __attribute__((vector_size(VECTOR * sizeof(int64_t)), aligned(8)));

/* Of each lane the larger number; b where a is none. */
INLINE Lanes larger(Lanes a, Lanes b)
{
    const LaneFlags is_more = a > b;
    return (Lanes)((is_more & (LaneFlags)a) | (~is_more & (LaneFlags)b));
}

#endif
