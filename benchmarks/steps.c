/* Copyright 2026 the dynsim_ros authors
 * SPDX-License-Identifier: Apache-2.0
 *
 * Euler, semi-implicit Euler and RK4 for one sphere on one spring-damper in air, in plain C: the
 * formulas of dynsim_ros/physics and dynsim_ros/integrators in the same order, without the works.
 *
 * State y: position (3), velocity (3), quaternion w x y z (4), angular velocity (3); world, SI.
 */
#include <math.h>

typedef struct { double x, y, z; } vec;
typedef struct { double w, x, y, z; } quat;
typedef struct { vec r, v; quat q; vec omega; } state;
typedef struct {
  double mass, inertia, stiffness, natural_length, epsilon, damping, linear_drag, rotational_drag;
  vec weight, anchor, offset, wind, whirl;
} scene;

static inline vec add(vec a, vec b) { return (vec){a.x + b.x, a.y + b.y, a.z + b.z}; }
static inline vec sub(vec a, vec b) { return (vec){a.x - b.x, a.y - b.y, a.z - b.z}; }
static inline vec scale(double s, vec a) { return (vec){s * a.x, s * a.y, s * a.z}; }
static inline double dot(vec a, vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline vec cross(vec a, vec b)
{
  return (vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline vec rotate(quat q, vec a)
{
  vec u = {q.x, q.y, q.z}, c = cross(u, a), d = cross(u, c);
  return (vec){a.x + 2 * (q.w * c.x + d.x), a.y + 2 * (q.w * c.y + d.y),
               a.z + 2 * (q.w * c.z + d.z)};
}

static inline quat quaternion_rate_world(quat q, vec o)
{
  return (quat){0.5 * (-q.x * o.x - q.y * o.y - q.z * o.z),
                0.5 * (q.w * o.x + q.z * o.y - q.y * o.z),
                0.5 * (-q.z * o.x + q.w * o.y + q.x * o.z),
                0.5 * (q.y * o.x - q.x * o.y + q.w * o.z)};
}

static inline quat normalised(quat q)
{
  double n = sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return (quat){q.w / n, q.x / n, q.y / n, q.z / n};
}

/* Linear and angular acceleration. */
static inline void accelerations(const scene *s, const state *y, vec *a, vec *alpha)
{
  vec arm = rotate(y->q, s->offset);
  vec d = sub(add(y->r, arm), s->anchor);
  double square = dot(d, d), length = sqrt(square);
  vec u = scale(length * (1 / (square + s->epsilon * s->epsilon)), d);
  vec force = scale(-s->stiffness * (length - s->natural_length), u);
  double rate = dot(add(y->v, cross(y->omega, arm)), u);
  force = add(force, scale(-s->damping * rate, u));
  vec total = add(add(s->weight, force), scale(-s->linear_drag, sub(y->v, s->wind)));
  vec moment = add(cross(arm, force), scale(-s->rotational_drag, sub(y->omega, s->whirl)));
  *a = scale(1 / s->mass, total);
  *alpha = scale(1 / s->inertia, moment);
}

void explicit_euler(const scene *given, double h, long steps, state *out)
{
  const scene s = *given;
  state y = *out;
  for (long k = 0; k < steps; ++k) {
    vec a, alpha, b = y.omega;
    quat q = y.q;
    accelerations(&s, &y, &a, &alpha);
    /* The matrix H takes the angular velocity in body axes: the transpose of the rotation. */
    vec o = {(1 - 2 * (q.y * q.y + q.z * q.z)) * b.x + 2 * (q.x * q.y + q.w * q.z) * b.y
               + 2 * (q.x * q.z - q.w * q.y) * b.z,
             2 * (q.x * q.y - q.w * q.z) * b.x + (1 - 2 * (q.x * q.x + q.z * q.z)) * b.y
               + 2 * (q.y * q.z + q.w * q.x) * b.z,
             2 * (q.x * q.z + q.w * q.y) * b.x + 2 * (q.y * q.z - q.w * q.x) * b.y
               + (1 - 2 * (q.x * q.x + q.y * q.y)) * b.z};
    quat rate = {0.5 * (-q.x * o.x - q.y * o.y - q.z * o.z),
                 0.5 * (q.w * o.x - q.z * o.y + q.y * o.z),
                 0.5 * (q.z * o.x + q.w * o.y - q.x * o.z),
                 0.5 * (-q.y * o.x + q.x * o.y + q.w * o.z)};
    y.q = normalised((quat){q.w + h * rate.w, q.x + h * rate.x, q.y + h * rate.y,
                            q.z + h * rate.z});
    y.r = add(y.r, scale(h, y.v));
    y.v = add(y.v, scale(h, a));
    y.omega = add(y.omega, scale(h, alpha));
  }
  *out = y;
}

void semi_implicit_euler(const scene *given, double h, long steps, state *out)
{
  const scene s = *given;
  state y = *out;
  for (long k = 0; k < steps; ++k) {
    vec a, alpha;
    accelerations(&s, &y, &a, &alpha);
    y.v = add(y.v, scale(h, a));
    y.omega = add(y.omega, scale(h, alpha));
    y.r = add(y.r, scale(h, y.v));
    vec turn = scale(h, y.omega);
    double angle = sqrt(dot(turn, turn));
    double part = angle > 1e-4 ? sin(0.5 * angle) / angle : 0.5 - angle * angle / 48;
    double w = cos(0.5 * angle);
    vec u = scale(part, turn), v = {y.q.x, y.q.y, y.q.z}, c = cross(u, v);
    y.q = normalised((quat){w * y.q.w - dot(u, v), w * v.x + y.q.w * u.x + c.x,
                            w * v.y + y.q.w * u.y + c.y, w * v.z + y.q.w * u.z + c.z});
  }
  *out = y;
}

static inline state rates(const scene *s, const state *y)
{
  state k;
  k.r = y->v;
  k.q = quaternion_rate_world(y->q, y->omega);
  accelerations(s, y, &k.v, &k.omega);
  return k;
}

static inline quat add_scaled_quat(quat a, double s, quat b)
{
  return (quat){a.w + s * b.w, a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline state add_scaled(const state *y, double s, const state *k)
{
  return (state){add(y->r, scale(s, k->r)), add(y->v, scale(s, k->v)),
                 add_scaled_quat(y->q, s, k->q), add(y->omega, scale(s, k->omega))};
}

void rk4(const scene *given, double h, long steps, state *out)
{
  static const double ahead[] = {0.5, 0.5, 1.0, 1.0};
  static const double weight[] = {1.0 / 6, 2.0 / 6, 2.0 / 6, 1.0 / 6};
  const scene s = *given;
  state y = *out;
  for (long n = 0; n < steps; ++n) {
    state at_stage = y, step = {0};
    for (int stage = 0; stage < 4; ++stage) {
      state k = rates(&s, &at_stage);
      step = add_scaled(&step, weight[stage], &k);
      at_stage = add_scaled(&y, ahead[stage] * h, &k);
    }
    y = add_scaled(&y, h, &step);
    y.q = normalised(y.q);
  }
  *out = y;
}
