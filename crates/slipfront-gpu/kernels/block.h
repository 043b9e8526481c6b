// One block through a step: Eqs. 2 to 7, with the operations of kernel/fused/springs.rs and blocks.rs in
// crates/slipfront/src, in their order.
#pragma once
#include "step.h"

struct Vec2 {
    double x, y;
};
FN Vec2 operator+(Vec2 a, Vec2 b) { Vec2 c = {a.x + b.x, a.y + b.y}; return c; }
FN Vec2 operator-(Vec2 a, Vec2 b) { Vec2 c = {a.x - b.x, a.y - b.y}; return c; }
FN Vec2 operator*(double f, Vec2 a) { Vec2 c = {f * a.x, f * a.y}; return c; }
FN double square(Vec2 a) { return a.x * a.x + a.y * a.y; }
FN double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }

// Flags of a block: crates/slipfront/src/device.rs. The lowest bits are springs that exist.
enum Spring { EAST, NORTH, NORTH_EAST, NORTH_WEST, WEST, SOUTH, SOUTH_WEST, SOUTH_EAST };
static const u32 EXISTS = 1 << 8, IN_CONTACT = 1 << 9;
static const u32 FIRST_COLUMN = 1 << 10, LAST_COLUMN = 1 << 11, FIRST_ROW = 1 << 12, LAST_ROW = 1 << 13;

// tension d + correction for a component d of the rest vector.
template <int D> FN double along_axis(double tension, double correction) {
    return D == 0 ? correction : D == 1 ? tension + correction : correction - tension;
}

// Force of the spring along (DX, DY) on a block, from the displacement of the neighbour less its own (Eq. 3).
template <Springs SPRINGS, int DX, int DY> FN Vec2 spring(const Equations& q, Vec2 e) {
    const int diagonal = DX * DY != 0;
    if (SPRINGS == SQUARE_ROOT) {
        const double dx = DX, dy = DY, rest_length = diagonal ? 1.41421356237309504880 : 1.0;
        Vec2 r = {dx + q.epsilon * e.x, dy + q.epsilon * e.y};
        double length = sqrt(square(r));
        double along = dx * e.x + dy * e.y;
        double stretch = 2.0 * along + q.epsilon * square(e);
        double tension = q.stiffness[diagonal] * stretch / (length * (length + rest_length));
        return tension * r;
    }
    const int degree = SPRINGS == SHORT_SERIES ? 3 : 7;
    const double* c = q.series[diagonal];
    double along = DY == 0 ? e.x : DX == 0 ? e.y : DX == 1 ? e.x + e.y : e.y - e.x;
    double s = (along + along) + q.epsilon * square(e);
    double tension = c[degree];
#pragma unroll
    for (int m = degree - 1; m >= 0; m--) tension = tension * s + c[m];
    tension = tension * s;
    double per_displacement = q.epsilon * tension;
    Vec2 f = {along_axis<DX>(tension, per_displacement * e.x), along_axis<DY>(tension, per_displacement * e.y)};
    return f;
}

FN Vec2 if_present(u32 flags, int spring, Vec2 force) {
    Vec2 none = {0.0, 0.0};
    return flags >> spring & 1 ? force : none;
}

// Displacements of a block and of its eight neighbours; what has the place of one that does not exist is masked.
struct Around {
    Vec2 here, neighbours[8];
};

// Sums of a thread over its blocks; those of a warp have at most 2^11 terms, which one word holds.
struct Sums {
    i64 displacement[2], velocity[2], motion_square, friction_work;
    i64 velocity_squares, displacement_square, lattice_energy;
    // Sliding blocks, and 2^16 times those of them in contact.
    i64 counts;
    double stress_square, speed_square;
};

FN Sums no_sums() {
    Sums s = {{0, 0}, {0, 0}, 0, 0, 0, 0, 0, 0, 0.0, 0.0};
    return s;
}

FN bool heals(const Equations& q) { return q.healing_time < of_bits(0x7ff0000000000000LL); }

// 0 if the share is NaN, which is 0 times an infinite inverse, as from f64::max of Rust.
FN double share_left(const Equations& q, double slip) { return larger(0.0, 1.0 - slip * q.inverse_fall_length); }

// Energy that weakening has dissipated in block b of n: friction/coulomb/slip_weakening.rs in crates/slipfront/src.
FN double weakening_energy_of(const Equations& q, const double* memory, size_t n, size_t b) {
    double left = share_left(q, memory[2 * n + b]), lost_before = heals(q) ? memory[4 * n + b] : 0.0;
    return 0.5 * memory[n + b] * q.fall_length * (lost_before + (1.0 - left * left));
}

// Kinetic impulse of block b of n at its present slip, with the velocity of the step that ends now:
// kernel/fused/thresholds.rs in crates/slipfront/src.
FN double impulse_after_slip(const Equations& q, u64 step, Vec2 velocity, double* memory, size_t n, size_t b) {
    double slip = memory[2 * n + b] + (step == 0 ? 0.0 : q.dt) * sqrt(square(velocity));
    double left = share_left(q, slip);
    if (heals(q)) {
        bool is_stuck = velocity.x == 0.0 && velocity.y == 0.0;
        double now = (double)step * q.dt;
        if (!is_stuck) {
            memory[3 * n + b] = now;
        } else if (now - memory[3 * n + b] >= q.healing_time) {
            memory[4 * n + b] += 1.0 - left * left;
            slip = 0.0;
            left = 1.0;
        }
    }
    memory[2 * n + b] = slip;
    return memory[b] + q.force_to_velocity * memory[n + b] * left;
}

