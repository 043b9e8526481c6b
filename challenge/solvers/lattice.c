/* The lattice of the onset challenge in C99: plain loops over blocks, no library.
 *
 *     cc -O2 -o lattice lattice.c -lm
 *     ./lattice SERIES SLIPS EVENTS < problem.txt
 *
 * lattice_c.py beside this file writes problem.txt, whose order is that of `read_problem`, and makes answers of the three
 * tables: drive force over time, first slips by block, events.
 *
 * Every block gathers the forces of its eight springs. Friction takes from the velocity that a block would have without it
 * what its impulse can (scheme 0), or acts explicitly against the velocity, and a block whose velocity turns round within the
 * static threshold sticks (scheme 1): two readings of one law that differ by the order of the step where blocks stop. */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum law { COULOMB, SLIP_WEAKENING, VELOCITY_WEAKENING, RATE_AND_STATE };

struct block {
    double exists, contact, springs, g[2], prestress, fs, fk; /* given */
    double u[2], v[2], force[2], slip, theta;                  /* state */
    double first_slip, u_begun[2];
};

struct problem {
    int nx, ny, periodic[2], law, vector, held, scheme, corners;
    double k1, k2, viscosity, damping, dt, until, until_events;
    double weakening[8]; /* numbers of the law */
    double *time, *reach; /* corners of the path */
    struct block *blocks;
};

static double number(void)
{
    double x;
    if (scanf("%lf", &x) != 1) {
        fprintf(stderr, "lattice: the problem ends early\n");
        exit(2);
    }
    return x;
}

static void *room(size_t count, size_t size)
{
    void *array = calloc(count, size);
    if (!array) {
        perror("lattice");
        exit(2);
    }
    return array;
}

static struct problem read_problem(void)
{
    struct problem p;
    p.nx = (int)number(), p.ny = (int)number();
    p.periodic[0] = (int)number(), p.periodic[1] = (int)number();
    p.k1 = number(), p.k2 = number(), p.viscosity = number(), p.damping = number();
    p.dt = number(), p.until = number(), p.until_events = number();
    p.law = (int)number(), p.vector = (int)number(), p.held = (int)number(), p.scheme = (int)number();
    for (int i = 0; i < 8; i++)
        p.weakening[i] = number();
    p.corners = (int)number();
    p.time = room(p.corners, sizeof(double)), p.reach = room(p.corners, sizeof(double));
    for (int i = 0; i < p.corners; i++)
        p.time[i] = number(), p.reach[i] = number();
    p.blocks = room((size_t)p.nx * p.ny, sizeof(struct block));
    for (int b = 0; b < p.nx * p.ny; b++) {
        struct block *block = &p.blocks[b];
        block->exists = number(), block->contact = number(), block->springs = number();
        block->g[0] = number(), block->g[1] = number(), block->prestress = number();
        block->fs = number(), block->fk = number();
        block->first_slip = -1;
        block->theta = p.weakening[5];
    }
    return p;
}

/* Path of the far ends of the drive springs. */
static double path(const struct problem *p, double t)
{
    int i = 1;
    while (i < p->corners - 1 && t >= p->time[i])
        i++;
    return p->reach[i - 1] + (p->reach[i] - p->reach[i - 1]) * ((t - p->time[i - 1]) / (p->time[i] - p->time[i - 1]));
}

/* Springs and dampers between block (i, j) and its neighbours, for small displacements. */
static void add_lattice_force(const struct problem *p, int i, int j)
{
    struct block *here = &p->blocks[j * p->nx + i];
    for (int dj = -1; dj <= 1; dj++)
        for (int di = -1; di <= 1; di++) {
            int ni = i + di, nj = j + dj;
            if (p->periodic[0])
                ni = (ni + p->nx) % p->nx;
            if (p->periodic[1])
                nj = (nj + p->ny) % p->ny;
            if ((!di && !dj) || ni < 0 || nj < 0 || ni >= p->nx || nj >= p->ny)
                continue;
            const struct block *there = &p->blocks[nj * p->nx + ni];
            if (!there->exists)
                continue;
            double wx = there->u[0] - here->u[0] + p->viscosity * (there->v[0] - here->v[0]);
            double wy = there->u[1] - here->u[1] + p->viscosity * (there->v[1] - here->v[1]);
            if (di && dj) {
                double tension = 0.5 * p->k2 * (di * wx + dj * wy);
                here->force[0] += di * tension;
                here->force[1] += dj * tension;
            } else if (di) {
                here->force[0] += p->k1 * wx;
            } else {
                here->force[1] += p->k1 * wy;
            }
        }
}

/* Speed v with v + most asinh(v state) = free, by bisection to the last bit. */
static double speed_under(double free, double most, double state)
{
    double low = 0, high = free;
    for (;;) {
        double middle = 0.5 * (low + high);
        if (middle <= low || middle >= high)
            return high;
        if (middle + most * asinh(middle * state) < free)
            low = middle;
        else
            high = middle;
    }
}

