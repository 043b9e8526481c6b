// Numbers of a step that all blocks of a lattice share: kernel/fused/step.rs, quanta.rs and choose_springs of
// kernel/fused/mod.rs in crates/slipfront/src. One thread of a lattice computes them.
#pragma once
#include "fixed_point.h"

// The structs down to Lattice have the layout of those in crates/slipfront/src/device.rs and src/batch.rs.
struct Equations {
    double dt, k_drive, dead_load[2], epsilon, velocity_decay, force_to_velocity, velocity_to_force;
    // Of straight and of diagonal springs.
    double stiffness[2], series[2][8], strain_limits[2], n_blocks;
    double fall_length, inverse_fall_length, healing_time;
};

struct Bounds {
    double extent[4], difference[2], growth, speed;
    Window windows[2];
    double spring_limit;
};

struct Motion {
    Bounds bounds;
    double velocity_after[2], stress_square_max;
    u64 drive_steps, drive_moves;
};

struct StepRecord {
    double displacement[2], velocity_after[2], velocity_square, friction_power, stress_square_max;
    u32 n_sliding[2];
    double stored[3], weakening_energy;
};

struct Lattice {
    Equations equations;
    Motion motion;
    u64 first_step, energies_every, energies_last;
    // Number of blocks of all lattices before this one, and of numbers that their laws remember.
    u64 first_block, first_memory;
    // Number of steps of the drive at the first step.
    u64 first_drive_step;
    // Sliding blocks are counted at multiples of this number of a step, if it is not 0; first of the bins of blocks, and
    // of the counts.
    u64 counted_every, first_bin, first_count;
    CommonSum weakening_energy;
    u32 steps, nx, n, is_held, bins, unused;
};

static_assert(sizeof(Lattice) == 520 && sizeof(StepRecord) == 96, "the sizes that src/batch.rs has");

// Numbers of all lattices, one lattice after the other.
struct Arrays {
    Lattice* lattices;
    // Displacements along x and along y, velocities along x and along y of the blocks of a lattice.
    double* state;
    // Squares of static thresholds, and kinetic impulses of the blocks, which change where strength falls with slip; x
    // and y of the driven ends at each step of the drive.
    double* given;
    // Where strength falls with slip, for the blocks of a lattice: kinetic impulses without slip, forces by which
    // strength falls, slips, and where blocks heal the times of their latest motion and the shares lost before they
    // healed.
    double* memory;
    const u16* flags;
    // Bins of the blocks, and counts of each bin at each of the steps at which sliding blocks are counted.
    const u16* bins;
    u32* counts;
    u32* first_slips;
    StepRecord* records;
};

static const u32 MEASUREMENT_INTERVAL = 16;
// The first slip of a block that has not slipped in contact.
static const u32 NEVER = 0xffffffffu;

// Formula for the forces of springs.
enum Springs { SHORT_SERIES, LONG_SERIES, SQUARE_ROOT };

struct Step {
    u64 number;
    double position[2];
    double centre[2], displacement_shift[2], displacement_base[2];
    double velocity_limit, motion_limit, work_limit, stretch_limit, lattice_limit;
    Springs springs;
    bool has_energies, measures;
};

FN double low_end(const Bounds& b, int axis) { return -b.extent[2 * axis + 1] - b.growth; }
FN double high_end(const Bounds& b, int axis) { return b.extent[2 * axis] + b.growth; }

// Moves the ranges of sums that no longer hold all numbers.
FN void move_ranges(Bounds& b) {
    bool moved = false;
    for (int axis = 0; axis < 2; axis++) {
        double low = low_end(b, axis), high = high_end(b, axis);
        if (!contains(b.windows[axis], low, high)) {
            b.windows[axis] = window_around(low, high);
            moved = true;
        }
    }
    double difference = (b.difference[0] + b.growth) + (b.difference[1] + b.growth);
    if (moved || !(difference <= b.spring_limit)) b.spring_limit = limit_of(larger(1e-9, difference));
}

FN Springs choose_springs(const Equations& e, const Bounds& b) {
    double ex = b.difference[0] + b.growth, ey = b.difference[1] + b.growth;
    double strain = e.epsilon * (2.0 * (ex + ey) + e.epsilon * (ex * ex + ey * ey));
    return strain <= e.strain_limits[0] ? SHORT_SERIES : strain <= e.strain_limits[1] ? LONG_SERIES : SQUARE_ROOT;
}

// A bound on all speeds half a step later: speeds change at most as without friction.
FN double highest_speed(const Equations& e, const Bounds& b, const double* position) {
    double force = 0.0, along = e.stiffness[0] + e.stiffness[1];
    for (int axis = 0; axis < 2; axis++) {
        double one = fabs(position[axis] - low_end(b, axis)), other = fabs(position[axis] - high_end(b, axis));
        double difference = b.difference[axis] + b.growth;
        force += 4.0 * along * difference + (e.k_drive * larger(one, other) + fabs(e.dead_load[axis]));
    }
    return (1.0 + 1e-6) * (b.speed + e.force_to_velocity * force);
}