struct Moved {
    Vec2 velocity;
    bool slips;
};

FN bool counts_at(const Lattice& l, u64 step) { return l.counted_every > 0 && step % l.counted_every == 0; }

// Counts block b if it slides in contact, at a step at which blocks are counted, with its velocity half a step later.
// Counts are integers, so that their order does not matter.
FN void count_block(const Arrays& arrays, const Lattice& l, u64 step, u32 flags, Vec2 velocity, size_t b) {
    if (!(flags & IN_CONTACT) || (velocity.x == 0.0 && velocity.y == 0.0)) return;
    u64 before = (l.first_step + l.counted_every - 1) / l.counted_every;
    u64 row = step / l.counted_every - before;
    atomicAdd(&arrays.counts[l.first_count + row * l.bins + arrays.bins[l.first_bin + b]], 1u);
}

FN double or_zero_below(double least, double x) { return fabs(x) < least ? 0.0 * x : x; }

// limit_square: square of the static threshold; impulse: change of velocity by kinetic friction.
template <Springs SPRINGS, bool ENERGY>
FN Moved step_block(const Equations& q, const Step& s, const Around& a, u32 flags, Vec2 before, double limit_square,
                    double impulse, Sums& sums) {
    Vec2 u = a.here;
    Vec2 east = if_present(flags, EAST, spring<SPRINGS, 1, 0>(q, a.neighbours[EAST] - u));
    Vec2 west = if_present(flags, WEST, spring<SPRINGS, 1, 0>(q, u - a.neighbours[WEST]));
    Vec2 north = if_present(flags, NORTH, spring<SPRINGS, 0, 1>(q, a.neighbours[NORTH] - u));
    Vec2 south = if_present(flags, SOUTH, spring<SPRINGS, 0, 1>(q, u - a.neighbours[SOUTH]));
    Vec2 north_east = if_present(flags, NORTH_EAST, spring<SPRINGS, 1, 1>(q, a.neighbours[NORTH_EAST] - u));
    Vec2 south_west = if_present(flags, SOUTH_WEST, spring<SPRINGS, 1, 1>(q, u - a.neighbours[SOUTH_WEST]));
    Vec2 north_west = if_present(flags, NORTH_WEST, spring<SPRINGS, -1, 1>(q, a.neighbours[NORTH_WEST] - u));
    Vec2 south_east = if_present(flags, SOUTH_EAST, spring<SPRINGS, -1, 1>(q, u - a.neighbours[SOUTH_EAST]));
    Vec2 lattice = ((east - west) + (north - south)) + ((north_east - south_west) + (north_west - south_east));
    Vec2 position = {s.position[0], s.position[1]}, dead_load = {q.dead_load[0], q.dead_load[1]};
    Vec2 drive = q.k_drive * (position - u) + dead_load;
    Vec2 force = drive + lattice;

    bool is_still = before.x == 0.0 && before.y == 0.0, is_in_contact = flags & IN_CONTACT, slides = false;
    Vec2 after = {0.0, 0.0}, stress = drive;
    // A block at rest adds zeros to the sums left out here.
    if (!(is_still && square(force) <= limit_square)) {
        Vec2 free = q.velocity_decay * before + q.force_to_velocity * force;
        const double least = of_bits((i64)(1023 - 480) << 52);
        free.x = or_zero_below(least, free.x);
        free.y = or_zero_below(least, free.y);
        double removed = impulse / sqrt(square(free));
        double remaining = 1.0 - removed;
        slides = remaining > 0.0;
        Vec2 kinetic = (removed * q.velocity_to_force) * free, against = force;
        if (slides) {
            after = remaining * free;
            against = kinetic;
            stress = lattice - kinetic;
        }
        Vec2 both = before + after;
        double velocity_shift = shift_of(s.velocity_limit), motion_shift = shift_of(s.motion_limit);
        sums.velocity[0] += integer_of(after.x, velocity_shift);
        sums.velocity[1] += integer_of(after.y, velocity_shift);
        sums.motion_square += integer_of(square(both), motion_shift);
        sums.friction_work += integer_of(dot(against, both), shift_of(s.work_limit));
        sums.speed_square = larger(sums.speed_square, square(after));
        if (ENERGY) sums.velocity_squares += integer_of(square(before) + square(after), motion_shift);
    }
    double displacement[2] = {u.x, u.y};
    for (int axis = 0; axis < 2; axis++) {
        // The shift of the window takes its centre away, too.
        sums.displacement[axis] +=
            bits_of(displacement[axis] + s.displacement_shift[axis]) - bits_of(s.displacement_base[axis]);
    }
    if (is_in_contact) sums.stress_square = larger(sums.stress_square, square(stress));
    if (slides) sums.counts += is_in_contact ? 0x10001 : 1;
    if (ENERGY) {
        Vec2 centre = {s.centre[0], s.centre[1]};
        sums.displacement_square += integer_of(square(u - centre), shift_of(s.stretch_limit));
        double straight = square(east) + square(north), diagonals = square(north_east) + square(north_west);
        double energy = straight + q.stiffness[0] / q.stiffness[1] * diagonals;
        sums.lattice_energy += integer_of(energy, shift_of(s.lattice_limit));
    }
    Moved moved = {after, slides && is_in_contact};
    return moved;
}