/* Velocity half a step later; answers whether the block slides. */
static int advance(const struct problem *p, struct block *b)
{
    const double before = (1 - 0.5 * p->damping * p->dt) / (1 + 0.5 * p->damping * p->dt);
    const double impulse = p->dt / (1 + 0.5 * p->damping * p->dt);
    const double was[2] = {b->v[0], b->v[1]};
    double free[2] = {before * was[0] + impulse * b->force[0], before * was[1] + impulse * b->force[1]};
    const int axes = p->vector ? 2 : 1;
    if (!b->contact) {
        b->v[0] = free[0], b->v[1] = free[1];
        return 0;
    }
    double speed = axes == 2 ? hypot(was[0], was[1]) : fabs(was[0]);
    double pull = axes == 2 ? hypot(b->force[0], b->force[1]) : fabs(b->force[0]);
    double most = axes == 2 ? hypot(free[0], free[1]) : fabs(free[0]);
    double holds = b->fs, slows = b->fk, keep;
    if (p->law == RATE_AND_STATE) {
        /* a, b, D_c, V_0, mu_0, theta_0, slip speed; the normal force stands in fs. */
        const double *w = p->weakening;
        double state = exp((w[4] + w[1] * log(w[3] * b->theta / w[2])) / w[0]) / (2 * w[3]);
        double v = speed_under(most, impulse * b->fs * w[0], state), x = v * p->dt / w[2];
        b->v[0] = most > 0 ? v * free[0] / most : 0;
        b->theta = b->theta * exp(-x) + p->dt * (x > 0 ? -expm1(-x) / x : 1);
        return v > w[6];
    }
    if (p->law == SLIP_WEAKENING)
        holds = slows = b->fk + (b->fs - b->fk) * fmax(0, 1 - b->slip / p->weakening[0]);
    if (p->law == VELOCITY_WEAKENING)
        slows = b->fk * (p->weakening[1] + (1 - p->weakening[1]) / (1 + speed / p->weakening[0]));
    if (speed == 0 && pull <= holds) {
        keep = 0;
    } else if (p->scheme == 0 || speed == 0) {
        keep = most <= impulse * slows ? 0 : 1 - impulse * slows / most;
    } else {
        for (int a = 0; a < axes; a++)
            free[a] -= impulse * slows * was[a] / speed;
        double along = free[0] * was[0] + (axes == 2 ? free[1] * was[1] : 0);
        keep = along <= 0 && pull <= holds ? 0 : 1;
    }
    b->v[0] = keep * free[0];
    b->v[1] = axes == 2 ? keep * free[1] : free[1];
    speed = axes == 2 ? hypot(b->v[0], b->v[1]) : fabs(b->v[0]);
    b->slip += p->dt * speed;
    return speed != 0;
}

static FILE *opened(const char *name)
{
    FILE *file = fopen(name, "w");
    if (!file) {
        perror(name);
        exit(2);
    }
    return file;
}

int main(int argc, char **argv)
{
    if (argc != 4) {
        fprintf(stderr, "usage: lattice SERIES SLIPS EVENTS < problem.txt\n");
        return 2;
    }
    struct problem p = read_problem();
    const int blocks = p.nx * p.ny;
    FILE *series = opened(argv[1]), *slips = opened(argv[2]), *events = opened(argv[3]);
    double weight = 0, begun = -1, force_begun = 0, peak = 0, found = 0;
    long drive_steps = 0;
    for (int b = 0; b < blocks; b++)
        weight += hypot(p.blocks[b].g[0], p.blocks[b].g[1]);
    const long stop = lround(p.until / p.dt);
    for (long n = 0; (p.until < 0 || n <= stop) && (p.until_events < 0 || found < p.until_events); n++) {
        const double t = n * p.dt, reach = path(&p, drive_steps * p.dt);
        double pull = 0;
        for (int b = 0; b < blocks; b++) {
            struct block *block = &p.blocks[b];
            for (int a = 0; a < 2; a++) {
                block->force[a] = block->springs * (reach * block->g[a] - block->u[a]) + block->prestress * block->g[a];
                pull += block->g[a] * block->force[a];
            }
        }
        pull /= weight;
        for (int j = 0; j < p.ny; j++)
            for (int i = 0; i < p.nx; i++)
                if (p.blocks[j * p.nx + i].exists)
                    add_lattice_force(&p, i, j);
        int moves = 0;
        /* Velocities change here and are read by dampers above, so that all forces come first. */
        for (int b = 0; b < blocks; b++) {
            struct block *block = &p.blocks[b];
            if (!block->exists || !advance(&p, block))
                continue;
            moves = 1;
            if (block->first_slip < 0)
                block->first_slip = t;
        }
        if (moves && begun < 0) {
            begun = t, force_begun = pull;
            for (int b = 0; b < blocks; b++)
                p.blocks[b].u_begun[0] = p.blocks[b].u[0], p.blocks[b].u_begun[1] = p.blocks[b].u[1];
        } else if (!moves && begun >= 0) {
            double moment = 0;
            int moved = 0;
            for (int b = 0; b < blocks; b++) {
                const struct block *block = &p.blocks[b];
                double x = block->u[0] - block->u_begun[0], y = block->u[1] - block->u_begun[1];
                if (!block->contact)
                    continue;
                moved += x != 0 || y != 0;
                moment += block->g[0] * x + block->g[1] * y;
            }
            fprintf(events, "%.17g,%.17g,%d,%.17g,%.17g,%.17g,%.17g\n", begun, t, moved, moment, force_begun, pull, peak);
            begun = -1, peak = 0, found++;
        }
        if (p.until >= 0)
            fprintf(series, "%.17g,%.17g\n", t, pull);
        drive_steps += !(p.held && moves);
        for (int b = 0; b < blocks; b++) {
            struct block *block = &p.blocks[b];
            block->u[0] += p.dt * block->v[0];
            block->u[1] += p.dt * block->v[1];
            if (moves)
                peak = fmax(peak, hypot(block->v[0], block->v[1]));
        }
    }
    for (int b = 0; b < blocks; b++)
        fprintf(slips, "%.17g%c", p.blocks[b].first_slip < 0 ? NAN : p.blocks[b].first_slip, (b + 1) % p.nx ? ',' : '\n');
    return fclose(series) | fclose(slips) | fclose(events) ? 1 : 0;
}