// Numbers of a step, before which displacements have been measured if it is a multiple of the interval.
FN void begin_step(const Lattice& lattice, const double* positions, Bounds& b, Step& s, u64 number) {
    const Equations& e = lattice.equations;
    const double margin = 1.0 + 1e-6;
    u64 k = number - lattice.first_step, moved = lattice.motion.drive_steps - lattice.first_drive_step;
    if (number % MEASUREMENT_INTERVAL == 0) b.growth = 0.0;
    b.growth += 2.0 * (number == 0 ? 0.0 : e.dt) * b.speed;
    s.number = number;
    s.springs = choose_springs(e, b);
    move_ranges(b);
    for (int axis = 0; axis < 2; axis++) {
        s.position[axis] = positions[2 * moved + axis];
        s.centre[axis] = b.windows[axis].centre;
        s.displacement_base[axis] = shift_of(b.windows[axis].limit);
        s.displacement_shift[axis] = s.displacement_base[axis] - s.centre[axis];
    }
    double speed = highest_speed(e, b, s.position), x = b.windows[0].limit, y = b.windows[1].limit;
    double spring_force = e.stiffness[0] * b.spring_limit;
    s.velocity_limit = limit_of(speed);
    s.motion_limit = limit_of(margin * 4.0 * speed * speed);
    s.work_limit = limit_of(margin * e.velocity_to_force * 2.0 * speed * speed);
    s.stretch_limit = limit_of(margin * (x * x + y * y));
    s.lattice_limit =
        limit_of(margin * (2.0 + 2.0 * (e.stiffness[1] / e.stiffness[0])) * spring_force * spring_force);
    s.has_energies = number % lattice.energies_every == 0 || number == lattice.energies_last;
    // The next step needs to know displacements as they are now.
    s.measures = (number + 1) % MEASUREMENT_INTERVAL == 0 && k + 1 < lattice.steps;
}

// Extent of displacements and their differences along springs, see Bounds.
struct Measured {
    double largest[6];
};

FN Measured nothing_measured() {
    const double none = -of_bits(0x7ff0000000000000LL);
    Measured m = {{none, none, none, none, 0.0, 0.0}};
    return m;
}

// The last three are needed for energies alone.
enum Sum { DISPLACEMENT, VELOCITY = 2, MOTION_SQUARE = 4, FRICTION_WORK, VELOCITY_SQUARES, DISPLACEMENT_SQUARE, LATTICE_ENERGY, SUMS };

// Sums over all blocks, and maxima.
struct Totals {
    Words sums[SUMS];
    u32 sliding, slipping;
    double stress_square, speed_square;
    Measured measured;
};

static_assert(sizeof(Step) == 120 && sizeof(Totals) == 216, "the sizes that src/batch.rs has");

FN Totals no_totals() {
    Totals t = {};
    t.measured = nothing_measured();
    return t;
}

FN bool falls(const Equations& q) { return q.fall_length >= 0.0; }

FN void take_measured(Bounds& b, const Measured& m) {
    for (int k = 0; k < 4; k++) b.extent[k] = m.largest[k];
    for (int k = 0; k < 2; k++) b.difference[k] = m.largest[4 + k];
}

// Records a step, and what the next one needs of it.
FN void finish_step(Lattice& lattice, const Step& s, const Totals& t, StepRecord& record) {
    const Equations& e = lattice.equations;
    Motion& motion = lattice.motion;
    Bounds& b = motion.bounds;
    // A held drive stands still while a block in contact slides.
    motion.drive_moves = !lattice.is_held || t.slipping == 0;
    motion.drive_steps += motion.drive_moves;
    if (t.stress_square > motion.stress_square_max) motion.stress_square_max = t.stress_square;
    b.speed = sqrt(t.speed_square);
    double differences[2];
    for (int axis = 0; axis < 2; axis++) {
        differences[axis] = value_of(t.sums[DISPLACEMENT + axis], b.windows[axis].limit);
        record.displacement[axis] = e.n_blocks * s.centre[axis] + differences[axis];
        record.velocity_after[axis] = motion.velocity_after[axis] = value_of(t.sums[VELOCITY + axis], s.velocity_limit);
    }
    record.velocity_square = 0.25 * value_of(t.sums[MOTION_SQUARE], s.motion_limit);
    record.friction_power = -0.5 * value_of(t.sums[FRICTION_WORK], s.work_limit);
    record.stress_square_max = motion.stress_square_max;
    record.n_sliding[0] = t.sliding;
    record.n_sliding[1] = t.slipping;
    double kinetic = 0.0, springs = 0.0, drive_springs = 0.0;
    if (s.has_energies) {
        double stretch_square = value_of(t.sums[DISPLACEMENT_SQUARE], s.stretch_limit);
        for (int axis = 0; axis < 2; axis++) {
            double position = s.position[axis] - s.centre[axis];
            double mean = differences[axis] / e.n_blocks;
            stretch_square += e.n_blocks * position * (position - 2.0 * mean);
        }
        kinetic = 0.25 * value_of(t.sums[VELOCITY_SQUARES], s.motion_limit);
        springs = value_of(t.sums[LATTICE_ENERGY], s.lattice_limit) / (2.0 * e.stiffness[0]);
        drive_springs = 0.5 * e.k_drive * larger(0.0, stretch_square);
    }
    record.stored[0] = kinetic;
    record.stored[1] = springs;
    record.stored[2] = drive_springs;
    record.weakening_energy = 0.0;
    if (s.has_energies && falls(e)) record.weakening_energy = take_sum(lattice.weakening_energy);
    if (s.measures) take_measured(b, t.measured);
}
