/* The slider of docs/model.md in plain C: one thread, one array per quantity, no library.
 *
 *     gcc -O3 -march=native -o lattice lattice.c -lm
 *     ./lattice SIZE MU_STATIC.f64 MU_KINETIC.f64 STEPS
 *
 * The files hold one double per block, row by row from y = 0. Prints mu_s*, the step of the peak and nanoseconds per
 * block and step of the loop alone. */

#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

/* The baseline: Fig. 3 of the paper, in scaled units. */
static const double V_STAR = 0.03, EPSILON = 1e-6, DT = 0.1;
static const double K_STRAIGHT = 0.75, K_DIAGONAL = 0.375, K_DRIVE = 0.375;

struct slider {
    int nx, ny;
    double *hold, *slide;        /* thresholds: static and kinetic friction of every block */
    double *ux, *uy, *vx, *vy;   /* displacements at t, velocities half a step before */
    double *fx, *fy;             /* force of drive and springs */
    double *row_x, *row_y;       /* forces of one row of springs */
};

static double *numbers(int count)
{
    double *array = calloc(count, sizeof *array);
    if (!array) {
        perror("lattice");
        exit(2);
    }
    return array;
}

static double *numbers_from(const char *path, int count)
{
    double *array = numbers(count);
    FILE *file = fopen(path, "rb");
    if (!file || fread(array, sizeof *array, count, file) != (size_t)count) {
        fprintf(stderr, "%s does not hold %d numbers\n", path, count);
        exit(2);
    }
    fclose(file);
    return array;
}

/* Eq. 2: the springs that drive the blocks. */
static void drive(struct slider *s, double reach)
{
    for (int b = 0; b < s->nx * s->ny; b++) {
        s->fx[b] = K_DRIVE * (reach - s->ux[b]);
        s->fy[b] = -K_DRIVE * s->uy[b];
    }
}

/* Eq. 3: the springs from every block to the one di columns and dj rows on, exact at any strain. The forces of a row
 * are kept apart until they are added: a loop that wrote to two places at once would not be vectorised. */
static void springs(struct slider *s, int di, int dj, double k)
{
    const int nx = s->nx, shift = dj * nx + di;
    const int first = di < 0 ? 1 : 0, last = di > 0 ? nx - 1 : nx;
    const double d = sqrt(di * di + dj * dj);
    double *restrict gx = s->row_x, *restrict gy = s->row_y;
    for (int j = 0; j < s->ny - dj; j++) {
        const double *ux = s->ux + j * nx, *uy = s->uy + j * nx;
        double *fx = s->fx + j * nx, *fy = s->fy + j * nx;
        for (int i = first; i < last; i++) {
            double ex = ux[i + shift] - ux[i], ey = uy[i + shift] - uy[i];
            double rx = di + EPSILON * ex, ry = dj + EPSILON * ey;
            double r = sqrt(rx * rx + ry * ry);
            double tension = k * (2 * (di * ex + dj * ey) + EPSILON * (ex * ex + ey * ey)) / (r * (r + d));
            gx[i] = tension * rx;
            gy[i] = tension * ry;
        }
        for (int i = first; i < last; i++) {
            fx[i] += gx[i];
            fy[i] += gy[i];
        }
        for (int i = first; i < last; i++) {
            fx[i + shift] -= gx[i];
            fy[i + shift] -= gy[i];
        }
    }
}

/* Eqs. 4 to 8: friction with memory (a block is stuck if and only if its velocity is zero), damping, and the step. */
static void advance(struct slider *s, double damping)
{
    const double before = (1 - 0.5 * damping * DT) / (1 + 0.5 * damping * DT);
    const double impulse = DT / (1 + 0.5 * damping * DT);
    double *restrict ux = s->ux, *restrict uy = s->uy, *restrict vx = s->vx, *restrict vy = s->vy;
    const double *restrict fx = s->fx, *restrict fy = s->fy, *restrict hold = s->hold, *restrict slide = s->slide;
    for (int b = 0; b < s->nx * s->ny; b++) {
        bool stuck = vx[b] == 0 && vy[b] == 0;
        if (stuck && fx[b] * fx[b] + fy[b] * fy[b] <= hold[b] * hold[b])
            continue;
        double free_x = before * vx[b] + impulse * fx[b], free_y = before * vy[b] + impulse * fy[b];
        double speed = sqrt(free_x * free_x + free_y * free_y), q = impulse * slide[b];
        double keep = speed <= q ? 0 : 1 - q / speed;
        vx[b] = keep * free_x;
        vy[b] = keep * free_y;
        ux[b] += DT * vx[b];
        uy[b] += DT * vy[b];
    }
}

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

int main(int argc, char **argv)
{
    if (argc != 5) {
        fprintf(stderr, "usage: lattice SIZE MU_STATIC.f64 MU_KINETIC.f64 STEPS\n");
        return 2;
    }
    const int size = atoi(argv[1]), n = size * size;
    const long steps = atol(argv[4]);
    struct slider s = {
        .nx = size, .ny = size, .hold = numbers_from(argv[2], n), .slide = numbers_from(argv[3], n),
        .ux = numbers(n), .uy = numbers(n), .vx = numbers(n), .vy = numbers(n),
        .fx = numbers(n), .fy = numbers(n), .row_x = numbers(size), .row_y = numbers(size),
    };
    const double damping = 0.1 * sqrt(K_STRAIGHT);
    double level = damping * V_STAR;
    for (int b = 0; b < n; b++)
        level += s.slide[b] / n;

    /* mu_s*: the first peak of mu* that is followed by a fall of at least half-way to the steady level. */
    double peak = -INFINITY;
    long peak_step = 0;
    bool ended = false;
    const double began = seconds();
    for (long step = 0; step < steps; step++) {
        const double reach = V_STAR * (step * DT);
        double sum = 0;
        for (int b = 0; b < n; b++)
            sum += s.ux[b];
        const double mu = K_DRIVE * (reach - sum / n);
        if (!ended && mu > peak) {
            peak = mu;
            peak_step = step;
        } else if (!ended && peak > level) {
            ended = mu <= 0.5 * (peak + level);
        }
        drive(&s, reach);
        springs(&s, 1, 0, K_STRAIGHT);
        springs(&s, 0, 1, K_STRAIGHT);
        springs(&s, 1, 1, K_DIAGONAL);
        springs(&s, -1, 1, K_DIAGONAL);
        advance(&s, damping);
    }
    const double nanoseconds = 1e9 * (seconds() - began);

    if (!ended) {
        fprintf(stderr, "no transition within %ld steps\n", steps);
        return 1;
    }
    printf("%.17g %ld %.4f\n", peak, peak_step, nanoseconds / ((double)n * steps));
    return 0;
}
