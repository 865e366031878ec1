/* Copyright 2026 the dynsim_ros authors
 * SPDX-License-Identifier: Apache-2.0
 *
 * Gragg-Bulirsch-Stoer extrapolation of order 24 with a fixed step, in 113-bit arithmetic.
 *
 * Usage: extrapolation TIME STEPS SAMPLES < STATE
 * Reads the state at time 0 (hexadecimal floats, one a line); takes STEPS steps to TIME for each of
 * SAMPLES intervals of equal length; writes the state at the end of each, with 36 digits.
 * SIZE and rates(t, y, out) come from the file that is compiled with this one.
 */
#include <quadmath.h>
#include <stdio.h>
#include <stdlib.h>

#include "rates.h"

#define COLUMNS 12
typedef __float128 real;

/* The modified midpoint rule: `count` sub-steps over h, smoothed at the end by nothing: for even
 * counts its error has even powers of h alone. */
static void midpoint(real t, real h, int count, const real *y, real *out)
{
  real before[SIZE], now[SIZE], rate[SIZE], sub = h / count;
  rates(t, y, rate);
  for (int i = 0; i < SIZE; ++i) {
    before[i] = y[i];
    now[i] = y[i] + sub * rate[i];
  }
  for (int k = 1; k < count; ++k) {
    rates(t + k * sub, now, rate);
    for (int i = 0; i < SIZE; ++i) {
      real next = before[i] + 2 * sub * rate[i];
      before[i] = now[i];
      now[i] = next;
    }
  }
  for (int i = 0; i < SIZE; ++i) out[i] = now[i];
}

static void step(real t, real h, real *y)
{
  real table[COLUMNS][SIZE];
  for (int j = 0; j < COLUMNS; ++j) {
    midpoint(t, h, 2 * (j + 1), y, table[j]);
    for (int k = j - 1; k >= 0; --k) {
      real ratio = (real)(j + 1) / (k + 1);
      real weight = 1 / (ratio * ratio - 1);
      for (int i = 0; i < SIZE; ++i) table[k][i] = table[k + 1][i] + weight * (table[k + 1][i] - table[k][i]);
    }
  }
  for (int i = 0; i < SIZE; ++i) y[i] = table[0][i];
}

int main(int argc, char **argv)
{
  char text[64];
  real y[SIZE], time = strtoflt128(argv[1], 0), t;
  long steps = atol(argv[2]), samples = atol(argv[3]);
  if (argc != 4) return 2;
  for (int i = 0; i < SIZE; ++i) {
    if (scanf("%63s", text) != 1) return 2;
    y[i] = strtoflt128(text, 0);
  }
  for (long k = 0; k < samples * steps; ++k) {
    t = time * k / (samples * steps);
    step(t, time / (samples * steps), y);
    if ((k + 1) % steps == 0) {
      for (int i = 0; i < SIZE; ++i) {
        quadmath_snprintf(text, sizeof text, "%.36Qg", y[i]);
        printf("%s ", text);
      }
      printf("\n");
    }
  }
  return 0;
}
